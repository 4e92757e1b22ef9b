// Embree behind shapes.h: the only file that includes it.
//
// Embree's single precision finds the triangle, double precision decides. A ray inside the body may
// only leave through a face seen from behind, a ray outside only arrive at a face seen from the
// front, and the distance counts from the exact origin; so neither the face that a ray starts on
// nor a coplanar neighbour is ever hit again, and no offset moves the light.

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>

#include "renderer/mesh.h"
#include "renderer/shapes.h"

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

/// In units of the body: how far before its origin a ray is handed to Embree, to stay clear of its
/// rounding, and how far behind its origin a face may lie by our own rounding.
constexpr double lead_in = 1e-5, behind = 1e-9;

enum class Side { any, front, back };

}  // namespace

struct MeshGeometry {
  struct Face {
    Vec3 origin, normal;
  };
  std::vector<Face> faces;
  Device device;
  EmbreeScene scene;
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
  const MeshGeometry::Face& f = q.geometry->faces[face];
  const double facing = dot(q.d, f.normal);
  if (facing == 0 || (q.side == Side::front && facing > 0) || (q.side == Side::back && facing < 0))
    return std::numeric_limits<double>::infinity();
  return dot(f.origin - q.p, f.normal) / facing;
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
  hit.n = geometry.faces[ray.hit.primID].normal;
  return true;
}

}  // namespace

bool Mesh::enter(Vec3 p, Vec3 d, Hit& hit) const {
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

bool Mesh::exit(Vec3 p, Vec3 d, double t_max, Hit& hit) const {
  return first_hit(*geometry_, p, d, t_max, Side::back, hit);
}

bool Mesh::inside(Vec3 p) const {
  // The nearest face on any ray tells: seen from behind, the point is inside.
  Hit hit;
  const Vec3 d = normalize({0.419, 0.531, 0.737});
  return first_hit(*geometry_, p, d, std::numeric_limits<double>::infinity(), Side::any, hit) &&
         dot(hit.n, d) > 0;
}

double Mesh::clearance(Vec3) const {
  // Any bound is a valid one; a query for the nearest face costs more than the flights it saves.
  return 0;
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
    const Vec3 a = rounded[t[0]], n = cross(rounded[t[1]] - a, rounded[t[2]] - a);
    const double size = length(n);
    geometry->faces.push_back({a, size > 0 ? n * (1 / size) : Vec3{}});
  }
  rtcCommitGeometry(triangles);
  rtcAttachGeometry(geometry->scene.get(), triangles);
  rtcReleaseGeometry(triangles);
  rtcCommitScene(geometry->scene.get());
  return {Mesh(std::move(geometry)), center, radius};
}

}  // namespace translucube
