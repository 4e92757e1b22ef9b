#include "api/request/parse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "api/base/json_reader.h"
#include "api/base/text.h"
#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using namespace nlohmann::literals;

void read_image(const json& value, const std::string& pointer, const Limits& limits,
                RenderRequest& out, Faults& faults) {
  FieldReader image(value, pointer, faults);
  const auto longest = std::min<std::uint64_t>(limits.pixels, std::numeric_limits<int>::max());
  const auto width = image.integer("width", 1, longest);
  const auto height = image.integer("height", 1, longest);
  image.refuse_unknown_keys();
  if (width) out.width = static_cast<int>(*width);
  if (height) out.height = static_cast<int>(*height);
  const bool both_right = (width || !image.has("width")) && (height || !image.has("height"));
  if (both_right && std::uint64_t(out.width) * std::uint64_t(out.height) > limits.pixels)
    faults.add(pointer, "width x height must be at most " + std::to_string(limits.pixels));
}

void read_quality(const json& value, const std::string& pointer, const Limits& limits, Quality& out,
                  Faults& faults) {
  FieldReader quality(value, pointer, faults);
  quality.exclusive({"samples", "relative_error", "seconds"}, Presence::required);
  if (const auto samples = quality.integer("samples", 1, limits.samples))
    out = SampleTarget{static_cast<std::uint32_t>(*samples)};
  if (const auto error = quality.number("relative_error", {0, 1, true, false}))
    out = ErrorTarget{*error};
  if (const auto seconds = quality.number("seconds", {0, limits.seconds, true, false}))
    out = TimeTarget{*seconds};
  quality.refuse_unknown_keys();
}

/// An explorable film is so many times as large as another: the same memory serves this share of
/// the pixels.
constexpr std::uint64_t explorable_share = 16;

void check_explorable(const RenderRequest& request, const std::string& pointer,
                      const Limits& limits, Faults& faults) {
  if (!request.explorable) return;
  if (request.material.pigment_absorption_per_scattering)
    faults.add(pointer + "/explorable", "the absorption of a pigment is bound to its scattering");
  const std::uint64_t most = std::max<std::uint64_t>(1, limits.pixels / explorable_share);
  if (std::uint64_t(request.width) * std::uint64_t(request.height) > most)
    faults.add(pointer + "/image", "width x height must be at most " + std::to_string(most) +
                                       " where explorable is true");
}

/// Similarity replaces anisotropic scattering by isotropic scattering of sigma_s (1 - g). Beyond
/// this the two differ in what the dipole is asked for: where light comes out near its entry.
constexpr double largest_anisotropy_of_dipole = 0.9;

/// Camera samples of the whole image.
void check_work(const RenderRequest& request, const std::string& pointer, const Limits& limits,
                Faults& faults) {
  const auto* target = std::get_if<SampleTarget>(&request.quality);
  const double pixels = double(request.width) * request.height;
  if (target && pixels * target->samples > limits.camera_samples)
    faults.add(pointer + "/quality/samples",
               "width x height x samples must be at most " + number_text(limits.camera_samples));
}

/// What is legal but has no answer in the model that was asked for.
void refuse_what_the_model_cannot_serve(const json& value, const std::string& pointer,
                                        const RenderRequest& request, Faults& faults) {
  if (request.model != Model::dipole) return;
  if (request.explorable)
    faults.add(pointer + "/explorable",
               "the dipole model has no path lengths to keep; ask for the transport model");
  const auto* cube = std::get_if<CubePoint>(&request.material.point);
  if (request.material.pigment_absorption_per_scattering && cube && cube->scattering == 1)
    faults.add(pointer + "/material/cube/scattering",
               "the dipole model needs finite coefficients of a pigment; ask for less than 1, or "
               "for the transport model");
  if (request.material.oil_film)
    faults.add(pointer + "/material/oil_film",
               "the dipole model knows one interface; ask for the transport model");
  if (std::fabs(request.material.anisotropy) > largest_anisotropy_of_dipole) {
    const bool in_coefficients = value.contains("/material/coefficients/g"_json_pointer);
    faults.add(pointer + (in_coefficients ? "/material/coefficients/g" : "/material/anisotropy"),
               "the dipole model knows anisotropy by similarity only, which holds up to 0.9 in "
               "size; ask for the transport model");
  }
}

}  // namespace

void read_request(const json& value, const std::string& pointer, const Catalog& catalog,
                  MaterialPoint point, RenderRequest& out, Faults& faults) {
  FieldReader request(value, pointer, faults);
  const Presence material_presence =
      point == MaterialPoint::required ? Presence::required : Presence::optional;
  if (const json* material = request.find("material", material_presence))
    read_material(*material, request.pointer_to("material"), catalog, point, out.material, faults);
  if (const json* scene = request.find("scene"))
    read_scene(*scene, request.pointer_to("scene"), catalog, out, faults);
  if (const json* image = request.find("image"))
    read_image(*image, request.pointer_to("image"), catalog.limits, out, faults);
  if (const json* quality = request.find("quality"))
    read_quality(*quality, request.pointer_to("quality"), catalog.limits, out.quality, faults);
  if (const auto model = request.string("model")) {
    if (model == "transport")
      out.model = Model::transport;
    else if (model == "dipole")
      out.model = Model::dipole;
    else
      request.fault("model", "must be transport or dipole");
  }
  if (const auto explorable = request.boolean("explorable")) out.explorable = *explorable;
  if (const auto seed = request.integer("seed", 0, largest_seed)) out.seed = *seed;
  request.refuse_unknown_keys();
}

void read_whole_request(const json& value, const std::string& pointer, const Catalog& catalog,
                        RenderRequest& out, Faults& faults) {
  read_request(value, pointer, catalog, MaterialPoint::required, out, faults);
  check_explorable(out, pointer, catalog.limits, faults);
  check_work(out, pointer, catalog.limits, faults);
  refuse_what_the_model_cannot_serve(value, pointer, out, faults);
}

Result<RenderRequest> parse_render_request(std::string_view text, const Catalog& catalog) {
  auto read = read_json(text, catalog.limits.body_bytes);
  if (!read) return read.problem();
  auto& [value, faults] = *read;
  RenderRequest request = catalog.defaults;
  read_whole_request(value, "", catalog, request, faults);
  if (!faults.empty()) return invalid_request(faults);
  return request;
}

}  // namespace translucube::api
