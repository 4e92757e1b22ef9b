#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "api/base/overloaded.h"
#include "api/request/object_parameters.h"
#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// Thinner bodies are lost in rounding: in double precision, or in the single precision in which
/// meshes are searched for what a ray meets.
struct LeastShare {
  double share;
  const char* text;
};
constexpr LeastShare exact{1e-6, "must be at least a millionth of the largest extent"};
constexpr LeastShare of_triangles{1e-4, "must be at least 1/10000 of the largest extent"};

void check_extents(std::initializer_list<std::pair<const char*, double>> extents,
                   FieldReader& object, const LeastShare& least = exact) {
  double largest = 0;
  for (const auto& [name, extent] : extents) largest = std::max(largest, extent);
  for (const auto& [name, extent] : extents)
    if (extent < least.share * largest) object.fault(name, least.text);
}

/// What must hold between the parameters of an object.
void check(const SphereObject&, FieldReader&) {}
void check(const PlateObject& plate, FieldReader& object) {
  check_extents({{"width_mm", plate.width_mm},
                 {"height_mm", plate.height_mm},
                 {"thickness_mm", plate.thickness_mm}},
                object);
}
void check(const BoxObject& box, FieldReader& object) {
  check_extents(
      {{"width_mm", box.width_mm}, {"height_mm", box.height_mm}, {"depth_mm", box.depth_mm}},
      object);
}
void check(const WedgeObject& wedge, FieldReader& object) {
  check_extents(
      {{"width_mm", wedge.width_mm}, {"height_mm", wedge.height_mm}, {"thick_mm", wedge.thick_mm}},
      object);
  if (wedge.thin_mm > wedge.thick_mm) object.fault("thin_mm", "must be at most thick_mm");
}
void check(const BowlObject& bowl, FieldReader& object) {
  check_extents({{"radius_mm", bowl.radius_mm}, {"thickness_mm", bowl.thickness_mm}}, object);
  if (bowl.thickness_mm >= bowl.radius_mm)
    object.fault("thickness_mm", "must be less than radius_mm");
}
void check(const TorusObject& torus, FieldReader& object) {
  if (torus.minor_mm >= torus.major_mm) object.fault("minor_mm", "must be less than major_mm");
  if (torus.minor_mm < 1e-3 * torus.major_mm)
    object.fault("minor_mm", "must be at least a thousandth of major_mm");
}
void check(const RoundedBoxObject& box, FieldReader& object) {
  check_extents({{"width_mm", box.width_mm},
                 {"height_mm", box.height_mm},
                 {"depth_mm", box.depth_mm},
                 {"edge_mm", box.edge_mm}},
                object, of_triangles);
  if (box.edge_mm > 0.5 * std::min({box.width_mm, box.height_mm, box.depth_mm}))
    object.fault("edge_mm", "must be at most half of width_mm, height_mm and depth_mm");
}
void check(const ReliefObject& relief, FieldReader& object) {
  check_extents({{"width_mm", relief.width_mm},
                 {"height_mm", relief.height_mm},
                 {"depth_mm", relief.depth_mm}},
                object, of_triangles);
}
void check(const BlobObject&, FieldReader&) {}
void check(const DragonObject&, FieldReader&) {}

template <class Object>
void read_numbers(FieldReader& reader, ObjectRequest& out, const Faults& faults) {
  const auto* before = std::get_if<Object>(&out);
  Object object = before ? *before : Object{};
  const std::size_t faults_before = faults.count();
  for (const auto& parameter : ObjectKind<Object>::parameters)
    std::visit(Overloaded{[&](double Object::*member) {
                            if (const auto number = reader.number(parameter.name, parameter.range))
                              object.*member = *number;
                          },
                          [&](std::uint64_t Object::*member) {
                            if (const auto number = reader.integer(
                                    parameter.name, static_cast<std::uint64_t>(parameter.range.low),
                                    static_cast<std::uint64_t>(parameter.range.high)))
                              object.*member = *number;
                          }},
               parameter.member);
  if (faults.count() == faults_before) check(object, reader);
  out = object;
}

void read_mesh(FieldReader& reader, const Catalog& catalog, ObjectRequest& out, Faults& faults) {
  const auto smooth = reader.boolean("smooth");
  if (reader.exclusive({"file", "upload"}, Presence::required) != 1) return;
  const auto file = reader.string("file"), upload = reader.string("upload");
  const std::string at_file = reader.pointer_to("file"), at_upload = reader.pointer_to("upload");
  const auto check = [&](const std::string& name) { check_mesh({name, smooth}); };
  if (upload && check_upload(UploadKind::mesh, *upload, at_upload, catalog, faults))
    out = MeshRequest{{}, *upload, smooth};
  auto path = file ? resolve_file(*file, at_file, catalog, faults) : std::nullopt;
  if (path && check_file(check, *path, at_file, catalog, faults))
    out = MeshRequest{std::move(*path), {}, smooth};
}

std::string type_of(const ObjectRequest& request) {
  std::string type = "mesh";
  for_each_object_kind([&]<class Object>() {
    if (std::holds_alternative<Object>(request)) type = ObjectKind<Object>::name;
  });
  return type;
}

}  // namespace

void read_object(const json& value, const std::string& pointer, const Catalog& catalog,
                 ObjectRequest& out, Faults& faults) {
  FieldReader reader(value, pointer, faults);
  std::string type = type_of(out);
  const auto given = reader.string("type");
  if (reader.has("type") && !given) return;  // one fault says enough
  if (given) type = *given;
  bool known = type == "mesh";
  if (known) read_mesh(reader, catalog, out, faults);
  std::vector<std::string> names;
  for_each_object_kind([&]<class Object>() {
    names.push_back(ObjectKind<Object>::name);
    if (type != names.back()) return;
    known = true;
    read_numbers<Object>(reader, out, faults);
  });
  names.emplace_back("mesh");
  if (known)
    reader.refuse_unknown_keys();
  else
    reader.fault("type", "must be one of " + name_list(names));
}

}  // namespace translucube::api
