// Everything is bounded: files within their quota, lines that nobody reads, memory that a container
// allows, long spectra of sweeps; and the data folder is its user's alone.

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <ctime>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "server/base/line_writer.h"
#include "server/base/memory.h"
#include "server/store/sqlite/connection.h"
#include "server/store/submission.h"
#include "tests/server/fixture.h"
#include "tests/support/sanitized.h"

namespace translucube::server::test {
namespace {

using api::JobState;
namespace fs = std::filesystem;

std::uint64_t bytes_below(const fs::path& folder) {
  std::uint64_t sum = 0;
  std::error_code gone;
  for (const auto& entry : fs::recursive_directory_iterator(folder, gone))
    if (entry.is_regular_file(gone)) sum += entry.file_size(gone);
  return sum;
}

constexpr std::uint64_t quota = 1 << 20;

ServiceOptions within_a_quota() {
  ServiceOptions options;
  options.artifact_bytes = quota;
  return options;
}

TEST(QuotaTest, WhatIsMadeOfPicturesOnDemandCountsAlsoWhereNobodyWorks) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), within_a_quota());
  const std::string id = tested.wait(tested.submit(small_request(4, 1, 128)).id).id;
  std::uint64_t most = 0;
  for (int round = 0; round < 3; ++round)
    for (const char* colorspace : {"ACEScg", "XYZ"}) {
      ASSERT_TRUE(tested.service.image(id, {ImageFormat::exr, {}, {}, colorspace}));
      ASSERT_TRUE(tested.service.image(id, {ImageFormat::tiff, {}, {}, {}}));
      ASSERT_TRUE(tested.service.image(id, {ImageFormat::png, {}, {}, {}}));
      most = std::max(most, tested.artifacts.figures().bytes);
    }
  EXPECT_EQ(tested.artifacts.figures().bytes, bytes_below(folder / "artifacts"));
  tested.artifacts.write(tested.content(id), "derived-large.exr", std::string(2 * quota, 'x'));
  EXPECT_TRUE(eventually([&] { return tested.artifacts.figures().bytes <= quota; }));
  EXPECT_EQ(tested.artifacts.figures().bytes, bytes_below(folder / "artifacts"));
  EXPECT_FALSE(tested.exr(id).empty()) << "what is derived goes first";
}

TEST(QuotaTest, SheetsCountAndGo) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), within_a_quota());
  const std::string sweep =
      tested.service
          .submit_sweep(R"({"base":{"material":{"cube":{"absorption":0.3,"roughness":0.3,)"
                        R"("scattering":0.5}},"image":{"width":64,"height":64},)"
                        R"("quality":{"samples":4}},"axes":{"roughness":[0.1,0.2,0.3]}})",
                        {})
          ->status.id;
  ASSERT_TRUE(eventually([&] { return api::is_end(tested.service.get_sweep(sweep)->state); }));
  const auto sheet = tested.service.sheet(sweep, {ImageFormat::tiff, {}, {}, {}});
  ASSERT_TRUE(sheet);
  EXPECT_GE(tested.artifacts.bytes(sweep), sheet->file->size());
  EXPECT_EQ(tested.artifacts.figures().bytes, bytes_below(folder / "artifacts"));
  tested.artifacts.write(sweep, "sheet-large.tiff", std::string(2 * quota, 'x'));
  EXPECT_TRUE(eventually([&] { return tested.artifacts.bytes(sweep) == 0; }));
}

TEST(QuotaTest, NothingIsBegunWhileFilmsOfWhatWasBegunTakeTheRoom) {
  const TempFolder folder;
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 1500;
  // Another worker is free for what comes later.
  ServiceOptions options = within_a_quota();
  options.workers = 2;
  TestService tested(folder.path(), renderer.engine(), options);
  const std::string begun = tested.submit(small_request(8, 1)).id;
  ASSERT_TRUE(eventually([&] { return tested.state(begun) == JobState::running; }));
  tested.artifacts.write(begun, "film-0.bin", std::string(2 * quota, 'x'));
  std::this_thread::sleep_for(std::chrono::milliseconds(1200));  // the house is kept once a second
  const std::string later = tested.submit(small_request(4, 2)).id;
  ASSERT_TRUE(eventually([&] { return renderer.passes >= 1; }));
  EXPECT_EQ(tested.state(later), JobState::queued);
  EXPECT_EQ(tested.wait(begun).state, JobState::succeeded);
  EXPECT_EQ(tested.wait(later).state, JobState::succeeded);
  EXPECT_LE(renderer.most_tracing, 1);
}

TEST(LineWriterTest, NobodyWaitsForAPipeThatIsNotRead) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::string line(99, 'x');
  std::string read;
  {
    LineWriter writer(ends[1], 200'000);
    writer.tell_drops([](std::uint64_t lines) { return std::to_string(lines) + " lost\n"; });
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 10'000; ++i) writer.add(line + '\n');
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    EXPECT_GT(writer.dropped(), 1000u);
    std::jthread reader([&] {
      char buffer[4096];
      while (read.find("last\n") == read.npos)
        read.append(buffer, static_cast<std::size_t>(::read(ends[0], buffer, sizeof buffer)));
    });
    while (true) {  // until there is room for it
      const std::uint64_t before = writer.dropped();
      writer.add("last\n");
      if (writer.dropped() == before) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    reader.join();
    std::uint64_t whole = 0, told = 0;
    std::istringstream lines(read);
    for (std::string text; std::getline(lines, text);) {
      whole += text == line ? 1 : 0;
      if (text.ends_with(" lost")) told += std::stoull(text);
    }
    EXPECT_EQ(told, writer.dropped());
    EXPECT_GE(whole + told, 10'000u);
    EXPECT_GT(whole, 1000u);
  }
  {
    LineWriter writer(ends[1]);
    for (int i = 0; i < 10'000; ++i) writer.add(line + '\n');
  }  // ends, though nobody reads
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(MemoryTest, AControlGroupOfEitherVersionBoundsIt) {
  const TempFolder folder;
  const auto member = [&](const std::string& lines) {
    write_file(folder / "cgroup", lines);
    return group_memory(folder.path() / "fs", folder / "cgroup");
  };
  fs::create_directories(folder / "fs/a/b");
  fs::create_directories(folder / "fs/memory/docker/x");
  write_file(folder / "fs/a/memory.max", "300000000\n");
  write_file(folder / "fs/a/b/memory.max", "max\n");
  write_file(folder / "fs/memory/docker/x/memory.limit_in_bytes", "200000000\n");
  constexpr auto any = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(member("0::/\n"), any);
  EXPECT_EQ(member("0::/a/b\n"), 300'000'000u) << "a group above counts";
  EXPECT_EQ(member("5:cpu,memory:/docker/x\n4:devices:/\n"), 200'000'000u);
  EXPECT_EQ(member("nonsense\n"), any);
  write_file(folder / "fs/memory.max", "100000000\n");  // as a container sees its own group
  EXPECT_EQ(member("0::/\n"), 100'000'000u);
  EXPECT_GT(available_memory(), 1u << 20);
}

TEST(SubmissionTest, ASweepOfManyPointsWithALongSpectrumIsCheap) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {0});
  nlohmann::json spectrum;
  for (int i = 0; i < 4000; ++i) {
    spectrum["wavelengths_nm"].push_back(380 + 0.1 * i);
    spectrum["values"].push_back(1 + i % 7);
  }
  nlohmann::json axis{{"from", 0}, {"to", 1}, {"count", 100}};
  const nlohmann::json sweep{
      {"base",
       {{"material",
         {{"cube", {{"absorption", 0.3}, {"roughness", 0.3}, {"scattering", 0.5}}},
          {"absorber", spectrum}}},
        {"image", {{"width", 8}, {"height", 8}}},
        {"quality", {{"samples", 4}}}}},
      {"axes", {{"absorption", axis}, {"roughness", axis}}}};
  const auto start = std::clock();
  const auto submitted = tested.service.submit_sweep(sweep.dump(), {});
  ASSERT_TRUE(submitted);
  EXPECT_TRUE(tested.service.tell_sweep(submitted->status.id));
  const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_LT(seconds, sanitized ? 60 : 6) << "each point printed and hashed the whole spectrum: 13 s";
  // A point has the content of the same render alone.
  const api::RenderRequest point = api::point_request(submitted->status.sweep, 4321);
  EXPECT_EQ(new_job(point, tested.catalog, {}).content,
            tested.store.picture_of_point(submitted->status.id, 4321)->content);
}

TEST(DataFolderTest, IsItsUsersAloneAlsoWhereItWasNot) {
  const TempFolder folder;
  const auto mode = [](const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(::stat(path.c_str(), &status), 0) << path;
    return status.st_mode & 0777;
  };
  { const DataFolder made(folder / "new"); }
  EXPECT_EQ(mode(folder / "new") & 077, 0u);
  fs::create_directories(folder / "old/artifacts");
  write_file(folder / "old/jobs.sqlite", "rows");
  ::chmod((folder / "old").c_str(), 0755);
  ::chmod((folder / "old/jobs.sqlite").c_str(), 0644);
  { const DataFolder old(folder / "old"); }
  EXPECT_EQ(mode(folder / "old"), 0700u);
  EXPECT_EQ(mode(folder / "old/jobs.sqlite"), 0600u);
}

TEST(DataFolderTest, ServesOneServiceAlsoWhereItsLockFileWasRemoved) {
  const TempFolder folder;
  const DataFolder first(folder / "data");
  fs::remove(folder / "data/lock");
  EXPECT_THROW(DataFolder(folder / "data"), StoreError);
}

TEST(DataFolderTest, WhatIsRemovedUnderneathStopsTheService) {
  const std::vector<std::string> parts{"", "lock", "jobs.sqlite"};
  for (const std::string& part : parts) {
    const TempFolder folder;
    FakeRenderer renderer;
    const fs::path data = folder / "data", removed = part.empty() ? data : data / part;
    TestService tested(data, renderer.engine());
    ASSERT_FALSE(tested.service.unready_reason());
    fs::rename(removed, folder / "away");
    EXPECT_TRUE(tested.service.unready_reason()) << part;
    const auto refused = tested.service.submit(small_request(4), {});
    ASSERT_FALSE(refused) << part;
    EXPECT_EQ(refused.problem().code, api::ProblemCode::storage_failure);
    fs::rename(folder / "away", removed);
  }
}

TEST(DamageTest, ADamagedRowIsLeftOutOfAListWhoseOtherRowsAreTold) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {0});
  std::vector<std::string> ids;
  for (int seed = 1; seed <= 5; ++seed) ids.push_back(tested.submit(small_request(4, seed)).id);
  sql::Connection damage(tested.data.store_file(), sql::Connection::Access::read_write);
  damage.execute("UPDATE jobs SET state = 'qxeued' WHERE id = '" + ids[1] + "'");
  damage.execute("UPDATE jobs SET request = '{\"a' WHERE id = '" + ids[3] + "'");
  const auto page = tested.service.list({});
  ASSERT_TRUE(page);
  const auto told = nlohmann::json::parse(api::render_list_json(page->renders, page->next_cursor));
  std::vector<std::string> listed;
  for (const auto& render : told["renders"]) listed.push_back(render["id"]);
  EXPECT_THAT(listed, testing::ElementsAre(ids[4], ids[2], ids[0]));
}

}  // namespace
}  // namespace translucube::server::test
