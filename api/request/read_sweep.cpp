#include <algorithm>
#include <cmath>

#include "api/base/json_reader.h"
#include "api/base/text.h"
#include "api/request/read_request.h"
#include "api/request/sweep.h"

namespace translucube::api {
namespace {

using nlohmann::json;

constexpr std::size_t most_absorbers = 256;

/// {"from", "to", "count"}: both ends exact.
std::vector<double> read_interval(const json& value, const std::string& pointer, std::uint64_t most,
                                  Faults& faults) {
  FieldReader interval(value, pointer, faults);
  const auto from = interval.number("from", unit_range, Presence::required);
  const auto to = interval.number("to", unit_range, Presence::required);
  const auto count = interval.integer("count", 1, most, Presence::required);
  interval.refuse_unknown_keys();
  if (!from || !to || !count) return {};
  if (*count == 1 && *from != *to)
    interval.fault("count", "must be 2 or more where from and to differ");
  std::vector<double> values;
  for (std::uint64_t i = 0; i < *count; ++i)
    values.push_back(*count == 1 ? *from : std::lerp(*from, *to, double(i) / double(*count - 1)));
  return values;
}

/// The values of an axis over `out`, which holds the base's; wrong ones are faults.
void read_axis(FieldReader& axes, const char* key, std::uint64_t most, std::vector<double>& out,
               Faults& faults) {
  const json* value = axes.find(key);
  if (value == nullptr) return;
  const std::string pointer = axes.pointer_to(key);
  std::vector<double> values;
  const std::size_t faults_before = faults.count();
  if (value->is_object())
    values = read_interval(*value, pointer, most, faults);
  else
    values = axes.numbers(key, unit_range, most).value_or(values);
  if (faults.count() > faults_before) return;
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  if (values.empty())
    faults.add(pointer, "must have at least one value");
  else if (std::ranges::adjacent_find(sorted) != sorted.end())
    faults.add(pointer, "must have each value once");
  else
    out = std::move(values);
}

void read_absorbers(const json& value, const Catalog& catalog, Sweep& out, Faults& faults) {
  const std::string pointer = "/absorbers";
  if (!value.is_array() || value.empty() || value.size() > most_absorbers) {
    faults.add(pointer, "must be an array of 1 to " + std::to_string(most_absorbers) +
                            " absorbers: names, or objects");
    return;
  }
  std::vector<AbsorberRequest> absorbers;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string where = pointer + '/' + std::to_string(i);
    AbsorberRequest absorber;
    const std::size_t faults_before = faults.count();
    read_absorber(value[i], where, catalog, absorber, faults);
    if (faults.count() > faults_before) continue;
    if (std::ranges::find(absorbers, absorber) != absorbers.end())
      faults.add(where, "is there twice");
    absorbers.push_back(std::move(absorber));
  }
  if (!absorbers.empty()) out.absorbers = std::move(absorbers);
}

/// What is legal for a render but not for a sweep.
void check_base(const Sweep& sweep, bool absorption_varies, Faults& faults) {
  const RenderRequest& base = sweep.base;
  if (!std::holds_alternative<CubePoint>(base.material.point))
    faults.add("/base/material", "must give its point in the cube: the axes are the cube's");
  if (base.explorable)
    faults.add("/base/explorable",
               "a sweep develops its absorptions while it traces; ask for a render");
  if (base.material.pigment_absorption_per_scattering && absorption_varies)
    faults.add("/axes/absorption", "the absorption of a pigment is bound to its scattering");
  if (base.material.pigment_absorption_per_scattering && base.model == Model::dipole &&
      std::ranges::find(sweep.scattering, 1.0) != sweep.scattering.end())
    faults.add("/axes/scattering", "the dipole model needs finite coefficients of a pigment");
}

void check_size(const Sweep& sweep, const Limits& limits, Faults& faults) {
  const double points = double(sweep.absorption.size()) * double(sweep.roughness.size()) *
                        double(sweep.scattering.size()) * double(sweep.absorbers.size());
  if (points > limits.points) {
    faults.add("/axes", "the sweep may have at most " + std::to_string(limits.points) +
                            " points; it has " + number_text(points));
    return;
  }
  const auto* target = std::get_if<SampleTarget>(&sweep.base.quality);
  const double samples = target ? double(sweep.base.width) * sweep.base.height * target->samples *
                                      double(traced_images(sweep, limits).size())
                                : 0;
  if (samples > limits.camera_samples)
    faults.add("/base/quality/samples",
               "width x height x samples x traced images must be at most " +
                   number_text(limits.camera_samples));
}

}  // namespace

Result<Sweep> parse_sweep_request(std::string_view text, const Catalog& catalog) {
  auto read = read_json(text, catalog.limits.body_bytes);
  if (!read) return read.problem();
  auto& [value, faults] = *read;

  Sweep sweep{catalog.defaults, {}, {}, {}, {}};
  FieldReader object(value, "", faults);
  if (const json* base = object.find("base", Presence::required))
    read_whole_request(*base, "/base", catalog, sweep.base, faults);
  if (const auto* cube = std::get_if<CubePoint>(&sweep.base.material.point)) {
    sweep.absorption = {cube->absorption};
    sweep.roughness = {cube->roughness};
    sweep.scattering = {cube->scattering};
  }
  sweep.absorbers = {sweep.base.material.absorber};
  if (const json* axes = object.find("axes")) {
    FieldReader reader(*axes, "/axes", faults);
    read_axis(reader, "absorption", catalog.limits.points, sweep.absorption, faults);
    read_axis(reader, "roughness", catalog.limits.points, sweep.roughness, faults);
    read_axis(reader, "scattering", catalog.limits.points, sweep.scattering, faults);
    reader.refuse_unknown_keys();
  }
  if (const json* absorbers = object.find("absorbers"))
    read_absorbers(*absorbers, catalog, sweep, faults);
  object.refuse_unknown_keys();
  check_base(sweep, sweep.absorption.size() > 1, faults);
  if (faults.empty()) check_size(sweep, catalog.limits, faults);
  if (!faults.empty()) return invalid_request(faults);
  return sweep;
}

}  // namespace translucube::api
