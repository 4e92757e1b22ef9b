// What is true of the SQLite store alone: its file, and that it serves one process.

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "server/base/ids.h"
#include "server/store/data_folder.h"
#include "tests/server/store/stored.h"
#include "tests/server/temp_folder.h"

namespace translucube::server {
namespace {

using api::JobState;
using test::a_completion;
using test::a_job;
using test::submit;
using test::TempFolder;

TEST(SqliteStoreTest, OpenedAgainFreesTheTasksThatTheDeadProcessHeld) {
  const TempFolder folder;
  std::string id;
  std::optional<Task> task;
  {
    const auto store = open_job_store(folder / "jobs.sqlite");
    id = submit(*store);
    store->complete(*store->claim(Priority::interactive), a_completion(), {1, 4, 4});
    task = store->claim(Priority::interactive);
  }
  const auto store = open_job_store(folder / "jobs.sqlite");
  EXPECT_EQ(store->find(id)->state, JobState::queued);
  EXPECT_EQ(store->find(id)->progress.samples, 4u);
  EXPECT_EQ(store->find(id)->progress.seconds, 1);
  EXPECT_FALSE(store->complete(*task, a_completion(), {2, 8, 4})) << "nobody holds it now";
  const Task again = *store->claim(Priority::interactive);
  EXPECT_EQ(again.pass, task->pass);
  EXPECT_EQ(again.attempts, 2);
}

std::optional<StoreError::Kind> open_failure(const std::filesystem::path& file) {
  try {
    open_job_store(file);
  } catch (const StoreError& error) {
    EXPECT_NE(std::string(error.what()).find("job store"), std::string::npos) << error.what();
    return error.kind;
  }
  return std::nullopt;
}

TEST(SqliteStoreTest, AFileThatIsNoStoreIsRefused) {
  const TempFolder folder;
  test::write_file(folder / "jobs.sqlite", std::string(10'000, 'x'));
  EXPECT_EQ(open_failure(folder / "jobs.sqlite"), StoreError::Kind::corrupt);
}

TEST(SqliteStoreTest, AStoreCutShortIsRefused) {
  const TempFolder folder;
  {
    const auto store = open_job_store(folder / "jobs.sqlite");
    for (int i = 0; i < 200; ++i)
      submit(*store, a_job("{\"a\":\"" + std::string(500, 'a') + "\"}"));
  }
  std::filesystem::resize_file(folder / "jobs.sqlite",
                               std::filesystem::file_size(folder / "jobs.sqlite") / 2);
  EXPECT_EQ(open_failure(folder / "jobs.sqlite"), StoreError::Kind::corrupt);
}

TEST(SqliteStoreTest, AStoreOfANewerServiceIsRefused) {
  const TempFolder folder;
  open_job_store(folder / "jobs.sqlite");
  // Bytes 60 to 63 of the file are its user version (SQLite file format, 1.3).
  std::fstream file(folder / "jobs.sqlite", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(63).put(99);
  file.close();
  EXPECT_EQ(open_failure(folder / "jobs.sqlite"), StoreError::Kind::unavailable);
}

TEST(SqliteStoreTest, AStoreWhoseFolderIsNotThereIsRefused) {
  EXPECT_EQ(open_failure("/nowhere/jobs.sqlite"), StoreError::Kind::unavailable);
}

TEST(SqliteStoreTest, ADiskThatRefusesIsAnErrorAndLeavesTheStoreAsItWas) {
  const TempFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    const auto store = open_job_store(folder / "jobs.sqlite");
    for (int i = 0; i < 10; ++i) submit(*store);
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{400'000, 400'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const NewJob large = a_job("{\"a\":\"" + std::string(50'000, 'a') + "\"}");
    int accepted = 10;
    try {
      for (; accepted < 100; ++accepted) submit(*store, large);
      ::_exit(1);  // the limit was not felt
    } catch (const StoreError&) {
    }
    ::_exit(std::ssize(store->list({{}, {}, 1000})) == accepted ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_FALSE(open_failure(folder / "jobs.sqlite"));
}

TEST(DataFolderTest, ServesOneServiceAtATime) {
  const TempFolder folder;
  const auto first = std::make_unique<DataFolder>(folder / "data");
  EXPECT_THROW(DataFolder(folder / "data"), StoreError);
}

TEST(DataFolderTest, IsFreeAgainWhenItsServiceEnds) {
  const TempFolder folder;
  { const DataFolder first(folder / "data"); }
  EXPECT_NO_THROW(DataFolder(folder / "data"));
}

TEST(DataFolderTest, ThatCannotBeMadeIsAnError) {
  EXPECT_THROW(DataFolder("/dev/null/x"), StoreError);
}

TEST(IdTest, SortByCreationWithinAMillisecondAndWhenTheClockIsSetBack) {
  IdSource ids;
  std::string last;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = ids.next(i < 500 ? 5'000'000 : 4'000'000);
    EXPECT_TRUE(is_id(id)) << id;
    EXPECT_LT(last, id);
    last = id;
  }
  EXPECT_LT(last, IdSource(last).next(0));
}

TEST(IdTest, NothingElseIsAnId) {
  for (const char* text :
       {"", "..", "../../etc/passwd", "01ARZ3NDEKTSV4RRFFQ69G5FA", "01arz3ndektsv4rrffq69g5fav",
        "81ARZ3NDEKTSV4RRFFQ69G5FAV", "01ARZ3NDEKTSV4RRFFQ69G5F/V", "01ARZ3NDEKTSV4RRFFQ69G5FAVX"})
    EXPECT_FALSE(is_id(text)) << text;
  EXPECT_TRUE(is_id("01ARZ3NDEKTSV4RRFFQ69G5FAV"));
}

}  // namespace
}  // namespace translucube::server
