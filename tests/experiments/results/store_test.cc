#include "experiments/results/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/fsuid.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "tests/support/full_disk.h"

namespace ttf::experiments::results {
namespace {

class StoreTest : public testing::Test {
 protected:
  StoreTest() : folder_((std::filesystem::temp_directory_path() / "ttfusion_store_XXXXXX").string()) {
    if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no folder");
  }
  ~StoreTest() override { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ + "/results.sqlite"; }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.push_back(entry.path().filename());
    return names;
  }

  std::string folder_;
  const StoreHead head_{"noise", "0123", "1.0", "kind: sweep\n", {"rmse", "a \"quoted\" one, with; all"}};
  const results::Row first_{{0, 0, 1}, kDone, {1.5, -2.0}}, second_{{0, 1, 0}, kDone, {0.1, std::nan("")}},
      third_{{2, 0, 0}, "it's broken: \"so\"", {std::nan(""), std::nan("")}};
};

// Another program that reads the file, row by row, or that keeps it for itself.
class Other {
 public:
  explicit Other(const std::string& path) { EXPECT_EQ(sqlite3_open(path.c_str(), &handle_), SQLITE_OK); }
  ~Other() {
    end();
    sqlite3_close(handle_);
  }
  Other(const Other&) = delete;
  Other& operator=(const Other&) = delete;

  // Returns whether there was a row; the reading lasts until end().
  bool begins_reading() {
    EXPECT_EQ(sqlite3_prepare_v2(handle_, "SELECT * FROM runs", -1, &rows_, nullptr), SQLITE_OK);
    return sqlite3_step(rows_) == SQLITE_ROW;
  }
  void end() {
    sqlite3_finalize(std::exchange(rows_, nullptr));
    sqlite3_exec(handle_, "ROLLBACK", nullptr, nullptr, nullptr);
  }
  bool takes_it_all() { return sqlite3_exec(handle_, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr) == SQLITE_OK; }

 private:
  sqlite3* handle_ = nullptr;
  sqlite3_stmt* rows_ = nullptr;
};

void expect_same(const results::Row& row, const Row& other) {
  EXPECT_EQ(row.key, other.key);
  EXPECT_EQ(row.status, other.status);
  ASSERT_EQ(row.values.size(), other.values.size());
  for (std::size_t v = 0; v < row.values.size(); ++v)
    EXPECT_TRUE(row.values[v] == other.values[v] || (std::isnan(row.values[v]) && std::isnan(other.values[v])));
}

TEST_F(StoreTest, AddedRowsComeBackInOrder) {
  {
    Store store = Store::create(path(), head_);
    store.add({third_, second_});
    store.add({first_});
  }
  const Store store = Store::open(path());
  EXPECT_EQ(store.head().name, head_.name);
  EXPECT_EQ(store.head().identity, head_.identity);
  EXPECT_EQ(store.head().version, head_.version);
  EXPECT_EQ(store.head().text, head_.text);
  EXPECT_EQ(store.head().measures, head_.measures);
  EXPECT_EQ(store.count(), 3u);
  EXPECT_THAT(store.keys(), testing::ElementsAre(first_.key, second_.key, third_.key));
  std::vector<results::Row> runs;
  store.for_each([&](const results::Row& row) { runs.push_back(row); });
  ASSERT_EQ(runs.size(), 3u);
  expect_same(runs[0], first_);
  expect_same(runs[1], second_);
  expect_same(runs[2], third_);
  EXPECT_EQ(store.of_point(0).size(), 2u);
  EXPECT_EQ(store.of_point(1).size(), 0u);
}

TEST_F(StoreTest, ARunThatIsThereStays) {
  Store store = Store::create(path(), head_);
  store.add({first_});
  store.add({results::Row{first_.key, kDone, {9.0, 9.0}}, second_});
  EXPECT_EQ(store.count(), 2u);
  expect_same(store.of_point(0).front(), first_);
}

TEST_F(StoreTest, HowManyAreAskedForIsKept) {
  StoreHead head = head_;
  head.replications = 40;
  {
    Store store = Store::create(path(), head);
    EXPECT_EQ(store.head().replications, 40u);
    store.add({first_});
  }
  {
    Store store = Store::open(path());
    EXPECT_EQ(store.head().replications, 40u);
    store.ask_for(100);
    EXPECT_EQ(store.head().replications, 100u);
  }
  const Store store = Store::open(path());
  EXPECT_EQ(store.head().replications, 100u);
  EXPECT_EQ(store.count(), 1u);
}

TEST_F(StoreTest, IsNotWrittenOver) {
  { Store store = Store::create(path(), head_); }
  EXPECT_THROW((void)Store::create(path(), head_), std::runtime_error);
}

TEST_F(StoreTest, AFileThatIsNoStoreIsRefused) {
  EXPECT_THROW((void)Store::open(path()), InputError);
  std::ofstream(path()) << "this is no database, however long it may be, and nobody should take it for one";
  EXPECT_THROW((void)Store::open(path()), InputError);
}

TEST_F(StoreTest, WhereNothingCanBeWrittenItSaysSo) {
  EXPECT_THROW((void)Store::create(folder_ + "/nowhere/results.sqlite", head_), std::runtime_error);
}

TEST_F(StoreTest, AFinishedStoreIsOneFile) {
  {
    Store store = Store::create(path(), head_);
    EXPECT_THAT(files(), testing::ElementsAre("results.sqlite"));
    store.add({first_});
    EXPECT_GT(files().size(), 1u) << "beside it is what readers need not wait for";
  }
  EXPECT_THAT(files(), testing::ElementsAre("results.sqlite"));
}

TEST_F(StoreTest, ReadingChangesNothing) {
  {
    Store store = Store::create(path(), head_);
    store.add({first_, second_});
  }
  const std::string before = read_file(path());
  {
    const Store store = Store::open(path());
    EXPECT_EQ(store.of_point(0).size(), 2u);
    EXPECT_THAT(files(), testing::ElementsAre("results.sqlite"));
  }
  EXPECT_EQ(read_file(path()), before);
}

TEST_F(StoreTest, AReaderHoldsNoWriterUp) {
  Store store = Store::create(path(), head_);
  store.wait_by([](int) {
    ADD_FAILURE() << "it waits";
    return false;
  });
  store.add({first_});
  Other reader(path());
  ASSERT_TRUE(reader.begins_reading());
  store.add({second_});
  store.ask_for(7);
  EXPECT_EQ(store.count(), 2u);
}

// A reader at the end of writing leaves all changes there. The next writer makes one file again.
TEST_F(StoreTest, AReaderAtTheEndOfWritingCostsNothing) {
  {
    auto store = std::make_unique<Store>(Store::create(path(), head_));
    store->add({first_});
    Other reader(path());
    ASSERT_TRUE(reader.begins_reading());
    store->add({second_});
    store.reset();
    EXPECT_EQ(Store::open(path()).count(), 2u);
  }
  EXPECT_EQ(Store::open(path()).count(), 2u);
  { Store::open(path()).add({third_}); }
  EXPECT_EQ(Store::open(path()).count(), 3u);
  EXPECT_THAT(files(), testing::ElementsAre("results.sqlite"));
}

TEST_F(StoreTest, ALockIsWaitedFor) {
  Store store = Store::create(path(), head_);
  Other other(path());
  ASSERT_TRUE(other.takes_it_all());
  int calls = 0;
  store.wait_by([&](int) {
    if (++calls == 3) other.end();
    return true;
  });
  store.add({first_});
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(store.count(), 1u);
}

TEST_F(StoreTest, ALockThatStaysIsReportedAndLosesNothing) {
  Store store = Store::create(path(), head_);
  store.add({first_});
  const auto words = [&] {
    try {
      store.add({second_});
    } catch (const Locked& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  store.wait_by([](int calls) { return calls < 2; });
  {
    Other other(path());
    ASSERT_TRUE(other.takes_it_all());
    EXPECT_EQ(words(), path() + ": is locked by another process, and waiting for it did not help");
  }
  EXPECT_EQ(words(), "no error");
  EXPECT_THAT(store.keys(), testing::ElementsAre(first_.key, second_.key));
}

// Ends as if killed.
void write_and_die(const std::string& path, const StoreHead& head, const std::vector<results::Row>& runs) {
  const pid_t child = fork();
  if (child == 0) {
    Store store = Store::create(path, head);
    store.add(runs);
    _exit(0);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
}

TEST_F(StoreTest, AKilledWritersRowsAreThere) {
  write_and_die(path(), head_, {first_, second_});
  EXPECT_GT(files().size(), 1u);
  EXPECT_EQ(Store::open(path()).count(), 2u);
  { Store::open(path()).add({third_}); }
  EXPECT_EQ(Store::open(path()).count(), 3u);
  EXPECT_THAT(files(), testing::ElementsAre("results.sqlite"));
}

TEST_F(StoreTest, FilesOfAKilledWriterBesideADeletedStoreAreNotTakenIn) {
  write_and_die(path(), head_, {first_, second_});
  std::filesystem::remove(path());
  { Store::create(path(), head_).add({third_}); }
  EXPECT_THAT(Store::open(path()).keys(), testing::ElementsAre(third_.key));
}

// A folder that this thread may only read. Root becomes another user for this.
class ReadOnly {
 public:
  explicit ReadOnly(std::string folder) : folder_(std::move(folder)) {
    namespace fs = std::filesystem;
    for (const auto& entry : fs::directory_iterator(folder_))
      fs::permissions(entry, fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
    fs::permissions(folder_, static_cast<fs::perms>(0555));
    if (geteuid() == 0) setfsuid(kNobody);
  }
  ~ReadOnly() {
    if (geteuid() == 0) setfsuid(0);
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
  }
  ReadOnly(const ReadOnly&) = delete;
  ReadOnly& operator=(const ReadOnly&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
  std::string folder_;
};

// The index is lost, and cannot be made there.
TEST_F(StoreTest, AKilledWritersRowsInAFolderThatCannotBeWrittenAreReported) {
  write_and_die(path(), head_, {first_, second_});
  std::filesystem::remove(path() + "-shm");
  const ReadOnly read_only(folder_);
  try {
    Store::open(path());
    ADD_FAILURE() << "is read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("has changes in -wal beside it, to be read in a folder that can be"));
  }
}

TEST_F(StoreTest, IsReadInAFolderThatCannotBeWritten) {
  {
    Store store = Store::create(path(), head_);
    store.add({first_});
  }
  const ReadOnly read_only(folder_);
  Store store = Store::open(path());
  EXPECT_EQ(store.count(), 1u);
  EXPECT_THROW(store.add({second_}), std::runtime_error);
}

// A reader left it for use with a WAL. This folder cannot have one.
TEST_F(StoreTest, IsReadThereEvenIfItsWriterCouldNotFinishIt) {
  const std::string odd = folder_ + "/50%?#.sqlite";
  {
    Store store = Store::create(odd, head_);
    store.add({first_});
    Other reader(odd);
    ASSERT_TRUE(reader.begins_reading());
    { const Store gone = std::move(store); }
  }
  ASSERT_THAT(files(), testing::ElementsAre("50%?#.sqlite"));
  const ReadOnly read_only(folder_);
  EXPECT_EQ(Store::open(odd).count(), 1u);
}

TEST_F(StoreTest, AFullDiskTakesNothingThatWasThere) {
  Store store = Store::create(path(), head_);
  store.add({first_});
  std::vector<results::Row> many;
  for (std::uint32_t r = 0; r < 10'000; ++r) many.push_back({{1, r, 0}, kDone, {1.0, 2.0}});
  {
    const support::FullDisk full(std::filesystem::file_size(path()) + 4096);
    EXPECT_THROW(store.add(many), std::runtime_error);
  }
  EXPECT_THAT(store.keys(), testing::ElementsAre(first_.key));
  store.add({second_});
  EXPECT_EQ(store.count(), 2u);
}

}  // namespace
}  // namespace ttf::experiments::results
