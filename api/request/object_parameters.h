#pragma once

// The objects that a request may name, and their parameters: one table for the parser, the
// canonical form and GET /v1/objects. Their defaults are those of the renderer's structs.

#include <array>
#include <cstdint>
#include <variant>

#include "api/base/field_reader.h"
#include "api/request/request.h"

namespace translucube::api {

template <class Object>
struct Parameter {
  const char* name;
  std::variant<double Object::*, std::uint64_t Object::*> member;
  Range range;
  const char* description;
  const char* unit = nullptr;  ///< none
};
template <class Object>
constexpr Parameter<Object> length(const char* name, double Object::*member,
                                   const char* description, Range range = {1e-6, 1e9}) {
  return {name, member, range, description, "mm"};
}

template <class Object>
struct ObjectKind;

template <>
struct ObjectKind<SphereObject> {
  static constexpr const char *name = "sphere", *description = "A sphere centred at the origin.";
  static constexpr std::array parameters{
      length("radius_mm", &SphereObject::radius_mm, "Radius."),
  };
};

template <>
struct ObjectKind<PlateObject> {
  static constexpr const char *name = "plate",
                              *description =
                                  "A flat plate centred at the origin; its faces look along z.";
  static constexpr std::array parameters{
      length("width_mm", &PlateObject::width_mm, "Width, along x."),
      length("height_mm", &PlateObject::height_mm, "Height, along y."),
      length("thickness_mm", &PlateObject::thickness_mm, "Thickness, along z."),
  };
};

template <>
struct ObjectKind<BoxObject> {
  static constexpr const char *name = "box", *description = "A box centred at the origin.";
  static constexpr std::array parameters{
      length("width_mm", &BoxObject::width_mm, "Width, along x."),
      length("height_mm", &BoxObject::height_mm, "Height, along y."),
      length("depth_mm", &BoxObject::depth_mm, "Depth, along z."),
  };
};

template <>
struct ObjectKind<WedgeObject> {
  static constexpr const char *name = "wedge",
                              *description =
                                  "A plate whose thickness rises from left to right; its back (-z) "
                                  "is flat. Its bounding box is centred at the origin.";
  static constexpr std::array parameters{
      length("width_mm", &WedgeObject::width_mm, "Width, along x."),
      length("height_mm", &WedgeObject::height_mm, "Height, along y."),
      length("thin_mm", &WedgeObject::thin_mm,
             "Thickness at the left edge (-x); 0: it ends there. At most "
             "thick_mm.",
             {0, 1e9}),
      length("thick_mm", &WedgeObject::thick_mm, "Thickness at the right edge (+x)."),
  };
};

template <>
struct ObjectKind<BowlObject> {
  static constexpr const char *name = "bowl",
                              *description =
                                  "A hollow bowl: half of a spherical shell with a flat rim, open "
                                  "upwards (+y). Its bounding box is centred at the origin.";
  static constexpr std::array parameters{
      length("radius_mm", &BowlObject::radius_mm, "Outer radius."),
      length("thickness_mm", &BowlObject::thickness_mm,
             "Thickness of the wall; less than radius_mm."),
  };
};

template <>
struct ObjectKind<TorusObject> {
  static constexpr const char *name = "torus", *description = "A ring about the y axis.";
  static constexpr std::array parameters{
      length("major_mm", &TorusObject::major_mm, "From the axis to the middle of the tube."),
      length("minor_mm", &TorusObject::minor_mm,
             "Radius of the tube; less than major_mm, and at least a thousandth of it."),
  };
};

template <>
struct ObjectKind<RoundedBoxObject> {
  static constexpr const char *name = "rounded-box",
                              *description =
                                  "A box with rounded edges and corners, centred at the origin.";
  static constexpr std::array parameters{
      length("width_mm", &RoundedBoxObject::width_mm, "Width, along x."),
      length("height_mm", &RoundedBoxObject::height_mm, "Height, along y."),
      length("depth_mm", &RoundedBoxObject::depth_mm, "Depth, along z."),
      length("edge_mm", &RoundedBoxObject::edge_mm,
             "Radius of the rounding; at most half of each extent."),
  };
};

template <>
struct ObjectKind<ReliefObject> {
  static constexpr const char *name = "relief",
                              *description =
                                  "A plate whose front (+z) rises and falls in ridges along y. Its "
                                  "bounding box is centred at the origin.";
  static constexpr std::array parameters{
      length("width_mm", &ReliefObject::width_mm, "Width, along x."),
      length("height_mm", &ReliefObject::height_mm, "Height, along y."),
      length("depth_mm", &ReliefObject::depth_mm, "Depth, along z, with the ridges."),
      Parameter<ReliefObject>{"sharpness", &ReliefObject::sharpness, unit_range,
                              "Of the ridges' edges: 0 a sine, 1 upright walls."},
      Parameter<ReliefObject>{"ridge_height",
                              &ReliefObject::ridge_height,
                              {0.001, 0.99},
                              "Height of the ridges, as a share of depth_mm."},
      Parameter<ReliefObject>{"ridges", &ReliefObject::ridges, {1, 64}, "Number of ridges."},
  };
};

template <>
struct ObjectKind<BlobObject> {
  static constexpr const char *name = "blob", *description = "A sphere with smooth random bumps.";
  static constexpr std::array parameters{
      length("radius_mm", &BlobObject::radius_mm, "Radius without the bumps."),
      Parameter<BlobObject>{"bump", &BlobObject::bump, unit_range,
                            "Strength of the bumps; 0: a sphere, 1: up to 0.45 radii."},
      Parameter<BlobObject>{"scale", &BlobObject::scale, {0.5, 4}, "Size of the bumps, in radii."},
      Parameter<BlobObject>{
          "seed", &BlobObject::seed, {0, largest_seed}, "Which bumps: other seeds, other blobs."},
  };
};

template <>
struct ObjectKind<DragonObject> {
  static constexpr const char
      *name = "dragon",
      *description =
          "A dragon with thin wings and a thick body, that looks left (-x). "
          "Its bounding box is centred at the origin.";
  static constexpr std::array parameters{
      length("length_mm", &DragonObject::length_mm, "From the nose to the tail, along x."),
  };
};

/// Calls `use.operator()<Object>()` for each kind of object that is made of numbers.
template <class Use>
void for_each_object_kind(Use&& use) {
  use.template operator()<SphereObject>();
  use.template operator()<PlateObject>();
  use.template operator()<BoxObject>();
  use.template operator()<WedgeObject>();
  use.template operator()<BowlObject>();
  use.template operator()<TorusObject>();
  use.template operator()<RoundedBoxObject>();
  use.template operator()<ReliefObject>();
  use.template operator()<BlobObject>();
  use.template operator()<DragonObject>();
}

}  // namespace translucube::api
