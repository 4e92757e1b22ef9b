#pragma once

// Slab optics as a document: what `translucube appearance` reads and writes.

#include <string>
#include <string_view>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "api/request/request.h"
#include "renderer/slab/appearance.h"

namespace translucube::api {

/// {"material": as in a render request, "slab": {"thickness_mm": 0.2},
///  "quality": {"standard_error": 1e-3} (of every total; the default), "seed": 1}
struct AppearanceRequest {
  MaterialRequest material;
  double thickness_mm = 0;       ///< [1e-6, 1e6]
  double standard_error = 1e-3;  ///< [1e-5, 1]
  std::uint64_t seed = 1;
};

/// All faults at once, or the request; as strict as parse_render_request.
Result<AppearanceRequest> parse_appearance_request(std::string_view text, const Catalog& catalog);

/// What the renderer makes of it, on `threads` threads (0: all cores).
SlabAppearance measure(const AppearanceRequest& request, const Catalog& catalog, int threads);

/// JSON text, of
///   normal, diffuse      what light that comes in along the normal, or from all sides, becomes:
///     reflectance        {specular, diffuse, total}: R, G, B (linear Rec.709; white light is 1)
///     transmittance      {regular, diffuse, total}: R, G, B
///     reflected          {xyz (Y = 1: all light), lab, bands}: the total, by colour and wavelength
///     transmitted        the same; at normal incidence with haze and clarity, null where nothing
///                        comes through (renderer/slab/appearance.h defines them)
///   bands_nm             the borders of the bands; null, as are the bands, where the absorber is
///                        given by R, G, B and so has no spectrum
///   samples, seconds, transport, largest_standard_error (of all totals), seed, slab, material
/// Each of the four objects has a standard_error object with the same keys.
std::string appearance_json(const AppearanceRequest& request, const SlabAppearance& appearance,
                            const Catalog& catalog);

}  // namespace translucube::api
