// Embree behind mesh.h: the only file that includes it.
//
// Embree's single precision finds the triangle, double precision decides. A ray inside the body may
// only leave through a face seen from behind, a ray outside only arrive at a face seen from the
// front, and the distance counts from the exact origin; so neither the face that a ray starts on
// nor a coplanar neighbour is ever hit again, and no offset moves the light.

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <limits>

#include "renderer/shape/distance_grid.h"
#include "renderer/shape/face_neighbours.h"
#include "renderer/shape/mesh.h"

namespace translucube {

namespace {

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using EmbreeScene = std::unique_ptr<RTCSceneTy, SceneDeleter>;

/// How far before its origin a ray is handed to Embree, to stay clear of its rounding, and how far
/// behind its origin a face may lie by our own rounding, in units of the body.
constexpr double lead_in = 1e-5, behind = 1e-9;

enum class Side { any, front, back };

}  // namespace

struct MeshGeometry {
  std::vector<Facet> facets;
  FaceNeighbours neighbours;
  Device device;
  EmbreeScene scene;
  DistanceGrid coarse{32}, fine{128};
  bool convex = false;
};

namespace {

struct Query {
  RTCIntersectContext context;  // first: Embree hands a pointer to it back
  const MeshGeometry* geometry;
  Vec3 p, d;
  Side side;
};

/// Distance along the query's ray to the plane of a face, or infinity from the wrong side.
double distance_to(const Query& q, unsigned face) {
  const Facet& f = q.geometry->facets[face];
  const double facing = dot(q.d, f.normal);
  if (facing == 0 || (q.side == Side::front && facing > 0) || (q.side == Side::back && facing < 0))
    return std::numeric_limits<double>::infinity();
  return dot(f.a - q.p, f.normal) / facing;
}

void accept_hit(const RTCFilterFunctionNArguments* args) {
  const auto& q = *reinterpret_cast<const Query*>(args->context);
  const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);  // one ray at a time
  const double t = distance_to(q, hit->primID);
  if (!(t >= -behind) || t == std::numeric_limits<double>::infinity()) args->valid[0] = 0;
}

bool first_hit(const MeshGeometry& geometry, Vec3 p, Vec3 d, double t_max, Side side, Hit& hit) {
  Query q{{}, &geometry, p, d, side};
  rtcInitIntersectContext(&q.context);
  q.context.filter = accept_hit;
  const Vec3 start = p - lead_in * d;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(start.x);
  ray.ray.org_y = static_cast<float>(start.y);
  ray.ray.org_z = static_cast<float>(start.z);
  ray.ray.dir_x = static_cast<float>(d.x);
  ray.ray.dir_y = static_cast<float>(d.y);
  ray.ray.dir_z = static_cast<float>(d.z);
  ray.ray.tfar = static_cast<float>(std::min(t_max + 2 * lead_in, 1e30));
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(geometry.scene.get(), &q.context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.t = std::max(0.0, distance_to(q, ray.hit.primID));
  if (hit.t >= t_max) return false;
  hit.p = p + hit.t * d;
  hit.n = geometry.facets[ray.hit.primID].normal;
  hit.face = ray.hit.primID;
  return true;
}

double distance_squared_to_edge(Vec3 p, Vec3 a, Vec3 b) {
  const Vec3 ab = b - a, ap = p - a;
  const double along = dot(ap, ab), whole = length_squared(ab);
  const double t = along <= 0 ? 0 : along >= whole ? 1 : along / whole;
  return length_squared(ap - t * ab);
}

double distance_squared_to_face(const MeshGeometry& geometry, Vec3 p, unsigned face) {
  const auto& [a, b, c, normal] = geometry.facets[face];
  const auto above = [&](Vec3 from, Vec3 to) {
    return dot(cross(to - from, p - from), normal) > 0;
  };
  if (above(a, b) && above(b, c) && above(c, a)) {
    const double height = dot(p - a, normal);
    return height * height;
  }
  return std::min({distance_squared_to_edge(p, a, b), distance_squared_to_edge(p, b, c),
                   distance_squared_to_edge(p, c, a)});
}

struct NearestQuery {
  const MeshGeometry* geometry;
  Vec3 p;
  double keen;      ///< how much of the distance found so far is still searched
  double distance;  ///< of the nearest face so far
  unsigned face = 0;
};

/// More than single precision moves a point of the unit ball or the boxes of Embree's tree, in
/// units of the body, so that no face nearer than the radius is passed over.
constexpr double point_margin = 2e-6;

bool consider_face(RTCPointQueryFunctionArguments* args) {
  auto& q = *static_cast<NearestQuery*>(args->userPtr);
  const double d2 = distance_squared_to_face(*q.geometry, q.p, args->primID);
  if (d2 >= q.distance * q.distance) return false;
  q.distance = std::sqrt(d2);
  q.face = args->primID;
  args->query->radius = static_cast<float>(q.keen * q.distance + point_margin);
  return true;
}

/// The distance of p to the nearest face, known to be at most `most`, to a factor of 1 / keen: on a
/// round body thousands of faces are as good as equally near, and to tell which is nearest takes
/// fifty times as long as to tell how near they are.
NearestFace nearest_face(const MeshGeometry& geometry, Vec3 p, double most, double keen) {
  NearestQuery q{&geometry, p, keen, most};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0,
                      static_cast<float>(most + point_margin)};
  rtcPointQuery(geometry.scene.get(), &query, &context, consider_face, &q);
  return {q.distance, q.face};
}

}  // namespace

bool Mesh::intersect_outside(Vec3 p, Vec3 d, Hit& hit) const {
  // From afar: move to the bounding sphere first, where single precision is good enough.
  const double b = dot(p, d), c = length_squared(p) - 1.02 * 1.02;
  double advanced = 0;
  if (c > 0) {
    const double discriminant = 1.02 * 1.02 - length_squared(p - b * d);
    if (b >= 0 || discriminant <= 0) return false;
    advanced = -b - std::sqrt(discriminant);
    p = p + advanced * d;
  }
  if (!first_hit(*geometry_, p, d, std::numeric_limits<double>::infinity(), Side::front, hit))
    return false;
  hit.t += advanced;
  return true;
}

bool Mesh::intersect_inside(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
  return first_hit(*geometry_, p, d, t_max, Side::back, hit);
}

bool Mesh::convex() const { return geometry_->convex; }

bool Mesh::inside(Vec3 p) const {
  // The nearest face on any ray tells: seen from behind, the point is inside.
  Hit hit;
  const Vec3 d = normalize({0.419, 0.531, 0.737});
  return first_hit(*geometry_, p, d, std::numeric_limits<double>::infinity(), Side::any, hit) &&
         dot(hit.n, d) > 0;
}

constexpr double keen_sample = 0.9, unit_ball = 4;

DistanceBounds Mesh::distance_bounds(Vec3 p) const {
  return geometry_->coarse.at(
      p, keen_sample, [&](Vec3 q) { return nearest_face(*geometry_, q, unit_ball, keen_sample); });
}

DistanceBounds Mesh::finer_distance_bounds(Vec3 p) const {
  return geometry_->fine.at(p, keen_sample, [&](Vec3 q) {
    return nearest_face(*geometry_, q, distance_bounds(q).most, keen_sample);
  });
}

std::uint32_t Mesh::face_near(Vec3 p) const {
  Vec3 center;
  return geometry_->fine
      .sample(
          p,
          [&](Vec3 q) { return nearest_face(*geometry_, q, distance_bounds(q).most, keen_sample); },
          center)
      .face;
}

DistanceBounds Mesh::distance(Vec3 p, double most) const {
  constexpr double keen = 0.6;  // by CPU time (tests/bench/speed/meshes.cpp)
  const double found = nearest_face(*geometry_, p, most, keen).distance;
  return {keen * found, found};
}

Mesh::Mesh(std::shared_ptr<const MeshGeometry> geometry)
    : geometry_(std::move(geometry)), facets_(geometry_->facets) {}

std::span<const std::uint32_t> Mesh::neighbours(std::uint32_t face) const {
  return geometry_->neighbours.of(face);
}

BuiltMesh build_mesh(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  const Vec3 center = 0.5 * (low + high);
  double radius2 = 0;
  for (const Vec3& v : mesh.vertices) radius2 = std::max(radius2, length_squared(v - center));
  const double radius = std::sqrt(radius2);

  auto geometry = std::make_shared<MeshGeometry>();
  geometry->convex = is_convex(mesh);
  geometry->device.reset(rtcNewDevice("threads=1,set_affinity=0"));
  if (!geometry->device) throw MeshError("Embree has no device");
  geometry->scene.reset(rtcNewScene(geometry->device.get()));
  rtcSetSceneFlags(
      geometry->scene.get(),
      static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  const RTCGeometry triangles = rtcNewGeometry(geometry->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                               mesh.vertices.size()));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr) throw MeshError("no memory for the mesh");
  // Faces are planes through the vertices as Embree holds them, in single precision.
  std::vector<Vec3> rounded;
  rounded.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    const Vec3 u = (v - center) * (1 / radius);
    for (const double x : {u.x, u.y, u.z}) *vertices++ = static_cast<float>(x);
    rounded.push_back({vertices[-3], vertices[-2], vertices[-1]});
  }
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) *indices++ = v;
    const Vec3 a = rounded[t[0]], b = rounded[t[1]], c = rounded[t[2]], n = cross(b - a, c - a);
    const double size = length(n);
    geometry->facets.push_back({a, b, c, size > 0 ? n * (1 / size) : Vec3{}});
  }
  geometry->neighbours = FaceNeighbours(mesh);
  rtcCommitGeometry(triangles);
  rtcAttachGeometry(geometry->scene.get(), triangles);
  rtcReleaseGeometry(triangles);
  rtcCommitScene(geometry->scene.get());
  return {Mesh(std::move(geometry)), center, radius};
}

}  // namespace translucube
