#include "api/request/canonical.h"

#include <nlohmann/json.hpp>

#include "api/base/overloaded.h"
#include "api/request/backdrop_parameters.h"
#include "api/request/object_parameters.h"

namespace translucube::api {
namespace {

using nlohmann::json;

json point_json(const CubePoint& point) {
  return {{"absorption", point.absorption},
          {"roughness", point.roughness},
          {"scattering", point.scattering}};
}

json point_json(const CoefficientsRequest& point) {
  json object{{"alpha", point.alpha}, {"sigma_s", point.sigma_s}};
  if (const auto* peak = std::get_if<double>(&point.sigma_a))
    object["sigma_a_peak"] = *peak;
  else
    object["sigma_a"] = std::get<0>(point.sigma_a);
  return object;
}

json absorber_json(const AbsorberRequest& absorber) {
  return std::visit(
      Overloaded{
          [](const std::string& name) { return json(name); },
          [](const RgbAbsorber& rgb) {
            return json{{"rgb", rgb.relative}};
          },
          [](const SpectralAbsorber& spectrum) {
            return json{{"wavelengths_nm", spectrum.wavelengths_nm}, {"values", spectrum.values}};
          }},
      absorber);
}

json material_json(const MaterialRequest& material) {
  json object{{"ior", material.ior},
              {"anisotropy", material.anisotropy},
              {"reference_thickness_mm", material.reference_thickness_mm},
              {"pigment", false},
              {"oil_film", false}};
  if (material.pigment_absorption_per_scattering)
    object["pigment"] = {
        {"absorption_per_scattering", *material.pigment_absorption_per_scattering}};
  if (const auto& film = material.oil_film)
    object["oil_film"] = {{"normal", film->normal}, {"offset_mm", film->offset_mm}};
  const auto* coefficients = std::get_if<CoefficientsRequest>(&material.point);
  if (coefficients)
    object["coefficients"] = point_json(*coefficients);
  else
    object["cube"] = point_json(std::get<CubePoint>(material.point));
  if (!coefficients || std::holds_alternative<double>(coefficients->sigma_a))
    object["absorber"] = absorber_json(material.absorber);
  return object;
}

json object_json(const ObjectRequest& object) {
  return std::visit(Overloaded{[](const MeshRequest& mesh) {
                                 json values{{"type", "mesh"}};
                                 if (mesh.upload.empty())
                                   values["file"] = mesh.file;
                                 else
                                   values["upload"] = mesh.upload;
                                 if (mesh.smooth) values["smooth"] = *mesh.smooth;
                                 return values;
                               },
                               []<class Object>(const Object& own) {
                                 json values{{"type", ObjectKind<Object>::name}};
                                 for (const auto& parameter : ObjectKind<Object>::parameters)
                                   std::visit(
                                       [&](auto member) { values[parameter.name] = own.*member; },
                                       parameter.member);
                                 return values;
                               }},
                    object);
}

json environment_json(const EnvironmentRequest& environment) {
  json object = std::visit(Overloaded{[](const NamedEnvironment& named) {
                                        return json{{"image", named.image}};
                                      },
                                      [](const FileEnvironment& file) {
                                        return json{{"file", file.file}};
                                      },
                                      [](const UploadedEnvironment& uploaded) {
                                        return json{{"upload", uploaded.upload}};
                                      },
                                      [](const ConstantEnvironment& constant) {
                                        return json{{"constant", constant.constant}};
                                      },
                                      [](const HarmonicsEnvironment& harmonics) {
                                        return json{{"harmonics", harmonics.harmonics}};
                                      }},
                           environment.source);
  object["rotation_deg"] = environment.rotation_deg;
  object["scale"] = environment.scale;
  return object;
}

json backdrop_json(const std::optional<BackdropSpec>& backdrop) {
  if (!backdrop) return false;
  json object{{"type", backdrop_types[static_cast<std::size_t>(backdrop->kind)]},
              {"pattern", pattern_names[static_cast<std::size_t>(backdrop->pattern)]}};
  for (const BackdropParameter& parameter : backdrop_parameters)
    object[parameter.name] = *backdrop.*parameter.member;
  return object;
}

json triple(Vec3 v) { return {v.x, v.y, v.z}; }

json light_json(const LightSpec& light) {
  return std::visit(Overloaded{[](const SunSpec& sun) {
                                 return json{{"type", "sun"},
                                             {"direction", triple(sun.direction)},
                                             {"angular_diameter_deg", sun.angular_diameter_deg},
                                             {"irradiance", sun.irradiance}};
                               },
                               [](const DiscSpec& disc) {
                                 return json{{"type", "disc"},
                                             {"center_mm", triple(disc.center_mm)},
                                             {"normal", triple(disc.normal)},
                                             {"radius_mm", disc.radius_mm},
                                             {"radiance", disc.radiance}};
                               },
                               [](const RectangleSpec& rectangle) {
                                 return json{{"type", "rectangle"},
                                             {"center_mm", triple(rectangle.center_mm)},
                                             {"normal", triple(rectangle.normal)},
                                             {"up", triple(rectangle.up)},
                                             {"width_mm", rectangle.width_mm},
                                             {"height_mm", rectangle.height_mm},
                                             {"radiance", rectangle.radiance}};
                               }},
                    light);
}

json lights_json(const std::vector<LightSpec>& lights) {
  json list = json::array();
  for (const LightSpec& light : lights) list.push_back(light_json(light));
  return list;
}

json ground_json(const std::optional<GroundSpec>& ground) {
  if (!ground) return false;
  return {{"height_mm", ground->height_mm}, {"reflectance", ground->reflectance}};
}

json quality_json(const Quality& quality) {
  return std::visit(Overloaded{[](const SampleTarget& target) {
                                 return json{{"samples", target.samples}};
                               },
                               [](const ErrorTarget& target) {
                                 return json{{"relative_error", target.relative_error}};
                               },
                               [](const TimeTarget& target) {
                                 return json{{"seconds", target.seconds}};
                               }},
                    quality);
}

}  // namespace

std::string canonical_json(const RenderRequest& request) {
  const CameraRequest& camera = request.camera;
  const json document{{"material", material_json(request.material)},
                      {"scene",
                       {{"object", object_json(request.object)},
                        {"environment", environment_json(request.environment)},
                        {"lights", lights_json(request.lights)},
                        {"backdrop", backdrop_json(request.backdrop)},
                        {"ground", ground_json(request.ground)},
                        {"camera",
                         {{"position_mm", camera.position_mm},
                          {"target_mm", camera.target_mm},
                          {"up", camera.up},
                          {"vfov_deg", camera.vfov_deg}}}}},
                      {"image", {{"width", request.width}, {"height", request.height}}},
                      {"quality", quality_json(request.quality)},
                      {"model", request.model == Model::dipole ? "dipole" : "transport"},
                      {"explorable", request.explorable},
                      {"seed", request.seed}};
  return document.dump();
}

}  // namespace translucube::api
