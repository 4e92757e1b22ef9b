#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "api/request/object_parameters.h"
#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// Thinner bodies are lost in the rounding of double precision.
constexpr double least_share = 1e-6;

void check_extents(std::initializer_list<std::pair<const char*, double>> extents,
                   FieldReader& object) {
  double largest = 0;
  for (const auto& [name, extent] : extents) largest = std::max(largest, extent);
  for (const auto& [name, extent] : extents)
    if (extent < least_share * largest)
      object.fault(name, "must be at least a millionth of the largest extent");
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

template <class Object>
void read_lengths(FieldReader& reader, ObjectRequest& out, const Faults& faults) {
  const auto* before = std::get_if<Object>(&out);
  Object object = before ? *before : Object{};
  const std::size_t faults_before = faults.count();
  for (const auto& parameter : ObjectKind<Object>::parameters)
    if (const auto length = reader.number(parameter.name, parameter.range))
      object.*parameter.member = *length;
  if (faults.count() == faults_before) check(object, reader);
  out = object;
}

void read_mesh(FieldReader& reader, const Catalog& catalog, ObjectRequest& out, Faults& faults) {
  if (reader.exclusive({"file", "upload"}, Presence::required) != 1) return;
  const auto file = reader.string("file"), upload = reader.string("upload");
  const std::string at_file = reader.pointer_to("file"), at_upload = reader.pointer_to("upload");
  if (upload && check_upload(UploadKind::mesh, *upload, at_upload, catalog, faults))
    out = MeshRequest{{}, *upload};
  auto path = file ? resolve_file(*file, at_file, catalog, faults) : std::nullopt;
  if (path && check_file(check_mesh, *path, at_file, catalog, faults))
    out = MeshRequest{std::move(*path), {}};
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
    read_lengths<Object>(reader, out, faults);
  });
  names.emplace_back("mesh");
  if (known)
    reader.refuse_unknown_keys();
  else
    reader.fault("type", "must be one of " + name_list(names));
}

}  // namespace translucube::api
