#pragma once

// The backdrop of a scene: one table for the parser, the canonical form and GET /v1/objects.

#include <array>

#include "api/base/field_reader.h"
#include "renderer/scene/spec.h"

namespace translucube::api {

/// In the order of BackdropKind and of Pattern.
inline constexpr std::array backdrop_types{"light-table", "print"};
inline constexpr std::array pattern_names{"plain", "checker", "stripes", "grid"};

struct BackdropParameter {
  const char *name, *unit;  ///< unit: null for none
  double BackdropSpec::*member;
  Range range;
  const char* description;
};

inline constexpr std::array backdrop_parameters{
    BackdropParameter{
        "distance_mm",
        "mm",
        &BackdropSpec::distance_mm,
        {0, 1e9},
        "From the object's hindmost point. 0: in contact, with a film of air between."},
    BackdropParameter{"period_mm",
                      "mm",
                      &BackdropSpec::period_mm,
                      {1e-6, 1e9},
                      "Of the pattern, which is centred at x = y = 0."},
    BackdropParameter{"light",
                      nullptr,
                      &BackdropSpec::light,
                      {0, 1e9},
                      "Of the pattern's light parts: the white radiance of a light table, the "
                      "reflectance of a print (at most 1)."},
    BackdropParameter{
        "dark", nullptr, &BackdropSpec::dark, {0, 1e9}, "Of its dark parts, likewise."},
};

}  // namespace translucube::api
