// The white furnace over the whole cube: a body that absorbs nothing under light 1 from everywhere
// looks like nothing there, whatever its roughness, density, index and shape. Exact: 1.
//
// A picture is made of replicates (passes with their own random numbers), whose spread tells the
// error by Student's t. Single pixels have tails too heavy for that (a skewed mean of a thousand
// samples is far from normal at five sigma), so that cells of 4 x 4 pixels are tested: 16 times as
// many samples behind every mean, at an image of 64 cells that still tells the limb of a body from
// its centre. And light that Russian roulette brings once in thousands of samples may not have come
// at all, when the spread knows nothing of it: see Replicates::p_value.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "tests/support/chi2.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

constexpr std::array roughnesses{0.0, .1, .22, .32, .5, .71, 1.0};
constexpr std::array scatterings{0.0, .1, .5, .9, .99, .9999, 1.0};
constexpr std::array indices{1.0, 1.01, 1.33, 1.5, 2.5};
enum class Object { sphere, box };
constexpr std::array objects{Object::sphere, Object::box};
constexpr int grid_size = roughnesses.size() * scatterings.size() * indices.size() * objects.size();

struct Point {
  Object object;
  double r, s, ior;

  std::string name() const {
    std::ostringstream out;
    out << (object == Object::sphere ? "sphere" : "box") << " r " << r << " s " << s << " ior "
        << ior;
    return out.str();
  }
};

constexpr int pixels = 32, cell_pixels = 4, cells = (pixels / cell_pixels) * (pixels / cell_pixels);

/// A body of (bounding) radius 20 mm that fills the image.
Scene furnace(const Point& point) {
  constexpr double radius = 20, reference_thickness = 10;  // mm
  const double sigma_s = point.s == 1 ? std::numeric_limits<double>::infinity()
                                      : 4.0 / 3 * point.s / (1 - point.s) / reference_thickness;
  const Material m = material(point.ior, point.r * point.r, sigma_s * radius);
  const auto key = static_cast<std::uint64_t>(point.r * 1e6 + point.s * 1e3 + point.ior);
  if (point.object == Object::sphere) {
    Scene scene = body(Sphere{}, m, key);
    look_from_afar(scene, 0.7, pixels);  // out to 0.99 of the radius
    return scene;
  }
  static const Mesh mesh = build_mesh(box({1, 1.5, 2})).mesh;
  Scene scene = body(mesh, m, key);
  scene.width = scene.height = pixels;
  // Three faces with a corner in the middle.
  scene.camera = Camera({1.6, 1.3, 1.1}, {.28, .4, .52}, {0, 1, 0}, 14, pixels, pixels);
  return scene;
}

/// Means over replicates, of the image and of its cells.
class Replicates {
 public:
  void add(const PassFilm& film) {
    ++count_;
    samples_per_cell_ = cell_pixels * cell_pixels * film.pass.count;
    std::array<double, cells + 1> means{};
    for (int y = 0; y < pixels; ++y)
      for (int x = 0; x < pixels; ++x) {
        const double value = film.sum[3 * (y * pixels + x)] / film.pass.count;
        constexpr int row = pixels / cell_pixels;
        means[y / cell_pixels * row + x / cell_pixels] += value / (cell_pixels * cell_pixels);
        means[cells] += value / (pixels * pixels);
      }
    for (std::size_t i = 0; i < means.size(); ++i) {  // Welford 1962
      const double step = means[i] - mean_[i];
      mean_[i] += step / count_;
      m2_[i] += step * (means[i] - mean_[i]);
    }
  }

  int count() const { return count_; }
  Measured image() const { return at(cells); }
  Measured at(int cell) const {
    return {mean_[cell], std::sqrt(m2_[cell] / (count_ - 1.0) / count_)};
  }
  /// The probability that a true mean of 1 looks as far off as this (Student's t by Wallace 1959,
  /// "Bounds on Normal Approximations to Student's and the Chi-Square Distributions").
  double p_value(int cell) const {
    const Measured e = at(cell);
    // If `off` came in parts of the largest weight that roulette gives (1/2), it would be a Poisson
    // count of off x samples / part events, and vary accordingly.
    constexpr double part = 0.5;
    const double off = std::fabs(e.mean - 1), dof = count_ - 1;
    if (off == 0) return 1;
    const double t =
        off / std::hypot(e.standard_error, std::sqrt(off * part / (samples_per_cell_ * count_)));
    const double z = (8 * dof + 1) / (8 * dof + 3) * std::sqrt(dof * std::log1p(t * t / dof));
    return std::erfc(z / std::numbers::sqrt2);
  }

 private:
  int count_ = 0;
  double samples_per_cell_ = 0;  ///< of a replicate
  std::array<double, cells + 1> mean_{}, m2_{};
};

struct Effort {
  double standard_error;
  int least, most;        ///< replicates
  std::uint32_t samples;  ///< per pixel and replicate
};

/// Traces until the image's mean is known well enough.
Replicates trace_grid_point(const Scene& scene, const Effort& effort, double& cpu_seconds) {
  Replicates replicates;
  int wanted = effort.least;
  while (true) {
    while (replicates.count() < wanted) {
      const auto index = static_cast<std::uint32_t>(replicates.count());
      const auto film = trace_pass(scene, {index, 0, effort.samples}, 1);
      EXPECT_EQ(film->counters.nan_samples, 0u);
      cpu_seconds += film->cpu_seconds;
      replicates.add(*film);
    }
    if (replicates.image().standard_error <= effort.standard_error || wanted >= effort.most)
      return replicates;
    wanted = std::min(effort.most, wanted + std::max(1, wanted / 4));
  }
}

/// `tests`: how many pictures are looked at in all.
double expect_nothing_there(const Point& point, const Effort& effort, double tolerance, int tests) {
  double cpu_seconds = 0;
  const Replicates seen = trace_grid_point(furnace(point), effort, cpu_seconds);
  const Measured image = seen.image();
  EXPECT_NEAR(image.mean, 1, tolerance) << point.name() << " +- " << image.standard_error;
  EXPECT_LE(image.standard_error, effort.standard_error) << point.name();
  for (int cell = 0; cell < cells; ++cell)
    EXPECT_GT(seen.p_value(cell), sidak(cells * tests))
        << point.name() << " cell " << cell << ": " << seen.at(cell).mean << " +- "
        << seen.at(cell).standard_error;
  return cpu_seconds;
}

TEST(FurnaceGrid, TheBoxFillsTheImage) {
  const Scene scene = furnace({Object::box, 0, 0, 1.5});
  Hit hit;
  for (const double x : {0.0, double(pixels)})
    for (const double y : {0.0, double(pixels)})
      EXPECT_TRUE(std::get<Mesh>(scene.shape)
                      .intersect_outside(scene.camera.position, scene.camera.direction(x, y), hit));
}

TEST(FurnaceGrid, CornersAndAFixedSelectionVanish) {
  std::vector<Point> points;
  for (const double r : {0.0, 1.0})
    for (const double s : {0.0, .9999, 1.0})
      for (const double ior : {1.01, 2.5})
        points.push_back({points.size() % 2 ? Object::sphere : Object::box, r, s, ior});
  Rng rng(20);
  const auto pick = [&](const auto& values) { return values[rng.bits() % values.size()]; };
  for (int i = 0; i < 16; ++i)
    points.push_back({pick(objects), pick(roughnesses), pick(scatterings), pick(indices)});
  constexpr Effort effort{2e-3, 16, 64, 4};
  for (const Point& point : points)
    expect_nothing_there(point, effort, 4 * effort.standard_error, static_cast<int>(points.size()));
}

TEST(FurnaceGrid, LightThatEntersAKnotAgainAndAgainIsNotLost) {
  Scene scene = body(build_mesh(knot(240, 24)).mesh, material(1.5, 0, 0.03), 9);
  scene.width = scene.height = pixels;
  scene.camera = Camera({0.3, 0.2, 3}, {0.3, 0.2, 0}, {0, 1, 0}, 12, pixels, pixels);
  const Measured e = image_mean(trace(scene, 208));
  EXPECT_NEAR(e.mean, 1, 4 * e.standard_error);
  EXPECT_LT(e.standard_error, 3.5e-5);
}

/// The long form: the whole grid, each to 1e-3 at four standard errors.
class LongFurnaceGrid : public testing::TestWithParam<std::tuple<Object, double>> {};

TEST_P(LongFurnaceGrid, Vanishes) {
  constexpr Effort effort{2.5e-4, 32, 4096, 8};
  const auto& [object, ior] = GetParam();
  double cpu_seconds = 0;
  for (const double r : roughnesses)
    for (const double s : scatterings) {
      const Point point{object, r, s, ior};
      const double cost = expect_nothing_there(point, effort, 1e-3, grid_size);
      if (cost > 10) std::printf("%s: %.1f CPU s\n", point.name().c_str(), cost);
      cpu_seconds += cost;
    }
  std::printf("%.0f CPU s\n", cpu_seconds);
}

std::string body_name(const testing::TestParamInfo<std::tuple<Object, double>>& body) {
  return std::string(std::get<0>(body.param) == Object::sphere ? "sphere" : "box") + "_ior_" +
         std::to_string(std::lround(std::get<1>(body.param) * 100));
}
INSTANTIATE_TEST_SUITE_P(Of, LongFurnaceGrid,
                         testing::Combine(testing::ValuesIn(objects), testing::ValuesIn(indices)),
                         body_name);

}  // namespace
}  // namespace translucube::test
