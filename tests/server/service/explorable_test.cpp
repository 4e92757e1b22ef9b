// Explorable renders through the service, with the real renderer.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "picture/image_io.h"
#include "tests/server/calls/calls_under_test.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;

std::string request(double absorption, bool explorable, const std::string& absorber = "red-glass") {
  return json{{"material",
               {{"cube", {{"absorption", absorption}, {"roughness", 0.3}, {"scattering", 0.5}}},
                {"absorber", absorber}}},
              {"scene", {{"environment", {{"constant", {1, 1, 1}}}}}},
              {"image", {{"width", 12}, {"height", 12}}},
              {"quality", {{"samples", 4}}},
              {"explorable", explorable}}
      .dump();
}

struct Explored : CallsUnderTest {
  Explored() : CallsUnderTest(renderer_engine()) {}

  std::string finished(const std::string& document) {
    const api::RenderStatus status = service.wait(service.submit(document).id);
    EXPECT_EQ(status.state, api::JobState::succeeded);
    return status.id;
  }
  api::Result<ImageFile> image(const std::string& id, api::Redevelopment asked) {
    return service.service.image(id, {ImageFormat::exr, {}, {}, {}, std::move(asked)});
  }
  std::vector<float> pixels(const ImageFile& image) {
    write_file(folder / "picture.exr", image.file->read_all());
    return read_image(folder / "picture.exr").pixels;
  }
};

TEST(ExplorableService, RedevelopsWithoutTracingWhatARenderOfItsOwnWouldShow) {
  Explored service;
  const std::string id = service.finished(request(0.3, true));
  const std::string alone = service.finished(request(0.8, false, "amber"));
  const auto redeveloped = *service.image(id, {0.8, "amber"});
  const auto expected = *service.image(alone, {});
  const auto got = service.pixels(redeveloped), wanted = service.pixels(expected);
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_NEAR(got[i], wanted[i], 2e-3);
  const auto own = *service.image(id, {});
  EXPECT_NE(own.etag, redeveloped.etag);
  EXPECT_NE(service.pixels(own), got);
  EXPECT_EQ(service.image(id, {0.8, "amber"})->etag, redeveloped.etag);
}

TEST(ExplorableService, TheRequestsOwnAbsorptionGivesTheRendersOwnPicture) {
  Explored service;
  const std::string id = service.finished(request(0.3, true));
  EXPECT_EQ(service.pixels(*service.image(id, {0.3, {}})), service.pixels(*service.image(id, {})));
}

TEST(ExplorableService, ARenderWithoutPathLengthsIsAConflictThatNamesTheParameter) {
  Explored service;
  const std::string id = service.finished(request(0.3, false));
  const HttpResponse response = service.get_image(id, {{"absorption", "0.5"}});
  EXPECT_EQ(response.status, 409);
  EXPECT_EQ(json::parse(std::get<std::string>(response.body))["errors"][0]["pointer"],
            "?absorption");
}

TEST(ExplorableService, RefusesParametersThatMeanNothing) {
  Explored service;
  const std::string id = service.finished(request(0.3, true));
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"absorption", "1.5"},
                                                        {"absorption", "nan"},
                                                        {"absorption", ""},
                                                        {"absorber", "nope"}}) {
    const HttpResponse response = service.get_image(id, {{name, value}});
    EXPECT_EQ(response.status, 422) << name << value;
    EXPECT_EQ(json::parse(std::get<std::string>(response.body))["errors"][0]["pointer"],
              "?" + name);
  }
  EXPECT_EQ(service.get_image(id, {{"absorption", "1"}, {"absorber", "leaf"}}).status, 200);
}

}  // namespace
}  // namespace translucube::server::test
