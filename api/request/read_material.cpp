#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;

constexpr std::size_t most_spectrum_samples = 4096;

// 1/mm. Beyond it, products with lengths leave single precision; a mean free path of 1e-18 mm is as
// good as none, and cube coordinates of 1 say so exactly.
constexpr Range coefficient_range{0, 1e18};
constexpr Range ior_range{1, 4};
constexpr Range anisotropy_range{-1, 1, true, true};

CubePoint read_cube(const json& value, const std::string& pointer, Faults& faults) {
  FieldReader cube(value, pointer, faults);
  CubePoint point;
  point.absorption = cube.number("absorption", unit_range, Presence::required).value_or(0);
  point.roughness = cube.number("roughness", unit_range, Presence::required).value_or(0);
  point.scattering = cube.number("scattering", unit_range, Presence::required).value_or(0);
  cube.refuse_unknown_keys();
  return point;
}

/// g and ior may stand here or in the material, not in both.
CoefficientsRequest read_coefficients(FieldReader& material, MaterialRequest& out, Faults& faults) {
  FieldReader object(*material.find("coefficients"), material.pointer_to("coefficients"), faults);
  CoefficientsRequest coefficients;
  object.exclusive({"sigma_a", "sigma_a_peak"}, Presence::required);
  if (const auto sigma_a = object.triple("sigma_a", coefficient_range))
    coefficients.sigma_a = *sigma_a;
  if (const auto peak = object.number("sigma_a_peak", coefficient_range))
    coefficients.sigma_a = *peak;
  coefficients.alpha = object.number("alpha", unit_range, Presence::required).value_or(0);
  coefficients.sigma_s =
      object.number("sigma_s", coefficient_range, Presence::required).value_or(0);
  if (const auto g = object.number("g", anisotropy_range)) out.anisotropy = *g;
  if (object.has("g") && material.has("anisotropy"))
    object.fault("g", "is given twice: the material has an anisotropy too");
  if (const auto ior = object.number("ior", ior_range)) out.ior = *ior;
  if (object.has("ior") && material.has("ior"))
    object.fault("ior", "is given twice: the material has an ior too");
  if (object.has("sigma_a") && material.has("absorber"))
    material.fault("absorber", "has no use where coefficients give sigma_a for each channel");
  object.refuse_unknown_keys();
  return coefficients;
}

std::optional<AbsorberRequest> read_absorber_object(const json& value, const std::string& pointer,
                                                    Faults& faults) {
  FieldReader object(value, pointer, faults);
  std::optional<AbsorberRequest> absorber;
  const bool spectral = object.has("wavelengths_nm") || object.has("values");
  if (object.has("rgb") && spectral) {
    faults.add(pointer, "must have only one of rgb and a spectrum (wavelengths_nm, values)");
  } else if (!object.has("rgb") && !spectral) {
    faults.add(pointer, "must have rgb, or wavelengths_nm and values");
  }
  if (const auto rgb = object.triple("rgb", {.low = 0})) {
    if (*std::max_element(rgb->begin(), rgb->end()) > 0)
      absorber = RgbAbsorber{*rgb};
    else
      object.fault("rgb", "must not be all zero");
  }
  if (spectral) {
    if (auto spectrum = read_spectrum(object)) absorber = std::move(*spectrum);
  } else {
    object.exclusive({"wavelengths_nm", "values"}, Presence::optional);
  }
  object.refuse_unknown_keys();
  return absorber;
}

void read_pigment(const json& value, const std::string& pointer, std::optional<double>& out,
                  Faults& faults) {
  if (value.is_boolean() && !value.get<bool>()) {
    out.reset();
  } else if (value.is_object()) {
    FieldReader pigment(value, pointer, faults);
    const auto ratio =
        pigment.number("absorption_per_scattering", {.low = 0, .high = 1e18}, Presence::required);
    if (ratio) out = *ratio;
    pigment.refuse_unknown_keys();
  } else {
    faults.add(pointer, "must be false or {\"absorption_per_scattering\": number}");
  }
}

void read_oil_film(const json& value, const std::string& pointer,
                   std::optional<OilFilmRequest>& out, Faults& faults) {
  if (value.is_boolean() && !value.get<bool>()) return out.reset();
  if (!value.is_object())
    return faults.add(pointer, "must be false or {\"normal\": [x, y, z], \"offset_mm\": number}");
  FieldReader reader(value, pointer, faults);
  OilFilmRequest film = out.value_or(OilFilmRequest{});
  if (const auto normal = reader.triple("normal", {})) {
    film.normal = *normal;
    if (*normal == std::array<double, 3>{}) reader.fault("normal", "must not be zero");
  }
  if (const auto offset = reader.number("offset_mm", {-1e12, 1e12})) film.offset_mm = *offset;
  reader.refuse_unknown_keys();
  out = film;
}

}  // namespace

void read_absorber(const json& value, const std::string& pointer, const Catalog& catalog,
                   AbsorberRequest& out, Faults& faults) {
  if (value.is_object()) {
    if (auto absorber = read_absorber_object(value, pointer, faults)) out = std::move(*absorber);
  } else if (!value.is_string()) {
    faults.add(pointer, "must be the name of an absorber, or an object");
  } else if (!catalog.absorbers.contains(value.get<std::string>())) {
    std::vector<std::string> names;
    for (const auto& [name, absorber] : catalog.absorbers) names.push_back(name);
    faults.add(pointer, "there is no absorber of this name; there are: " + name_list(names));
  } else {
    out = value.get<std::string>();
  }
}

std::optional<SpectralAbsorber> read_spectrum(FieldReader& object) {
  const auto wavelengths =
      object.numbers("wavelengths_nm", {.low = 0, .low_open = true}, most_spectrum_samples);
  const auto values = object.numbers("values", {.low = 0}, most_spectrum_samples);
  bool good = wavelengths && values;
  if (wavelengths) {
    if (wavelengths->size() < 2) {
      object.fault("wavelengths_nm", "must have at least two wavelengths");
      good = false;
    }
    const auto fall = std::adjacent_find(wavelengths->begin(), wavelengths->end(),
                                         [](double a, double b) { return a >= b; });
    if (fall != wavelengths->end()) {
      object.fault("wavelengths_nm", "must rise strictly; it does not after index " +
                                         std::to_string(fall - wavelengths->begin()));
      good = false;
    }
  }
  if (values && std::all_of(values->begin(), values->end(), [](double v) { return v == 0; })) {
    object.fault("values", "must not be all zero");
    good = false;
  }
  if (wavelengths && values && wavelengths->size() != values->size()) {
    object.fault("values", "must be as many as the wavelengths: " + std::to_string(values->size()) +
                               " for " + std::to_string(wavelengths->size()));
    good = false;
  }
  if (!good) return std::nullopt;
  return SpectralAbsorber{*wavelengths, *values};
}

void read_material(const json& value, const std::string& pointer, const Catalog& catalog,
                   MaterialPoint point, MaterialRequest& out, Faults& faults) {
  FieldReader material(value, pointer, faults);
  if (point == MaterialPoint::required) {
    material.exclusive({"cube", "coefficients"}, Presence::required);
    if (material.has("coefficients")) out.point = read_coefficients(material, out, faults);
    if (const json* cube = material.find("cube"))
      out.point = read_cube(*cube, material.pointer_to("cube"), faults);
  }
  if (const json* absorber = material.find("absorber"))
    read_absorber(*absorber, material.pointer_to("absorber"), catalog, out.absorber, faults);
  if (const auto ior = material.number("ior", ior_range)) out.ior = *ior;
  if (const auto g = material.number("anisotropy", anisotropy_range)) out.anisotropy = *g;
  if (const auto d = material.number("reference_thickness_mm", {1e-6, 1e6}))
    out.reference_thickness_mm = *d;
  if (const json* pigment = material.find("pigment"))
    read_pigment(*pigment, material.pointer_to("pigment"), out.pigment_absorption_per_scattering,
                 faults);
  if (const json* film = material.find("oil_film"))
    read_oil_film(*film, material.pointer_to("oil_film"), out.oil_film, faults);
  const auto* given = std::get_if<CoefficientsRequest>(&out.point);
  if (out.pigment_absorption_per_scattering && given != nullptr &&
      given->sigma_a != std::variant<std::array<double, 3>, double>{0.0})
    material.fault("pigment", "scatterers that absorb give the absorption: sigma_a_peak must be 0");
  material.refuse_unknown_keys();
}

}  // namespace translucube::api
