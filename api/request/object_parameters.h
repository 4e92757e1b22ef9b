#pragma once

// The objects that a request may name, and their parameters: one table for the parser, the
// canonical form and GET /v1/objects. Their defaults are those of the renderer's structs.

#include <array>

#include "api/base/field_reader.h"
#include "api/request/request.h"

namespace translucube::api {

template <class Object>
struct LengthParameter {
  const char* name;
  double Object::*member;  ///< [mm]
  Range range;
  const char* description;
};

inline constexpr Range length_range{1e-6, 1e9};  // mm
inline constexpr Range thin_range{0, 1e9};       // mm

template <class Object>
struct ObjectKind;

template <>
struct ObjectKind<SphereObject> {
  static constexpr const char *name = "sphere", *description = "A sphere centred at the origin.";
  static constexpr std::array parameters{
      LengthParameter<SphereObject>{"radius_mm", &SphereObject::radius_mm, length_range, "Radius."},
  };
};

template <>
struct ObjectKind<PlateObject> {
  static constexpr const char *name = "plate",
                              *description =
                                  "A flat plate centred at the origin; its faces look along z.";
  static constexpr std::array parameters{
      LengthParameter<PlateObject>{"width_mm", &PlateObject::width_mm, length_range,
                                   "Width, along x."},
      LengthParameter<PlateObject>{"height_mm", &PlateObject::height_mm, length_range,
                                   "Height, along y."},
      LengthParameter<PlateObject>{"thickness_mm", &PlateObject::thickness_mm, length_range,
                                   "Thickness, along z."},
  };
};

template <>
struct ObjectKind<BoxObject> {
  static constexpr const char *name = "box", *description = "A box centred at the origin.";
  static constexpr std::array parameters{
      LengthParameter<BoxObject>{"width_mm", &BoxObject::width_mm, length_range, "Width, along x."},
      LengthParameter<BoxObject>{"height_mm", &BoxObject::height_mm, length_range,
                                 "Height, along y."},
      LengthParameter<BoxObject>{"depth_mm", &BoxObject::depth_mm, length_range, "Depth, along z."},
  };
};

template <>
struct ObjectKind<WedgeObject> {
  static constexpr const char *name = "wedge",
                              *description =
                                  "A plate whose thickness rises from left to right; its back (-z) "
                                  "is flat. Its bounding box is centred at the origin.";
  static constexpr std::array parameters{
      LengthParameter<WedgeObject>{"width_mm", &WedgeObject::width_mm, length_range,
                                   "Width, along x."},
      LengthParameter<WedgeObject>{"height_mm", &WedgeObject::height_mm, length_range,
                                   "Height, along y."},
      LengthParameter<WedgeObject>{"thin_mm", &WedgeObject::thin_mm, thin_range,
                                   "Thickness at the left edge (-x); 0: it ends there. At most "
                                   "thick_mm."},
      LengthParameter<WedgeObject>{"thick_mm", &WedgeObject::thick_mm, length_range,
                                   "Thickness at the right edge (+x)."},
  };
};

template <>
struct ObjectKind<BowlObject> {
  static constexpr const char *name = "bowl",
                              *description =
                                  "A hollow bowl: half of a spherical shell with a flat rim, open "
                                  "upwards (+y). Its bounding box is centred at the origin.";
  static constexpr std::array parameters{
      LengthParameter<BowlObject>{"radius_mm", &BowlObject::radius_mm, length_range,
                                  "Outer radius."},
      LengthParameter<BowlObject>{"thickness_mm", &BowlObject::thickness_mm, length_range,
                                  "Thickness of the wall; less than radius_mm."},
  };
};

/// Calls `use.operator()<Object>()` for each kind of object that is made of lengths.
template <class Use>
void for_each_object_kind(Use&& use) {
  use.template operator()<SphereObject>();
  use.template operator()<PlateObject>();
  use.template operator()<BoxObject>();
  use.template operator()<WedgeObject>();
  use.template operator()<BowlObject>();
}

}  // namespace translucube::api
