#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "api/request/backdrop_parameters.h"
#include "api/request/read_request.h"

namespace translucube::api {
namespace {

template <class Enum, std::size_t n>
void read_name(FieldReader& reader, const char* key, const std::array<const char*, n>& names,
               Enum& out) {
  const auto name = reader.string(key);
  if (!name) return;
  const auto found = std::ranges::find(names, *name);
  if (found == names.end())
    reader.fault(key, "must be one of " + name_list({names.begin(), names.end()}));
  else
    out = static_cast<Enum>(found - names.begin());
}

}  // namespace

void read_backdrop(const nlohmann::json& value, const std::string& pointer,
                   std::optional<BackdropSpec>& out, Faults& faults) {
  if (value.is_boolean() && !value.get<bool>()) return out.reset();
  if (!value.is_object()) return faults.add(pointer, "must be false or an object");
  FieldReader reader(value, pointer, faults);
  BackdropSpec backdrop = out.value_or(BackdropSpec{});
  read_name(reader, "type", backdrop_types, backdrop.kind);
  read_name(reader, "pattern", pattern_names, backdrop.pattern);
  for (const BackdropParameter& parameter : backdrop_parameters)
    if (const auto number = reader.number(parameter.name, parameter.range))
      backdrop.*parameter.member = *number;
  if (backdrop.kind == BackdropKind::print) {
    if (backdrop.light > 1) reader.fault("light", "is the reflectance of a print: at most 1");
    if (backdrop.dark > 1) reader.fault("dark", "is the reflectance of a print: at most 1");
  }
  reader.refuse_unknown_keys();
  out = backdrop;
}

}  // namespace translucube::api
