// Nothing good is deleted on doubt: stores that were lost in part, files that cannot be read, bytes
// that have changed.

#include <gmock/gmock.h>
#include <sys/resource.h>

#include "tests/server/fixture.h"

namespace translucube::server::test {
namespace {

using api::JobState;
using api::ProblemCode;
using testing::IsEmpty;
namespace fs = std::filesystem;

ImageQuery form(ImageFormat format) { return {format, {}, {}, {}}; }

std::size_t pictures_on_disk(const fs::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "artifacts"))
    count += entry.path().filename().string().starts_with("image-") ? 1 : 0;
  return count;
}

/// A data folder with finished renders, as a process that was killed leaves it: its journal whole.
void fill(const fs::path& folder, const fs::path& killed, int renders) {
  FakeRenderer renderer;
  TestService tested(folder, renderer.engine());
  for (int seed = 1; seed <= renders; ++seed)
    EXPECT_EQ(tested.wait(tested.submit(small_request(4, seed)).id).state, JobState::succeeded);
  fs::copy(folder, killed, fs::copy_options::recursive);
}

TEST(DoubtTest, AStoreThatLostItsJournalCostsNoPicture) {
  using Damage = std::function<void(const fs::path& journal)>;
  const std::vector<Damage> damages{
      [](const fs::path& journal) { fs::remove(journal); },
      [](const fs::path& journal) { fs::resize_file(journal, 0); },
      [](const fs::path& journal) { fs::resize_file(journal, fs::file_size(journal) / 2); },
      [](const fs::path& journal) {  // one bit of its header
        std::string bytes = read_file(journal);
        bytes[17] ^= 1;
        write_file(journal, bytes);
      },
      [](const fs::path& journal) {  // one bit in the middle
        std::string bytes = read_file(journal);
        bytes[bytes.size() / 2] ^= 1;
        write_file(journal, bytes);
      }};
  const TempFolder folder;
  fill(folder / "data", folder / "killed", 6);
  ASSERT_TRUE(fs::exists(folder.path() / "killed/jobs.sqlite-wal"));
  ASSERT_EQ(pictures_on_disk(folder / "killed"), 6u);
  for (std::size_t i = 0; i < damages.size(); ++i) {
    const fs::path data = folder / std::to_string(i);
    fs::copy(folder / "killed", data, fs::copy_options::recursive);
    damages[i](data / "jobs.sqlite-wal");
    FakeRenderer renderer;
    TestService tested(data, renderer.engine());
    EXPECT_EQ(tested.wait(tested.submit(small_request(4, 1)).id).state, JobState::succeeded);
    EXPECT_GE(pictures_on_disk(data), 6u) << i;
  }
}

TEST(DoubtTest, AStorePutBackFromACopyCostsNoPictureAndTheRightOneHasThemAllAgain) {
  const TempFolder folder;
  fs::create_directories(folder / "data");
  std::vector<std::string> ids;
  const auto render = [&](TestService& tested, int seed) {
    ids.push_back(tested.wait(tested.submit(small_request(4, seed)).id).id);
  };
  FakeRenderer renderer;
  {
    TestService tested(folder / "data", renderer.engine());
    for (int seed = 1; seed <= 3; ++seed) render(tested, seed);
  }
  fs::copy_file(folder / "data/jobs.sqlite", folder / "older");
  {
    TestService tested(folder / "data", renderer.engine());
    for (int seed = 4; seed <= 6; ++seed) render(tested, seed);
  }
  fs::rename(folder / "data/jobs.sqlite", folder / "newer");
  fs::copy_file(folder / "older", folder / "data/jobs.sqlite");
  {
    TestService tested(folder / "data", renderer.engine());
    EXPECT_EQ(tested.artifacts.figures().unknown, 3u);
    EXPECT_EQ(pictures_on_disk(folder / "data"), 6u);
  }
  fs::rename(folder / "newer", folder / "data/jobs.sqlite");
  TestService tested(folder / "data", renderer.engine());
  EXPECT_EQ(tested.artifacts.figures().unknown, 0u);
  for (const std::string& id : ids) EXPECT_FALSE(tested.exr(id).empty());
}

TEST(DoubtTest, TheStoresFileSaysWhatItIsFromItsFirstMomentOn) {
  const TempFolder folder;
  const auto store = open_job_store(folder / "jobs.sqlite");
  // Bytes 60 to 63 are its user version (SQLite file format, 1.3).
  EXPECT_GT(read_file(folder / "jobs.sqlite").substr(0, 64).back(), 0);
  EXPECT_GT(fs::file_size(folder / "jobs.sqlite"), 4096u);
}

TEST(DoubtTest, ACheckpointBringsWhatWasAcceptedOutOfTheJournal) {
  const TempFolder folder;
  const auto store = open_job_store(folder / "jobs.sqlite");
  ASSERT_TRUE(store->submit({"{}", "{}", {}, 4, Pass{0, 0, 4}, "content"}));
  store->checkpoint();
  fs::create_directories(folder / "copy");
  fs::copy_file(folder / "jobs.sqlite", folder / "copy/jobs.sqlite");  // without its journal
  EXPECT_EQ(open_job_store(folder / "copy/jobs.sqlite")->list({}).size(), 1u);
}

/// No further file can be opened for as long as it lives.
class NoDescriptors {
 public:
  NoDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &limit_);
    const rlimit none{0, limit_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &limit_); }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit limit_{};
};

TEST(DoubtTest, APictureThatCannotBeOpenedNowIsThereLater) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  for (const ImageFormat format : {ImageFormat::exr, ImageFormat::png}) {
    {
      const NoDescriptors none;
      const auto served = tested.service.image(id, form(format));
      ASSERT_FALSE(served);
      EXPECT_EQ(served.problem().code, ProblemCode::storage_failure);
    }
    EXPECT_EQ(pictures_on_disk(folder.path()), 1u);
    EXPECT_TRUE(tested.service.image(id, form(format)));
  }
}

TEST(DoubtTest, AFolderThatIsAwayLosesNoPicture) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  fs::rename(folder / "artifacts", folder / "away");
  const auto served = tested.service.image(id, form(ImageFormat::png));
  ASSERT_FALSE(served);
  EXPECT_EQ(served.problem().code, ProblemCode::storage_failure);
  fs::rename(folder / "away", folder / "artifacts");
  EXPECT_TRUE(tested.service.image(id, form(ImageFormat::png)));
}

TEST(DoubtTest, ABitThatFlippedIsNeverServedAndIsKeptAside) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  const auto first = *tested.service.image(id, form(ImageFormat::exr));
  const std::string whole = first.file->read_all();
  for (const std::size_t at : {std::size_t(0), whole.size() / 2, whole.size() - 1}) {
    const std::string content = tested.content(id);
    const std::string name = tested.store.find_result(content)->image;
    std::string flipped = whole;
    flipped[at] ^= 1;
    write_file(tested.artifacts.path(content, name), flipped);
    const auto served = tested.service.image(id, form(ImageFormat::exr));
    ASSERT_FALSE(served) << at;
    EXPECT_EQ(served.problem().code, ProblemCode::gone);
    EXPECT_EQ(read_file(tested.artifacts.path(content, "damaged-" + name)), flipped);
    EXPECT_EQ(tested.wait(tested.submit(small_request(4)).id).state, JobState::succeeded);
    const auto again = *tested.service.image(id, form(ImageFormat::exr));
    EXPECT_EQ(again.file->read_all(), whole);
    EXPECT_EQ(again.etag, first.etag) << "the same bytes";
  }
  EXPECT_EQ(tested.artifacts.figures().damaged, 3u);
}

TEST(DoubtTest, ADerivedPictureThatIsNotWholeIsMadeAgain) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  const std::string whole = tested.service.image(id, form(ImageFormat::png))->file->read_all();
  const std::string content = tested.content(id);
  for (const double share : {0.0, 0.5, 0.99}) {
    for (const std::string& name : tested.artifacts.names(content))
      if (name.starts_with("derived-"))
        fs::resize_file(tested.artifacts.path(content, name),
                        static_cast<std::uintmax_t>(share * double(whole.size())));
    const auto again = tested.service.image(id, form(ImageFormat::png));
    ASSERT_TRUE(again);
    EXPECT_EQ(again->file->read_all(), whole) << share;
  }
  EXPECT_EQ(pictures_on_disk(folder.path()), 1u);
}

TEST(DoubtTest, ARequestWhosePictureIsLostIsTracedAgainAtOnce) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  const std::string content = tested.content(id);
  fs::remove(tested.artifacts.path(content, tested.store.find_result(content)->image));
  const api::RenderStatus again = tested.submit(small_request(4));
  EXPECT_FALSE(again.cached);
  EXPECT_EQ(tested.wait(again.id).state, JobState::succeeded);
  EXPECT_FALSE(tested.exr(again.id).empty());
}

TEST(DoubtTest, ASheetShowsAPictureThatWasLostOnlyUntilItIsMadeAgain) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string request =
      R"({"base":{"material":{"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5}},)"
      R"("image":{"width":64,"height":64},"quality":{"samples":4}},)"
      R"("axes":{"roughness":[0.1,0.2]}})";
  const auto made = [&] {
    const std::string id = tested.service.submit_sweep(request, {})->status.id;
    EXPECT_TRUE(eventually([&] { return api::is_end(tested.service.get_sweep(id)->state); }));
    return id;
  };
  const std::string sweep = made();
  const auto sheet = [&] {
    return tested.service.sheet(sweep, form(ImageFormat::png))->file->read_all();
  };
  const std::string whole = sheet();
  const std::string content = tested.store.picture_of_point(sweep, 0)->content;
  fs::remove(tested.artifacts.path(content, tested.store.find_result(content)->image));
  EXPECT_NE(sheet(), whole);
  made();
  EXPECT_EQ(sheet(), whole);
}

}  // namespace
}  // namespace translucube::server::test
