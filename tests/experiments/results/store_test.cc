#include "experiments/results/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "core/errors.h"

namespace ttf::experiments::results {
namespace {

class StoreTest : public testing::Test {
 protected:
  StoreTest() : folder_((std::filesystem::temp_directory_path() / "ttfusion_store_XXXXXX").string()) {
    if (mkdtemp(folder_.data()) == nullptr) throw std::runtime_error("no folder");
  }
  ~StoreTest() override { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ + "/results.sqlite"; }

  std::string folder_;
  const StoreHead head_{"noise", "0123", "1.0", "kind: sweep\n", {"rmse", "a \"quoted\" one, with; all"}};
  const results::Row first_{{0, 0, 1}, kDone, {1.5, -2.0}}, second_{{0, 1, 0}, kDone, {0.1, std::nan("")}},
      third_{{2, 0, 0}, "it's broken: \"so\"", {std::nan(""), std::nan("")}};
};

void expect_same(const results::Row& row, const Row& other) {
  EXPECT_EQ(row.key, other.key);
  EXPECT_EQ(row.status, other.status);
  ASSERT_EQ(row.values.size(), other.values.size());
  for (std::size_t v = 0; v < row.values.size(); ++v)
    EXPECT_TRUE(row.values[v] == other.values[v] || (std::isnan(row.values[v]) && std::isnan(other.values[v])));
}

TEST_F(StoreTest, WhatWasAddedComesBackInOrder) {
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
  std::vector<results::Row> rows;
  store.for_each([&](const results::Row& row) { rows.push_back(row); });
  ASSERT_EQ(rows.size(), 3u);
  expect_same(rows[0], first_);
  expect_same(rows[1], second_);
  expect_same(rows[2], third_);
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

TEST_F(StoreTest, WhatIsNoneIsRefused) {
  EXPECT_THROW((void)Store::open(path()), InputError);
  std::ofstream(path()) << "this is no database, however long it may be, and nobody should take it for one";
  EXPECT_THROW((void)Store::open(path()), InputError);
}

TEST_F(StoreTest, WhereNothingCanBeWrittenItSaysSo) {
  EXPECT_THROW((void)Store::create(folder_ + "/nowhere/results.sqlite", head_), std::runtime_error);
}

// A limit to the size of files stands in for a full disk: earlier contents stay.
TEST_F(StoreTest, AFullDiskTakesNothingThatWasThere) {
  Store store = Store::create(path(), head_);
  store.add({first_});
  std::vector<results::Row> many;
  for (std::uint32_t r = 0; r < 10'000; ++r) many.push_back({{1, r, 0}, kDone, {1.0, 2.0}});
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit full{std::filesystem::file_size(path()) + 4096, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  EXPECT_THROW(store.add(many), std::runtime_error);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(store.keys(), testing::ElementsAre(first_.key));
  store.add({second_});
  EXPECT_EQ(store.count(), 2u);
}

}  // namespace
}  // namespace ttf::experiments::results
