// The white furnace as one table, shape x interface x interior x decoration: what absorbs nothing
// looks like nothing there where light 1 comes from everywhere. Exact: 1.
//
// A single picture of the table is known to a few thousandths. That of a level (all pictures of
// bowls, of oiled bodies, ...) is known ten times better, and is held to that.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/placed_shape.h"
#include "renderer/shape/smooth/refine.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

/// A body within the unit ball and its least z.
struct Body {
  std::string name;
  AnyShape shape;
  double back;
};
Body made(const std::string& name, const ObjectSpec& object) {
  const PlacedShape placed = place_shape(object);
  return {name, placed.shape, placed.back};
}

AnyShape smooth(TriangleMesh mesh) {
  refine(mesh);
  return build_mesh(mesh).mesh;
}

std::vector<Body> bodies() {
  return {{"sphere", Sphere{}, -1},
          {"plate", make_box({0.7, 0.6, 0.05}), -0.05},
          {"box", make_box({0.4, 0.5, 0.6}), -0.6},
          {"wedge", make_wedge({0.6, 0.5, 0.3}, 0.15), -0.3},
          {"knife", make_wedge({0.6, 0.5, 0.3}, 0), -0.3},
          {"bowl", Bowl(0.8), -1},
          {"thin bowl", Bowl(0.98), -1},
          {"box of triangles", build_mesh(box({1, 1.5, 2})).mesh, -1},
          {"ball of triangles", build_mesh(icosphere(3)).mesh, -1},
          {"knot", build_mesh(knot(240, 24)).mesh, -1},
          {"smooth cylinder", smooth(cylinder_with_normals(16)), -1},
          made("torus", TorusObject{}),
          made("rounded box", RoundedBoxObject{}),
          made("relief", ReliefObject{}),
          made("blob", BlobObject{}),
          made("dragon", DragonObject{})};
}

struct Index {
  std::string name;
  double ior, alpha;
};
const std::vector<Index> interfaces{
    {"matched", 1, 0},    {"smooth", 1.5, 0},  {"smooth diamond", 2.5, 0}, {"polished", 1.5, 1e-3},
    {"satin", 1.5, 0.05}, {"rough", 1.5, 0.3}, {"roughest", 1.33, 1}};

struct Interior {
  std::string name;
  double sigma_s, g = 0;
};
const std::vector<Interior> interiors{{"clear", 0},
                                      {"hazy", 0.3},
                                      {"milky", 4},
                                      {"dense", 100},
                                      {"forward", 4, 0.8},
                                      {"backward", 4, -0.6},
                                      {"lambertian", infinity}};

/// A map of radiance 1: the light is looked for all the same.
ImageEnvironment white_map(EnvironmentSide side) {
  Image image(64, 32);
  std::ranges::fill(image.pixels, 1.0f);
  return ImageEnvironment(image, 0.3, 1, side);
}

Backdrop white_backdrop(BackdropKind kind, const Body& body, double distance) {
  Backdrop backdrop;
  backdrop.kind = kind;
  backdrop.light = 1;
  backdrop.height = body.back - std::fmax(contact_gap, distance);
  return backdrop;
}

struct Decoration {
  std::string name;
  void (*add)(Scene&, const Body&);
  double largest_error;  ///< standard error of a picture of 8192 samples
};
const std::vector<Decoration> decorations{
    {"bare", [](Scene&, const Body&) {}, 6e-3},
    {"map", [](Scene& s, const Body&) { s.environment = white_map(EnvironmentSide::all); }, 2e-2},
    {"half oiled",
     [](Scene& s, const Body&) {
       s.oiled = OiledPart{{1, 0, 0}, 0};
     },
     6e-3},
    {"touching a light table",
     [](Scene& s, const Body& b) { s.backdrop = white_backdrop(BackdropKind::light_table, b, 0); },
     1.5e-2},
    {"touching a print",
     [](Scene& s, const Body& b) { s.backdrop = white_backdrop(BackdropKind::print, b, 0); },
     1.5e-2},
    {"over a light table, under a map",
     [](Scene& s, const Body& b) {
       s.backdrop = white_backdrop(BackdropKind::light_table, b, 0.3);
       s.environment = white_map(EnvironmentSide::front);
     },
     2e-2},
    {"over a print, under a map",
     [](Scene& s, const Body& b) {
       s.backdrop = white_backdrop(BackdropKind::print, b, 0.3);
       s.environment = white_map(EnvironmentSide::front);
     },
     2e-2}};

/// Pictures pooled by the inverse of their variance.
class Pool {
 public:
  void add(const Measured& e) {
    // What is the background alone has no variance, and would count for all.
    const double weight = 1 / (e.standard_error * e.standard_error + 1e-8);
    weighted_ += weight * (e.mean - 1);
    weights_ += weight;
  }
  double off() const { return weighted_ / weights_; }
  double standard_error() const { return 1 / std::sqrt(weights_); }

 private:
  double weighted_ = 0, weights_ = 0;
};

/// Every `stride`-th picture of the table (in a fixed random order), at `samples` a pixel.
void expect_furnaces(unsigned stride, std::uint32_t samples) {
  constexpr int size = 16;
  constexpr double of_8192 = 8192.0 / (size * size);
  std::map<std::string, Pool> levels;
  std::uint64_t row = 0;
  int pictures = 0;
  for (const Body& which : bodies())
    for (const Index& interface : interfaces)
      for (const Interior& interior : interiors)
        for (const Decoration& decoration : decorations) {
          if (hash_combine(5, ++row) % stride) continue;
          ++pictures;
          Scene scene =
              body(which.shape,
                   material(interface.ior, interface.alpha, interior.sigma_s, interior.g), row);
          decoration.add(scene, which);
          scene.width = scene.height = size;
          scene.camera = Camera({1.1, 2.2, 2.5}, {0, 0, 0}, {0, 1, 0}, 30, size, size);
          const Film film = trace(scene, samples);
          const Measured e = image_mean(film);
          SCOPED_TRACE(which.name + ", " + interface.name + ", " + interior.name + ", " +
                       decoration.name);
          EXPECT_NEAR(e.mean, 1, 5 * e.standard_error + 1e-5);
          EXPECT_LT(e.standard_error, decoration.largest_error * std::sqrt(of_8192 / samples));
          EXPECT_EQ(film.counters.nan_samples, 0u);
          EXPECT_LT(film.counters.truncated_energy / double(film.counters.camera_samples), 1e-4);
          for (const std::string& level :
               {which.name, interface.name, interior.name, decoration.name})
            levels[level].add(e);
        }
  EXPECT_GT(pictures * stride, row * 9 / 10);
  for (const auto& [name, level] : levels) {
    EXPECT_NEAR(level.off(), 0, 4 * level.standard_error()) << name;
    EXPECT_LT(level.standard_error(), 6e-4 * std::sqrt(stride * 32.0 / (9 * samples)) + 4e-4)
        << name;
  }
}

TEST(WhiteFurnace, OneInThirtyOfTheTableVanishes) { expect_furnaces(30, 32); }

TEST(LongWhiteFurnace, TheTableVanishes) { expect_furnaces(1, 512); }

}  // namespace
}  // namespace translucube::test
