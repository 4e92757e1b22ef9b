#include "tests/bench/figures/cube.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "picture/reduce.h"
#include "renderer/base/vec.h"

namespace translucube::figures {
namespace {

constexpr int width = 760, height = 660;  // pixels
constexpr int text_size = 15;             // pixels an em
constexpr double ball_radius = 0.115;     // of the cube's edge

struct Dot {
  double x, y, scale;  ///< pixels; pixels to an edge's length at that depth
};

/// Where a point of the unit cube is on the page.
Dot project(Vec3 p) {
  constexpr double yaw = -0.45, pitch = 0.32, distance = 4.6, zoom = 1450;
  const Vec3 q = p - Vec3{0.5, 0.5, 0.5};
  const double x = std::cos(yaw) * q.x - std::sin(yaw) * q.z;
  const double away = std::sin(yaw) * q.x + std::cos(yaw) * q.z;
  const double y = std::cos(pitch) * q.y + std::sin(pitch) * away;
  const double depth = distance + std::cos(pitch) * away - std::sin(pitch) * q.y;
  const double scale = zoom / depth;
  return {0.5 * width + scale * x, 0.5 * height - scale * y, scale};
}

class Page {
 public:
  Page(const SheetLook& look, const Font& font) : look_(look), font_(font), image_(width, height) {
    std::ranges::fill(image_.pixels, look.background);
  }

  void line(Vec3 from, Vec3 to, float value, double thickness) {
    const Dot a = project(from), b = project(to);
    const double dx = b.x - a.x, dy = b.y - a.y, long2 = dx * dx + dy * dy;
    for_each_pixel(std::min(a.x, b.x) - 2, std::min(a.y, b.y) - 2, std::max(a.x, b.x) + 2,
                   std::max(a.y, b.y) + 2, [&](int x, int y, float* pixel) {
                     const double px = x + 0.5 - a.x, py = y + 0.5 - a.y;
                     const double t = std::clamp((px * dx + py * dy) / long2, 0.0, 1.0);
                     const double off = std::hypot(px - t * dx, py - t * dy);
                     blend(pixel, {value, value, value}, 0.5 * thickness + 0.5 - off);
                   });
  }

  /// A picture of a ball in display values, cut out.
  void ball(Vec3 at, const Image& picture) {
    const Dot center = project(at);
    const double radius = 0.5 * picture.width;
    const double left = std::floor(center.x - radius), top = std::floor(center.y - radius);
    for_each_pixel(left, top, left + picture.width, top + picture.height,
                   [&](int x, int y, float* pixel) {
                     const int i = x - static_cast<int>(left), j = y - static_cast<int>(top);
                     if (i < 0 || j < 0 || i >= picture.width || j >= picture.height) return;
                     const float* value =
                         &picture.pixels[3 * (std::size_t(j) * picture.width + std::size_t(i))];
                     const double off = std::hypot(i + 0.5 - radius, j + 0.5 - radius);
                     blend(pixel, {value[0], value[1], value[2]}, radius - 0.5 - off);
                   });
  }

  /// Text whose anchor (0 to 1 of its width, its middle line) is at a place of the page.
  void text(const std::string& text, double x, double y, double anchor, int size = text_size) {
    const TextMask mask = font_.draw(text, size);
    const int left = static_cast<int>(x - anchor * mask.width),
              top = static_cast<int>(y - 0.5 * mask.height);
    for (int j = 0; j < mask.height; ++j)
      for (int i = 0; i < mask.width; ++i)
        if (left + i >= 0 && left + i < width && top + j >= 0 && top + j < height)
          blend(&image_.pixels[3 * (std::size_t(top + j) * width + std::size_t(left + i))],
                {look_.ink, look_.ink, look_.ink}, mask.coverage[std::size_t(j) * mask.width + i]);
  }

  Image take() { return std::move(image_); }

 private:
  template <class Paint>
  void for_each_pixel(double left, double top, double right, double bottom, Paint&& paint) {
    for (int y = std::max(0, int(top)); y < std::min<double>(height, bottom + 1); ++y)
      for (int x = std::max(0, int(left)); x < std::min<double>(width, right + 1); ++x)
        paint(x, y, &image_.pixels[3 * (std::size_t(y) * width + x)]);
  }
  static void blend(float* pixel, std::array<float, 3> value, double coverage) {
    const auto share = static_cast<float>(std::clamp(coverage, 0.0, 1.0));
    for (int c = 0; c < 3; ++c) pixel[c] += share * (value[c] - pixel[c]);
  }

  const SheetLook& look_;
  const Font& font_;
  Image image_;
};

double share(int index, std::size_t count) {
  return count < 2 ? 0 : double(index) / double(count - 1);
}

}  // namespace

Image draw_cube(const Figure& figure, const Pictures& pictures, const SheetLook& look,
                const Font& font) {
  Page page(look, font);
  const auto& [columns, rows, layers] = figure.axes;
  const auto place = [&](const std::array<int, 3>& at) {
    return Vec3{share(at[0], columns.labels.size()), share(at[2], layers.labels.size()),
                share(at[1], rows.labels.size())};
  };
  for (const double u : {0.0, 1.0})
    for (const double v : {0.0, 1.0}) {
      page.line({0, u, v}, {1, u, v}, look.frame, 1);
      page.line({u, 0, v}, {u, 1, v}, look.frame, 1);
      page.line({u, v, 0}, {u, v, 1}, look.frame, 1);
    }
  // The axes from the clear, smooth and empty corner.
  constexpr double beyond = 1.22;
  page.line({0, 0, 0}, {beyond, 0, 0}, look.ink, 1.5);
  page.line({0, 0, 0}, {0, beyond, 0}, look.ink, 1.5);
  page.line({0, 0, 0}, {0, 0, beyond}, look.ink, 1.5);

  std::vector<const Picture*> far_first;
  for (const Picture& picture : pictures.list) far_first.push_back(&picture);
  std::ranges::sort(far_first, {},
                    [&](const Picture* p) { return project(place(p->place)).scale; });
  for (const Picture* picture : far_first) {
    const Vec3 at = place(picture->place);
    const int size = static_cast<int>(2 * ball_radius * project(at).scale);
    Image ball = reduce(picture->image, size, size);
    look.encode(ball);
    page.ball(at, ball);
  }

  for (std::size_t i = 0; i < columns.labels.size(); ++i) {
    const Dot at = project({share(int(i), columns.labels.size()), -0.19, 0});
    page.text(columns.labels[i], at.x, at.y, 0.5);
  }
  for (std::size_t i = 0; i < rows.labels.size(); ++i) {
    const Dot at = project({1.2, -0.03, share(int(i), rows.labels.size())});
    page.text(rows.labels[i], at.x, at.y, 0.5);
  }
  for (std::size_t i = 0; i < layers.labels.size(); ++i) {
    const Dot at = project({-0.19, share(int(i), layers.labels.size()), 0});
    page.text(layers.labels[i], at.x, at.y, 0.5);
  }
  const Dot x = project({0.5, -0.3, 0}), y = project({-0.1, 1.3, 0}),
            z = project({1.5, -0.05, 0.5});
  page.text(columns.title, x.x, x.y, 0.5);
  page.text(layers.title, y.x, y.y, 0.2);
  page.text(rows.title, std::fmin(z.x, width - 70.0), z.y + 22, 0.5);
  return page.take();
}

}  // namespace translucube::figures
