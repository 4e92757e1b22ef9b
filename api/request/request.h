#pragma once

// The room of requests: documents are read strictly (parse.h, sweep.h, appearance_request.h) into
// the values below, what a client said with every default filled in; these have a canonical form
// (canonical.h) and a meaning for the renderer (scene_spec.h). No HTTP, and no work is started.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/optics/material.h"
#include "renderer/render.h"
#include "renderer/scene/spec.h"

namespace translucube::api {

/// Every integer up to it is exact in double precision, hence in every JSON reader.
inline constexpr std::uint64_t largest_seed = (std::uint64_t{1} << 53) - 1;

inline Vec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// `coefficients` of a material; exactly one of sigma_a and sigma_a_peak.
struct CoefficientsRequest {
  std::variant<std::array<double, 3>, double> sigma_a{
      0.0};                       ///< per channel, or the absorber's peak [1/mm]
  double alpha = 0, sigma_s = 0;  ///< -, [1/mm]
  friend bool operator==(const CoefficientsRequest&, const CoefficientsRequest&) = default;
};

/// A name from config/absorbers, or the absorber itself.
using AbsorberRequest = std::variant<std::string, RgbAbsorber, SpectralAbsorber>;

struct OilFilmRequest {
  std::array<double, 3> normal{1, 0, 0};  ///< not zero, of any length
  double offset_mm = 0;
  friend bool operator==(const OilFilmRequest&, const OilFilmRequest&) = default;
};

struct MaterialRequest {
  std::variant<CubePoint, CoefficientsRequest> point;
  AbsorberRequest absorber;  ///< not used where coefficients give sigma_a per channel
  double ior = 1.5, anisotropy = 0, reference_thickness_mm = 10;
  std::optional<double> pigment_absorption_per_scattering;
  std::optional<OilFilmRequest> oil_film;
  friend bool operator==(const MaterialRequest&, const MaterialRequest&) = default;
};

struct NamedEnvironment {
  std::string image;
  friend bool operator==(const NamedEnvironment&, const NamedEnvironment&) = default;
};
struct FileEnvironment {
  std::string file;
  friend bool operator==(const FileEnvironment&, const FileEnvironment&) = default;
};
struct UploadedEnvironment {
  std::string upload;  ///< SHA-256 of its bytes (upload.h)
  friend bool operator==(const UploadedEnvironment&, const UploadedEnvironment&) = default;
};
struct ConstantEnvironment {
  std::array<double, 3> constant{1, 1, 1};
  friend bool operator==(const ConstantEnvironment&, const ConstantEnvironment&) = default;
};
struct HarmonicsEnvironment {
  std::vector<std::array<double, 3>> harmonics;  ///< 1, 4, 9 or 16
  friend bool operator==(const HarmonicsEnvironment&, const HarmonicsEnvironment&) = default;
};
struct EnvironmentRequest {
  std::variant<NamedEnvironment, FileEnvironment, UploadedEnvironment, ConstantEnvironment,
               HarmonicsEnvironment>
      source;
  double rotation_deg = 0, scale = 1;
  friend bool operator==(const EnvironmentRequest&, const EnvironmentRequest&) = default;
};

/// Of a file, or of an upload.
struct MeshRequest {
  std::string file, upload;         ///< one of them: a path, or the SHA-256 of its bytes (upload.h)
  std::optional<bool> smooth = {};  ///< not given: as its normals say
  friend bool operator==(const MeshRequest&, const MeshRequest&) = default;
};
using ObjectRequest =
    std::variant<SphereObject, MeshRequest, PlateObject, BoxObject, WedgeObject, BowlObject,
                 TorusObject, RoundedBoxObject, ReliefObject, BlobObject, DragonObject>;

struct CameraRequest {
  std::array<double, 3> position_mm{0, 0, 90}, target_mm{0, 0, 0}, up{0, 1, 0};
  double vfov_deg = 32;
  friend bool operator==(const CameraRequest&, const CameraRequest&) = default;
};

enum class Model { transport, dipole };

struct RenderRequest {
  MaterialRequest material;
  ObjectRequest object;
  EnvironmentRequest environment;
  std::vector<LightSpec> lights;
  std::optional<BackdropSpec> backdrop;
  std::optional<GroundSpec> ground;
  CameraRequest camera;
  int width = 512, height = 512;
  Quality quality;
  Model model = Model::transport;
  bool explorable = false;
  std::uint64_t seed = 1;
  friend bool operator==(const RenderRequest&, const RenderRequest&) = default;
};

}  // namespace translucube::api
