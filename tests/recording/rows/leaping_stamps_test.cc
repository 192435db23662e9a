// A single stamp that leaps is found; any other order of rows is not taken for damage.
#include "recording/rows/leaping_stamps.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random.h"

namespace ttf::recording::rows {
namespace {

using testing::ElementsAre;

constexpr std::int64_t kSecond = 1000;  // stamps in milliseconds

std::vector<std::size_t> leaps(const std::vector<std::int64_t>& times) {
  std::vector<RowStamps> stamps;
  for (const std::int64_t time : times) stamps.push_back({time, time});
  std::vector<std::size_t> rows;
  for (const Leap& leap : leaping_stamps(stamps, kSecond)) rows.push_back(leap.row);
  return rows;
}

std::vector<std::int64_t> ten_hertz(int count) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < count; ++i) times.push_back(100 * i);
  return times;
}

TEST(LeapingStamps, OneAheadOrBackIsFoundWhereverItStands) {
  EXPECT_THAT(leaps(ten_hertz(50)), ElementsAre());
  for (const std::size_t at : {0u, 1u, 24u, 48u}) {
    std::vector<std::int64_t> times = ten_hertz(50);
    times[at] += 3'600'000;
    EXPECT_THAT(leaps(times), ElementsAre(at)) << "ahead";
  }
  for (const std::size_t at : {1u, 24u, 48u, 49u}) {
    std::vector<std::int64_t> times = ten_hertz(50);
    times[at] -= 3'600'000;
    EXPECT_THAT(leaps(times), ElementsAre(at)) << "back";
  }
}

TEST(LeapingStamps, RowsOfOneListLeapTogether) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 60; ++i) times.push_back(100 * (i / 3));
  for (const std::size_t at : {30u, 31u, 32u}) times[at] = 77'000;
  EXPECT_THAT(leaps(times), ElementsAre(30, 31, 32));
}

// 1.9 s, 77 s, 2.1 s, 78 s, 2.3 s: what is between two leaps is sound.
TEST(LeapingStamps, ASoundRowBetweenTwoLeapsStays) {
  std::vector<std::int64_t> times = ten_hertz(50);
  times[20] = 77'000;
  times[22] = 77'100;
  EXPECT_THAT(leaps(times), ElementsAre(20, 22));
}

TEST(LeapingStamps, OtherOrdersAreNoDamage) {
  std::vector<std::int64_t> backwards = ten_hertz(200);
  std::reverse(backwards.begin(), backwards.end());
  EXPECT_THAT(leaps(backwards), ElementsAre());

  std::vector<std::int64_t> by_object;  // one object after the other, one of them with a single row
  for (int object = 0; object < 5; ++object)
    for (int i = 0; i < (object == 4 ? 1 : 100); ++i) by_object.push_back(100 * i + 3'000 * object);
  EXPECT_THAT(leaps(by_object), ElementsAre());

  std::vector<std::int64_t> with_pause = ten_hertz(50);
  for (std::size_t i = 25; i < 50; ++i) with_pause[i] += 3'600'000;
  EXPECT_THAT(leaps(with_pause), ElementsAre());

  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 11});
    std::vector<std::int64_t> shuffled = ten_hertz(300);
    for (std::size_t i = shuffled.size() - 1; i > 0; --i)
      std::swap(shuffled[i], shuffled[static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(i)))]);
    EXPECT_THAT(leaps(shuffled), ElementsAre()) << seed;
  }
}

TEST(LeapingStamps, FewStampsAndExtremeOnesAreNoTrouble) {
  EXPECT_THAT(leaps({}), ElementsAre());
  EXPECT_THAT(leaps({5}), ElementsAre());
  EXPECT_THAT(leaps({0, 100, 9'000'000, 200, 300}), ElementsAre());
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  EXPECT_THAT(leaps({0, kMost, 0, kMost, 0, kMost, 0, kMost, 0}), ElementsAre());
  std::vector<std::int64_t> times = ten_hertz(50);
  times[7] = kMost;
  EXPECT_THAT(leaps(times), ElementsAre(7));
}

// The law that makes the rows that remain a sound file.
TEST(LeapingStamps, TheRestHasNoLeap) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 12});
    std::vector<std::int64_t> times = ten_hertz(60);
    for (int i = 0; i < 20; ++i)
      times[static_cast<std::size_t>(stream.integer(0, 59))] += stream.integer(-30'000, 30'000);
    std::vector<std::int64_t> rest;
    const std::vector<std::size_t> found = leaps(times);
    for (std::size_t i = 0; i < times.size(); ++i)
      if (!std::binary_search(found.begin(), found.end(), i)) rest.push_back(times[i]);
    EXPECT_THAT(leaps(rest), ElementsAre()) << seed;
  }
}

}  // namespace
}  // namespace ttf::recording::rows
