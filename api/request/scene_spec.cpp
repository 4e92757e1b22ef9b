#include "api/request/scene_spec.h"

#include <algorithm>
#include <cmath>

#include "api/base/overloaded.h"
#include "api/request/upload.h"
#include "renderer/optics/material_cube.h"

namespace translucube::api {
namespace {

/// The renderer's absorbers are relative to their peak: the peak's absorption is a coefficient.
RgbAbsorber normalized(RgbAbsorber absorber) {
  const double peak = *std::max_element(absorber.relative.begin(), absorber.relative.end());
  for (double& value : absorber.relative) value /= peak;
  return absorber;
}

SpectralAbsorber normalized(SpectralAbsorber absorber) {
  const double peak = *std::max_element(absorber.values.begin(), absorber.values.end());
  for (double& value : absorber.values) value /= peak;
  return absorber;
}

Absorber absorber_of(const AbsorberRequest& absorber, const Catalog& catalog) {
  return std::visit(Overloaded{[&](const std::string& name) -> Absorber {
                                 return normalized(catalog.absorbers.at(name).spectrum);
                               },
                               [](const auto& own) -> Absorber { return normalized(own); }},
                    absorber);
}

Material without_pigment(const MaterialRequest& request, const Catalog& catalog) {
  Material material;
  material.g = request.anisotropy;
  material.ior = request.ior;
  if (const auto* cube = std::get_if<CubePoint>(&request.point)) {
    material.coefficients = from_cube(*cube, request.anisotropy, request.reference_thickness_mm);
    material.absorber = absorber_of(request.absorber, catalog);
    return material;
  }
  const auto& given = std::get<CoefficientsRequest>(request.point);
  material.coefficients.alpha = given.alpha;
  material.coefficients.sigma_s = given.sigma_s;
  if (const auto* peak = std::get_if<double>(&given.sigma_a)) {
    material.coefficients.sigma_a_peak = *peak;
    material.absorber = absorber_of(request.absorber, catalog);
    return material;
  }
  const auto& channels = std::get<0>(given.sigma_a);
  const double peak = *std::max_element(channels.begin(), channels.end());
  material.coefficients.sigma_a_peak = peak;
  material.absorber = peak > 0 ? normalized(RgbAbsorber{channels}) : RgbAbsorber{};
  return material;
}

/// v / |v|, without overflow or underflow on the way.
Vec3 direction(const std::array<double, 3>& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  return normalize({v[0] / largest, v[1] / largest, v[2] / largest});
}

Material material_of(const MaterialRequest& request, const Catalog& catalog) {
  Material material = without_pigment(request, catalog);
  if (const auto& film = request.oil_film)
    material.oil_film = OilFilm{direction(film->normal), film->offset_mm};
  const std::optional<double>& ratio = request.pigment_absorption_per_scattering;
  if (!ratio) return material;
  // The scatterers absorb: their density gives both coefficients.
  material.absorption_per_scattering = ratio;
  material.coefficients.sigma_a_peak = *ratio > 0 ? *ratio * material.coefficients.sigma_s : 0;
  return material;
}

/// w of the dipole model: the scattering coordinate in the cube, of any way to give a material.
LightModel light_model(const RenderRequest& request, const Material& material) {
  if (request.model == Model::transport) return ExactTransport{};
  const auto* cube = std::get_if<CubePoint>(&request.material.point);
  return DipoleModel{
      cube ? cube->scattering
           : to_cube(material.coefficients, material.g, request.material.reference_thickness_mm)
                 .scattering};
}

Rgb radiance(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

SceneSpec scene_spec(const RenderRequest& request, const Catalog& catalog) {
  SceneSpec spec;
  spec.material = material_of(request.material, catalog);
  spec.model = light_model(request, spec.material);
  spec.object = std::visit(Overloaded{[&](const MeshRequest& mesh) -> ObjectSpec {
                                        return MeshObject{file_of(mesh, catalog), mesh.smooth};
                                      },
                                      [](const auto& object) -> ObjectSpec { return object; }},
                           request.object);
  using EnvironmentSource = decltype(spec.environment.source);
  spec.environment.source =
      std::visit(Overloaded{[&](const NamedEnvironment& named) -> EnvironmentSource {
                              return ImageEnvironmentSpec{catalog.environments.at(named.image)};
                            },
                            [](const FileEnvironment& file) -> EnvironmentSource {
                              return ImageEnvironmentSpec{file.file};
                            },
                            [&](const UploadedEnvironment& uploaded) -> EnvironmentSource {
                              return ImageEnvironmentSpec{file_of(uploaded, catalog)};
                            },
                            [](const ConstantEnvironment& constant) -> EnvironmentSource {
                              return ConstantEnvironmentSpec{radiance(constant.constant)};
                            },
                            [](const HarmonicsEnvironment& harmonics) -> EnvironmentSource {
                              HarmonicsSpec spherical;
                              for (const auto& coefficient : harmonics.harmonics)
                                spherical.coefficients.push_back(radiance(coefficient));
                              return spherical;
                            }},
                 request.environment.source);
  spec.environment.rotation_deg = request.environment.rotation_deg;
  spec.environment.scale = request.environment.scale;
  spec.lights = request.lights;
  spec.backdrop = request.backdrop;
  spec.ground = request.ground;
  spec.camera = {vector(request.camera.position_mm), vector(request.camera.target_mm),
                 vector(request.camera.up), request.camera.vfov_deg};
  spec.width = request.width;
  spec.height = request.height;
  spec.seed = request.seed;
  if (request.explorable) {
    // The densest that a redevelopment can ask for, short of infinite.
    const CubePoint nearly_black{std::nextafter(1.0, 0.0), 0, 0};
    const double peak = spec.material.coefficients.sigma_a_peak;
    const double densest =
        from_cube(nearly_black, 0, request.material.reference_thickness_mm).sigma_a_peak;
    spec.explorable = Explorable{std::isinf(peak) ? densest : std::max(densest, peak)};
  }
  return spec;
}

SceneSpec scene_spec(std::span<const RenderRequest> lanes, const Catalog& catalog) {
  SceneSpec spec = scene_spec(lanes.front(), catalog);
  for (const RenderRequest& lane : lanes.subspan(1)) {
    const SceneSpec other = scene_spec(lane, catalog);
    spec.more_absorptions.push_back(
        {other.material.absorber, other.material.coefficients.sigma_a_peak});
  }
  return spec;
}

}  // namespace translucube::api
