#include "server/store/artifact_store.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "renderer/film/film_bytes.h"
#include "tests/server/fixture.h"

namespace translucube::server {
namespace {

using test::TempFolder;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

PassFilm a_pass(std::uint32_t index, float value = 1) {
  PassFilm film;
  film.width = 4;
  film.height = 2;
  film.pass = {index, index * 4, 4};
  film.sum.assign(24, value);
  film.counters.camera_samples = 32;
  return film;
}

Film merged(std::uint32_t passes) {
  Film film(4, 2, 1);
  for (std::uint32_t i = 0; i < passes; ++i) merge(film, a_pass(i, 1.0f + i));
  return film;
}

TEST(ArtifactStoreTest, ReadsBackWhatItWrote) {
  const TempFolder folder;
  ArtifactStore store(folder.path());
  store.write("a", "x.bin", "bytes");
  EXPECT_EQ(store.open("a", "x.bin")->read_all(), "bytes");
  EXPECT_FALSE(store.open("a", "y.bin"));
  EXPECT_FALSE(store.open("b", "x.bin"));
  EXPECT_THAT(store.names("a"), ElementsAre("x.bin"));
  store.remove_all("a");
  EXPECT_THAT(store.ids(), IsEmpty());
}

TEST(ArtifactStoreTest, AWriterThatFailsLeavesWhatWasThereAndNoTemporary) {
  const TempFolder folder;
  ArtifactStore store(folder.path());
  store.write("a", "x.bin", "old");
  EXPECT_THROW(store.write("a", "x.bin",
                           [](const std::filesystem::path& file) {
                             test::write_file(file, "half of the n");
                             throw std::runtime_error("no more");
                           }),
               std::runtime_error);
  EXPECT_EQ(store.open("a", "x.bin")->read_all(), "old");
  EXPECT_THAT(store.names("a"), ElementsAre("x.bin"));
}

TEST(ArtifactStoreTest, TemporariesOfACrashAreRemovedAtTheStart) {
  const TempFolder folder;
  {
    ArtifactStore store(folder.path());
    store.write("a", "x.bin", "whole");
    // The writer ends the process as a crash would.
    const pid_t child = fork();
    if (child == 0) {
      store.write("a", "x.bin", [](const std::filesystem::path& file) {
        test::write_file(file, "half");
        ::_exit(0);
      });
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(store.names("a").size(), 2u);
  }
  const ArtifactStore store(folder.path());
  EXPECT_THAT(store.names("a"), ElementsAre("x.bin"));
  EXPECT_EQ(store.open("a", "x.bin")->read_all(), "whole");
}

TEST(ArtifactStoreTest, AnOpenFileKeepsItsBytesWhenItsNameIsReplacedOrRemoved) {
  const TempFolder folder;
  ArtifactStore store(folder.path());
  store.write("a", "x.bin", "first");
  const auto first = store.open("a", "x.bin");
  store.write("a", "x.bin", "second");
  const auto second = store.open("a", "x.bin");
  store.remove_all("a");
  EXPECT_EQ(first->read_all(), "first");
  EXPECT_EQ(second->read_all(), "second");
  EXPECT_NE(first->version(), second->version());
}

TEST(ArtifactStoreTest, TheMergedFilmComesFromTheNewestCheckpointAndThePassesBehindIt) {
  const TempFolder folder;
  ArtifactStore store(folder.path());
  for (std::uint32_t i = 0; i < 4; ++i) store.write_pass("a", a_pass(i, 1.0f + i));
  EXPECT_EQ(to_bytes(store.read_film("a", 4)), to_bytes(merged(4)));
  EXPECT_EQ(to_bytes(store.read_film("a", 3)), to_bytes(merged(3)));
  store.write_film("a", merged(3));
  store.remove_films_before("a", 3);
  EXPECT_THAT(store.names("a"), UnorderedElementsAre("film-3.bin", "pass-3.film"));
  EXPECT_EQ(to_bytes(store.read_film("a", 4)), to_bytes(merged(4)));
  store.remove_films("a");
  EXPECT_THAT(store.names("a"), IsEmpty());
  EXPECT_EQ(store.read_film("a", 4).passes, 0u);
}

TEST(ArtifactStoreTest, ACheckpointThatIsNotWholeCountsAsNotThere) {
  const TempFolder folder;
  ArtifactStore store(folder.path());
  for (std::uint32_t i = 0; i < 4; ++i) store.write_pass("a", a_pass(i, 1.0f + i));
  store.write_film("a", merged(3));
  const auto film = store.path("a", "film-3.bin");
  std::filesystem::resize_file(film, std::filesystem::file_size(film) - 1);
  EXPECT_EQ(to_bytes(store.read_film("a", 4)), to_bytes(merged(4)));
  std::string bytes = test::read_file(store.path("a", "pass-2.film"));
  bytes[bytes.size() - 9] ^= 1;
  test::write_file(store.path("a", "pass-2.film"), bytes);
  EXPECT_EQ(store.read_film("a", 4).passes, 2u);
  EXPECT_FALSE(store.read_pass("a", {2, 8, 4}));
  EXPECT_TRUE(store.read_pass("a", {3, 12, 4}));
  EXPECT_FALSE(store.read_pass("a", {3, 12, 8})) << "another pass than the one planned";
}

/// Runs `work` in a child that may write no file over `bytes` bytes, as if the disk were full
/// there; the child's exit status.
int under_file_limit(rlim_t bytes, const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(work());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ArtifactStoreTest, ADiskThatIsFullIsAnErrorAndLeavesWhatWasThere) {
  const TempFolder folder;
  ArtifactStore store(folder.path());
  store.write("a", "x.bin", "old");
  EXPECT_EQ(under_file_limit(100'000,
                             [&] {
                               try {
                                 store.write("a", "x.bin", std::string(1'000'000, 'n'));
                               } catch (const FileError&) {
                                 return 0;
                               }
                               return 1;
                             }),
            0);
  EXPECT_EQ(store.open("a", "x.bin")->read_all(), "old");
  EXPECT_THAT(store.names("a"), ElementsAre("x.bin"));
}

}  // namespace
}  // namespace translucube::server
