#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "renderer/shape/body/body.h"
#include "renderer/shape/body/even_out.h"
#include "renderer/shape/body/isosurface.h"

namespace translucube {
namespace {

struct Ball {
  Vec3 p;
  double r;
};

Ball between(const Ball& a, const Ball& b, double t) {
  return {(1 - t) * a.p + t * b.p, (1 - t) * a.r + t * b.r};
}

/// In lengths of about half a dragon: the nose at x = -1.1, the tail at 1.2, the feet at y = -0.45.
class Dragon {
 public:
  Dragon() {
    add_spine();
    add_head();
    for (const double side : {-1.0, 1.0}) {
      side_ = side;
      add_half_head();
      add_front_leg();
      add_rear_leg();
      add_wing();
    }
  }
  const DistanceField& field() const { return field_; }

 private:
  Vec3 on_side(Vec3 p) const { return {p.x, p.y, side_ * p.z}; }

  void add(const Ball& a, const Ball& b, double width) {
    field_.add(RoundCone{a.p, b.p, a.r, b.r}, width);
  }
  void add_plate(const Ball& a, const Ball& b, const Ball& c, double width) {
    field_.add(RoundPlate{a.p, b.p, c.p, a.r, b.r, c.r}, width);
  }
  /// Cones from ball to ball, on the side that is being made.
  void add_chain(const std::vector<Ball>& balls, double width) {
    for (std::size_t i = 0; i + 1 < balls.size(); ++i)
      add({on_side(balls[i].p), balls[i].r}, {on_side(balls[i + 1].p), balls[i + 1].r}, width);
  }

  /// From the head to the tip of the tail, by Catmull and Rom (1974).
  Ball spine(double at) const {
    static const std::vector<Ball> balls{
        {{-0.86, 0.66, 0.00}, 0.080}, {{-0.78, 0.67, 0.00}, 0.090}, {{-0.67, 0.62, 0.00}, 0.085},
        {{-0.61, 0.49, 0.00}, 0.090}, {{-0.59, 0.34, 0.00}, 0.110}, {{-0.53, 0.20, 0.00}, 0.150},
        {{-0.38, 0.10, 0.00}, 0.200}, {{-0.14, 0.06, 0.00}, 0.205}, {{0.12, 0.08, 0.00}, 0.185},
        {{0.34, 0.09, 0.00}, 0.185},  {{0.54, 0.02, 0.02}, 0.135},  {{0.72, -0.10, 0.08}, 0.100},
        {{0.90, -0.22, 0.14}, 0.080}, {{1.08, -0.25, 0.14}, 0.064}, {{1.20, -0.16, 0.08}, 0.050},
        {{1.20, -0.03, 0.01}, 0.038}, {{1.10, 0.05, -0.03}, 0.028}, {{1.00, 0.03, -0.04}, 0.018},
        {{0.93, -0.02, -0.05}, 0.010}};
    const auto i = static_cast<std::size_t>(std::fmin(at, double(balls.size()) - 1.001));
    const double t = at - double(i);
    const auto get = [&](std::size_t k) { return balls[std::min(k, balls.size() - 1)]; };
    const Ball b0 = get(i == 0 ? 0 : i - 1), b1 = get(i), b2 = get(i + 1), b3 = get(i + 2);
    const auto curve = [&](auto a, auto b, auto c, auto d) {
      return 0.5 * (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) +
                    t * t * t * (3 * b - 3 * c + d - a));
    };
    return {curve(b0.p, b1.p, b2.p, b3.p), curve(b0.r, b1.r, b2.r, b3.r)};
  }
  static constexpr double spine_end = 18;

  /// Upwards from the spine, in its plane.
  Vec3 spine_up(double at) const {
    const Vec3 along = spine(std::fmin(at + 0.05, spine_end)).p - spine(std::fmax(at - 0.05, 0)).p;
    return normalize(Vec3{-along.y, along.x, 0});
  }

  void add_spine() {
    // They touch in common balls: to melt them would raise a ring around each.
    constexpr int cones = 120;
    for (int i = 0; i < cones; ++i)
      add(spine(spine_end * i / cones), spine(spine_end * (i + 1) / cones), 0);
    // Plates across the belly and under the tail.
    for (double at = 2.6; at < 14; at += at < 9 ? 0.28 : 0.4) {
      const Ball b = spine(at);
      const Vec3 down = b.p - 0.86 * b.r * spine_up(at), across{0, 0, 0.42 * b.r};
      add({down - across, 0.2 * b.r}, {down + across, 0.2 * b.r}, 0.012);
    }
    // A crest of fins along the back.
    for (double at = 1.3; at < 16.6;) {
      const Ball b = spine(at);
      const double size = 0.05 + 0.42 * b.r;
      const Vec3 up = spine_up(at), back{up.y, -up.x, 0};
      const Vec3 root = b.p + 0.85 * b.r * up;
      add_plate({root - 0.55 * size * back, 0.016}, {root + 0.55 * size * back, 0.016},
                {root + 1.25 * size * up + 0.75 * size * back, 0.006}, 0.02);
      at += 0.30 + 0.9 * (size - 0.05) / 0.42 * 1.6;
    }
    // A spade at the end of the tail.
    const Ball tip = spine(spine_end);
    const Vec3 along = normalize(tip.p - spine(spine_end - 0.5).p), up{-along.y, along.x, 0};
    const Ball root{tip.p - 0.03 * along, 0.012}, end{tip.p + 0.2 * along, 0.006};
    for (const double sign : {-1.0, 1.0})
      add_plate(root, {tip.p + 0.02 * along + sign * 0.085 * up, 0.007}, end, 0.012);
  }

  void add_head() {
    // Snout, and a jaw that stands open.
    add({{-0.86, 0.67, 0}, 0.080}, {{-1.08, 0.60, 0}, 0.044}, 0.03);
    add({{-0.98, 0.65, 0}, 0.046}, {{-1.09, 0.625, 0}, 0.032}, 0.02);
    add({{-0.80, 0.60, 0}, 0.055}, {{-0.92, 0.515, 0}, 0.040}, 0.02);
    add({{-0.92, 0.515, 0}, 0.040}, {{-1.04, 0.475, 0}, 0.024}, 0.02);
    add({{-0.86, 0.575, 0}, 0.022}, {{-0.99, 0.535, 0}, 0.012}, 0.008);  // tongue
  }

  void add_half_head() {
    add_chain({{{-1.105, 0.635, 0.022}, 0.014}, {{-1.085, 0.645, 0.026}, 0.016}}, 0.01);  // nostril
    add_chain({{{-0.95, 0.705, 0.052}, 0.014},
               {{-0.89, 0.735, 0.062}, 0.020},
               {{-0.81, 0.735, 0.060}, 0.016}},
              0.012);                                                                      // brow
    add_chain({{{-0.905, 0.690, 0.068}, 0.019}, {{-0.895, 0.690, 0.068}, 0.019}}, 0.003);  // eye
    add_chain({{{-0.78, 0.73, 0.050}, 0.036},
               {{-0.68, 0.82, 0.085}, 0.027},
               {{-0.56, 0.87, 0.105}, 0.018},
               {{-0.45, 0.93, 0.105}, 0.006}},
              0.015);  // horn
    for (int i = 0; i < 3; ++i)
      add_chain({{{-0.79 + 0.04 * i, 0.66 - 0.045 * i, 0.070}, 0.022},
                 {{-0.70 + 0.06 * i, 0.66 - 0.075 * i, 0.150 - 0.02 * i}, 0.005}},
                0.012);  // spikes of the cheek
    for (int i = 0; i < 5; ++i) {
      const double t = i / 4.0, size = i == 4 ? 1.5 : 1.0;
      const Vec3 upper{-0.93 - 0.15 * t, 0.600 - 0.028 * t, 0.055 - 0.028 * t};
      add_chain({{upper, 0.011}, {upper + Vec3{-0.004, -0.038 * size, 0}, 0.003}}, 0.006);
      const Vec3 lower{-0.92 - 0.11 * t, 0.545 - 0.048 * t, 0.034 - 0.018 * t};
      add_chain({{lower, 0.010}, {lower + Vec3{-0.008, 0.034 * size, 0}, 0.003}}, 0.006);
    }
  }

  /// Three toes with claws, and one behind.
  void add_foot(Vec3 ankle, double size) {
    for (const double turn : {-0.6, 0.0, 0.6}) {
      const Vec3 out{-std::cos(turn), 0, std::sin(turn)};
      const Vec3 middle = ankle + size * (0.10 * out + Vec3{0, -0.045, 0});
      const Vec3 end = ankle + size * (0.17 * out + Vec3{0, -0.075, 0});
      add_chain({{ankle, 0.042 * size}, {middle, 0.034 * size}, {end, 0.026 * size}}, 0.015);
      add_chain({{end, 0.020 * size}, {end + size * (0.075 * out + Vec3{0, -0.02, 0}), 0.004}},
                0.006);
    }
    const Vec3 heel = ankle + size * Vec3{0.07, -0.06, 0};
    add_chain({{ankle, 0.035 * size}, {heel, 0.022 * size}}, 0.015);
    add_chain({{heel, 0.018 * size}, {heel + size * Vec3{0.055, -0.03, 0}, 0.004}}, 0.006);
  }

  void add_front_leg() {
    add_chain({{{-0.40, 0.06, 0.13}, 0.115},
               {{-0.30, -0.14, 0.20}, 0.075},
               {{-0.42, -0.30, 0.21}, 0.050},
               {{-0.46, -0.36, 0.21}, 0.046}},
              0.04);
    add_chain({{{-0.30, -0.14, 0.20}, 0.03}, {{-0.20, -0.16, 0.23}, 0.005}}, 0.02);  // spur
    add_foot({-0.46, -0.36, 0.21}, 1);
  }

  void add_rear_leg() {
    add_chain({{{0.36, 0.04, 0.12}, 0.150},
               {{0.22, -0.12, 0.23}, 0.105},
               {{0.42, -0.26, 0.24}, 0.056},
               {{0.34, -0.36, 0.24}, 0.048}},
              0.04);
    add_chain({{{0.42, -0.26, 0.24}, 0.03}, {{0.51, -0.25, 0.26}, 0.005}}, 0.02);  // spur
    add_foot({0.34, -0.36, 0.24}, 1.1);
  }

  void add_wing() {
    const auto at = [&](double x, double y, double z, double r) {
      return Ball{on_side({x, y, z}), r};
    };
    const Ball shoulder = at(-0.30, 0.20, 0.11, 0.06), elbow = at(-0.02, 0.50, 0.24, 0.036),
               wrist = at(-0.26, 0.84, 0.34, 0.030);
    add(shoulder, elbow, 0.03);
    add(elbow, wrist, 0.02);
    const Ball thumb = at(-0.37, 0.90, 0.36, 0.004);
    add({wrist.p, 0.022}, thumb, 0.01);
    constexpr double thin = 0.014;  // half of the membranes' thickness
    const std::array tips{at(0.12, 1.14, 0.46, thin), at(0.52, 1.02, 0.50, thin),
                          at(0.80, 0.74, 0.48, thin), at(0.84, 0.42, 0.40, thin)};
    for (const Ball& tip : tips) {
      // A finger bends in its middle.
      Ball middle = between(wrist, tip, 0.5);
      middle.p = middle.p + Vec3{0.02, 0.05, side_ * 0.03};
      add({wrist.p, 0.024}, {middle.p, 0.018}, 0.01);
      add({middle.p, 0.018}, {tip.p + 0.06 * (tip.p - middle.p), 0.006}, 0.01);
    }
    const auto membrane = [&](const Ball& a, const Ball& b, const Ball& c) {
      add_plate({a.p, thin}, {b.p, thin}, {c.p, thin}, 0.004);
    };
    // Hung between the fingers, its rim drawn in.
    const auto bent = [&](const Ball& tip) {
      Ball middle = between(wrist, tip, 0.5);
      middle.p = middle.p + Vec3{0.02, 0.05, side_ * 0.03};
      return middle;
    };
    for (std::size_t i = 0; i + 1 < tips.size(); ++i) {
      const Ball &a = tips[i], &b = tips[i + 1], ma = bent(a), mb = bent(b);
      const Ball rim = between(between(a, b, 0.5), wrist, 0.2);
      membrane(wrist, ma, mb);
      membrane(ma, a, rim);
      membrane(mb, rim, b);
      membrane(ma, rim, mb);
    }
    const Ball flank = at(0.30, 0.20, 0.10, thin), last = bent(tips.back());
    const Ball rim = between(between(tips.back(), flank, 0.5), elbow, 0.25);
    membrane(elbow, wrist, last);
    membrane(elbow, last, rim);
    membrane(last, tips.back(), rim);
    membrane(elbow, rim, flank);
    membrane(shoulder, elbow, flank);
  }

  DistanceField field_;
  double side_ = 1;
};

/// Drops what a grid leaves of tips that are thinner than its cells.
void keep_largest_part(TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size()), count(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) parent[root(v)] = root(t[0]);
  for (const Triangle& t : mesh.triangles) ++count[root(t[0])];
  const auto largest = static_cast<std::uint32_t>(std::ranges::max_element(count) - count.begin());
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return root(t[0]) != largest; });
  mesh.corner_normals = mesh.triangles;
}

/// Of length 1, centred.
TriangleMesh make_unit_dragon() {
  constexpr double cell = 0.018;
  TriangleMesh mesh = isosurface(Dragon().field(), {-1.25, -0.55, -0.75}, cell, {150, 105, 84});
  keep_largest_part(mesh);
  even_out(mesh, 0.9 * cell);
  close_mesh(mesh);
  Vec3 least, most;
  for (const Vec3& v : mesh.vertices) {
    least = {std::fmin(least.x, v.x), std::fmin(least.y, v.y), std::fmin(least.z, v.z)};
    most = {std::fmax(most.x, v.x), std::fmax(most.y, v.y), std::fmax(most.z, v.z)};
  }
  const double scale = 1 / (most.x - least.x);
  for (Vec3& v : mesh.vertices) v = scale * (v - 0.5 * (least + most));
  return mesh;
}

}  // namespace

BodyMesh make_dragon(double length) {
  static const TriangleMesh unit = make_unit_dragon();  // takes long, and is the same for all
  BodyMesh body{unit, length, {2.5e-5, 4e-3}};
  for (Vec3& v : body.mesh.vertices) v = length * v;
  return body;
}

}  // namespace translucube
