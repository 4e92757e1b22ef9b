#include "renderer/light/environment_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "picture/image_io.h"
#include "renderer/render.h"
#include "tests/support/peers.h"

namespace translucube::test {
namespace {

namespace fs = std::filesystem;

class EnvironmentCacheTest : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// An image of one colour.
  fs::path write(const std::string& name, float value, int width = 8) const {
    Image image(width, 4);
    for (float& p : image.pixels) p = value;
    write_image(folder_ / name, image, ImageFormat::exr, {});
    return folder_ / name;
  }

  // Its own: other tests of this file may run at the same time.
  const fs::path folder_ =
      fs::temp_directory_path() / ("translucube-environments-" + std::to_string(getpid()));
  EnvironmentCache cache_;
};

TEST_F(EnvironmentCacheTest, KeepsWhatIsAskedForAgain) {
  const fs::path file = write("a.exr", 2);
  const auto first = cache_.get(file, 0, 1);
  EXPECT_EQ(cache_.get(file, 0, 1), first);
  EXPECT_NE(cache_.get(file, 0.5, 1), first);
  EXPECT_EQ(cache_.get(file, 0, 3)->value_from({0, 1, 0}).radiance.g, 6);
  EXPECT_EQ(cache_.get(file, 0, 1), first);
}

TEST_F(EnvironmentCacheTest, SeesThatAFileHasChanged) {
  const fs::path file = write("a.exr", 2);
  cache_.get(file, 0, 1);
  write("a.exr", 5);
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(1));
  EXPECT_EQ(cache_.get(file, 0, 1)->value_from({0, 1, 0}).radiance.g, 5);
}

TEST_F(EnvironmentCacheTest, ForgetsTheOldestWhereTheyWouldTakeTooMuch) {
  const fs::path small = write("small.exr", 1), large = write("large.exr", 1, 1 << 21);
  const std::weak_ptr<const ImageEnvironment> kept = cache_.get(small, 0, 1);
  EXPECT_FALSE(kept.expired());
  cache_.get(large, 0, 1);
  EXPECT_TRUE(kept.expired());
}

TEST_F(EnvironmentCacheTest, SaysWhyAnImageCannotBeRead) {
  EXPECT_THROW(cache_.get(folder_ / "absent.exr", 0, 1), ImageError);
}

TEST_F(EnvironmentCacheTest, ChangesNoPicture) {
  SceneSpec spec = peer_scene({0, 0, 10}, 16, 1);
  const Film alone = trace(*build_scene(spec), 4);
  build_scene(spec, &cache_);
  const Film cached = trace(*build_scene(spec, &cache_), 4);
  EXPECT_EQ(develop(alone).pixels, develop(cached).pixels);
}

}  // namespace
}  // namespace translucube::test
