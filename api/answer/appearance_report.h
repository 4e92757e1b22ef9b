#pragma once

#include <string>

#include "api/request/appearance_request.h"
#include "renderer/slab/appearance.h"

namespace translucube::api {

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
