// Objects, the backdrop and the oil film: what a client is told of them is what a request may say.

#include <nlohmann/json.hpp>

#include "api/answer/listings.h"
#include "api/request/canonical.h"
#include "api/request/scene_spec.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::string object(const std::string& members) {
  return request_with(R"("scene":{"object":{)" + members + "}}");
}
std::string backdrop(const std::string& value) {
  return request_with(R"("scene":{"backdrop":)" + value + "}");
}
std::string film(const std::string& value) { return material_with(R"("oil_film":)" + value); }

TEST(SceneObjects, OfTheListingAreTakenByTheirNames) {
  const json listing = json::parse(objects_json(shipped_catalog()));
  std::vector<std::string> names;
  for (const json& part : listing["objects"]) {
    const std::string name = part["name"];
    names.push_back(name);
    if (name == "mesh") continue;
    accepted(object(R"("type":")" + name + '"'));
    json given{{"type", name}};
    for (const json& parameter : part["parameters"])
      given[parameter["name"]] = parameter["default"];
    const json canonical = json::parse(
        canonical_json(accepted(request_with(R"("scene":{"object":)" + given.dump() + "}"))));
    EXPECT_EQ(canonical["scene"]["object"], given);
  }
  EXPECT_THAT(names, ElementsAre("sphere", "plate", "box", "wedge", "bowl", "torus", "rounded-box",
                                 "relief", "blob", "dragon", "mesh"));
}

TEST(SceneObjects, KeepTheirDefaultsWhereTheRequestSaysNothing) {
  EXPECT_EQ(accepted(object(R"("type":"plate","thickness_mm":0.5)")).object,
            ObjectRequest(PlateObject{40, 40, 0.5}));
  EXPECT_EQ(accepted(object(R"("type":"bowl")")).object, ObjectRequest(BowlObject{20, 3}));
  // The scene's spec has the same.
  EXPECT_EQ(scene_spec(accepted(object(R"("type":"wedge","thin_mm":1)")), shipped_catalog()).object,
            ObjectSpec(WedgeObject{40, 40, 1, 10}));
}

TEST(SceneObjects, OfAnotherConfigurationKeepItsDefaults) {
  Catalog catalog = shipped_catalog();
  catalog.defaults.object = BowlObject{50, 5};
  EXPECT_EQ(accepted(object(R"("thickness_mm":2)"), catalog).object,
            ObjectRequest(BowlObject{50, 2}));
  EXPECT_EQ(accepted(object(R"("type":"sphere")"), catalog).object,
            ObjectRequest(SphereObject{20}));
  const json listed = json::parse(objects_json(catalog));
  for (const json& part : listed["objects"])
    if (part["name"] == "bowl") {
      EXPECT_EQ(part["parameters"][0]["default"], 50);
    }
}

TEST(SceneObjects, OfWholeNumbersStayWhole) {
  const RenderRequest request = accepted(object(R"("type":"blob","seed":7.0)"));
  EXPECT_EQ(request.object, ObjectRequest(BlobObject{20, 0.3, 1, 7}));
  EXPECT_THAT(canonical_json(request), HasSubstr(R"("seed":7,"type":"blob")"));
  const json listed = json::parse(objects_json(shipped_catalog()));
  for (const json& part : listed["objects"])
    for (const json& parameter : part["parameters"])
      if (parameter["name"] == "ridges") {
        EXPECT_EQ(parameter["type"], "integer");
        EXPECT_EQ(parameter["minimum"].dump() + parameter["maximum"].dump(), "164");
        EXPECT_FALSE(parameter.contains("unit"));
      }
}

TEST(SceneObjects, UnknownTypeTellsTheKnownOnes) {
  EXPECT_THAT(
      fault_at("/scene/object/type", object(R"("type":"teapot","lid":1)")),
      HasSubstr("sphere, plate, box, wedge, bowl, torus, rounded-box, relief, blob, dragon, "
                "mesh"));
}

TEST(SceneObjects, TellAllTheirFaultsAtOnce) {
  EXPECT_THAT(pointers(object(R"("type":"box","width_mm":0,"height_mm":"x","radius_mm":1)")),
              UnorderedElementsAre("/scene/object/width_mm", "/scene/object/height_mm",
                                   "/scene/object/radius_mm"));
  EXPECT_THAT(pointers(object(R"("type":"plate","width_mm":1e9,"height_mm":1,"thickness_mm":2)")),
              UnorderedElementsAre("/scene/object/height_mm", "/scene/object/thickness_mm"));
  fault_at("/scene/object/thin_mm", object(R"("type":"wedge","thin_mm":5,"thick_mm":4)"));
  fault_at("/scene/object/thickness_mm", object(R"("type":"bowl","thickness_mm":20)"));
  fault_at("/scene/object/minor_mm", object(R"("type":"torus","major_mm":6,"minor_mm":6)"));
  fault_at("/scene/object/minor_mm", object(R"("type":"torus","major_mm":6,"minor_mm":0.005)"));
  accepted(object(R"("type":"torus","major_mm":6,"minor_mm":5.999)"));
  fault_at("/scene/object/edge_mm", object(R"("type":"rounded-box","depth_mm":7.9)"));
  fault_at("/scene/object/edge_mm", object(R"("type":"rounded-box","edge_mm":2.7e-3)"));
  accepted(object(R"("type":"rounded-box","edge_mm":14)"));
  fault_at("/scene/object/depth_mm", object(R"("type":"relief","depth_mm":3e-3)"));
  for (const char* ridges : {"0", "65", "2.5", "-1", "\"5\"", "1e30"})
    fault_at("/scene/object/ridges", object(R"("type":"relief","ridges":)" + std::string(ridges)));
  EXPECT_THAT(pointers(object(R"("type":"relief","sharpness":1.01,"ridge_height":1,"ridges":[])")),
              UnorderedElementsAre("/scene/object/sharpness", "/scene/object/ridge_height",
                                   "/scene/object/ridges"));
  EXPECT_THAT(
      pointers(object(R"("type":"blob","bump":-0.1,"scale":0.4,"seed":1.5)")),
      UnorderedElementsAre("/scene/object/bump", "/scene/object/scale", "/scene/object/seed"));
  accepted(object(R"("type":"blob","seed":9007199254740991)"));
  fault_at("/scene/object/seed", object(R"("type":"blob","seed":9007199254740992)"));
  fault_at("/scene/object/length_mm", object(R"("type":"dragon","length_mm":0)"));
  accepted(object(R"("type":"wedge","thin_mm":4,"thick_mm":4)"));
}

TEST(SceneBackdrop, IsAbsentUnlessAskedFor) {
  EXPECT_FALSE(accepted(backdrop("false")).backdrop);
  EXPECT_EQ(accepted(backdrop("{}")).backdrop, BackdropSpec{});
  const auto spec = scene_spec(
      accepted(backdrop(R"({"type":"print","pattern":"grid","distance_mm":3,"period_mm":4,)"
                        R"("light":0.8,"dark":0.1})")),
      shipped_catalog());
  EXPECT_EQ(spec.backdrop, (BackdropSpec{BackdropKind::print, Pattern::grid, 3, 4, 0.8, 0.1}));
}

TEST(SceneBackdrop, TellsAllItsFaultsAtOnce) {
  EXPECT_THAT(pointers(backdrop(R"({"type":"mirror","pattern":"dots","distance_mm":-1,)"
                                R"("period_mm":0,"light":-1,"dark":true,"color":1})")),
              UnorderedElementsAre("/scene/backdrop/type", "/scene/backdrop/pattern",
                                   "/scene/backdrop/distance_mm", "/scene/backdrop/period_mm",
                                   "/scene/backdrop/light", "/scene/backdrop/dark",
                                   "/scene/backdrop/color"));
  for (const char* value : {"true", "null", "1", "[]"})
    fault_at("/scene/backdrop", backdrop(value));
}

TEST(SceneBackdrop, OfAPrintReflectsNoMoreThanItReceives) {
  accepted(backdrop(R"({"light":1000})"));
  EXPECT_THAT(pointers(backdrop(R"({"type":"print","light":1.01,"dark":2})")),
              ElementsAre("/scene/backdrop/light", "/scene/backdrop/dark"));
}

TEST(MaterialOilFilm, HasADirectionAndAnOffset) {
  EXPECT_FALSE(accepted(film("false")).material.oil_film);
  EXPECT_EQ(accepted(film("{}")).material.oil_film, OilFilmRequest{});
  const auto spec =
      scene_spec(accepted(film(R"({"normal":[0,-1e300,0],"offset_mm":-2})")), shipped_catalog());
  EXPECT_EQ(spec.material.oil_film->normal, (Vec3{0, -1, 0}));
  EXPECT_EQ(spec.material.oil_film->offset_mm, -2);
}

TEST(MaterialOilFilm, TellsItsFaults) {
  fault_at("/material/oil_film", film("true"));
  EXPECT_THAT(pointers(film(R"({"normal":[0,0,0],"offset_mm":"x","thickness":1})")),
              UnorderedElementsAre("/material/oil_film/normal", "/material/oil_film/offset_mm",
                                   "/material/oil_film/thickness"));
  EXPECT_THAT(fault_at("/material/oil_film", R"({"model":"dipole","material":{"cube":)" +
                                                 some_cube + R"(,"oil_film":{}}})"),
              HasSubstr("transport"));
}

}  // namespace
}  // namespace translucube::api
