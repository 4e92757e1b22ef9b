#pragma once

// The parts of a request, read over their defaults; shared by requests and by the defaults
// themselves in config/service.json.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "api/base/faults.h"
#include "api/base/field_reader.h"
#include "api/request/catalog.h"
#include "api/request/request.h"
#include "api/request/upload.h"

namespace translucube::api {

inline constexpr Range position_range{-1e12, 1e12};  // mm: room around the largest sphere
// Radiance is single precision, and the error estimate squares it: factors up to 1e9 keep
// (constant x scale)^2 finite.
inline constexpr Range radiance_range{0, 1e9};

/// A request says where in the cube its material is; the defaults must not.
enum class MaterialPoint { required, refused };

/// Each reads a JSON value over the defaults that `out` holds; what is missing or wrong stays.
void read_request(const nlohmann::json& value, const std::string& pointer, const Catalog& catalog,
                  MaterialPoint point, RenderRequest& out, Faults& faults);
/// Reads a request and checks what must hold between its parts.
void read_whole_request(const nlohmann::json& value, const std::string& pointer,
                        const Catalog& catalog, RenderRequest& out, Faults& faults);
void read_material(const nlohmann::json& value, const std::string& pointer, const Catalog& catalog,
                   MaterialPoint point, MaterialRequest& out, Faults& faults);
void read_scene(const nlohmann::json& value, const std::string& pointer, const Catalog& catalog,
                RenderRequest& out, Faults& faults);

void read_object(const nlohmann::json& value, const std::string& pointer, const Catalog& catalog,
                 ObjectRequest& out, Faults& faults);

/// The value is false, or the backdrop's object.
void read_backdrop(const nlohmann::json& value, const std::string& pointer,
                   std::optional<BackdropSpec>& out, Faults& faults);

/// The value is a list of lights, or the name of a preset.
void read_lights(const nlohmann::json& value, const std::string& pointer,
                 std::vector<LightSpec>& out, Faults& faults);
/// The value is false, or the ground's object.
void read_ground(const nlohmann::json& value, const std::string& pointer,
                 std::optional<GroundSpec>& out, Faults& faults);

/// The value is the name of an absorber, or the absorber itself.
void read_absorber(const nlohmann::json& value, const std::string& pointer, const Catalog& catalog,
                   AbsorberRequest& out, Faults& faults);

/// Reads {"wavelengths_nm": [...], "values": [...]}; both keys are required.
std::optional<SpectralAbsorber> read_spectrum(FieldReader& object);

/// A file named by a request: its absolute path with symbolic links resolved, if it may be read and
/// is a regular file. Outside the catalog's folders the fault is the same whether it exists or not.
std::optional<std::string> resolve_file(const std::string& file, const std::string& pointer,
                                        const Catalog& catalog, Faults& faults);

/// Whether there is an upload of this name.
bool check_upload(UploadKind kind, const std::string& sha256, const std::string& pointer,
                  const Catalog& catalog, Faults& faults);

/// Whether such a file is what it has to be, by the renderer's check, unless the catalog knows it
/// already; what it cannot tell now counts as right.
bool check_file(const std::function<void(const std::string&)>& check, const std::string& file,
                const std::string& pointer, const Catalog& catalog, Faults& faults);

}  // namespace translucube::api
