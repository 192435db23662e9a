// Packings of drawn signals: always sound, never below the bound, and compared with the exhaustive optimum.
#include "schedules/packing/packer.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "schedules/packing/check.h"
#include "schedules/packing/lower_bound.h"
#include "tests/schedules/packing/exhaustive.h"
#include "tests/schedules/packing/like_instance.h"

namespace ttf::schedules::packing {
namespace {

std::vector<Violation> broken_rules(const Instance& instance, const Solution& solution) {
  return violations(instance, assigned(solution.places, slot_numbers({}, solution.bins, 1, ChannelUse::kOne)));
}

std::size_t placed(const Places& places) {
  return static_cast<std::size_t>(
      std::count_if(places.begin(), places.end(), [](const auto& place) { return place.has_value(); }));
}

// Up to six signals in frames of at most 6 bits, over 1, 2 or 4 cycles.
Instance tiny_instance(std::uint64_t seed, bool shared) {
  RandomStream random({seed, 1, Purpose::kTest});
  Instance instance{{"a", "b"}, {}, static_cast<int>(random.integer(2, 6)), 1 << random.integer(0, 2), shared};
  const std::int64_t signals = random.integer(1, 6);
  const bool windowed = random.uniform() < 0.5;
  for (int i = 0; i < signals; ++i) {
    int repetition = 1 << random.integer(0, 2);
    repetition = std::min(repetition, instance.cycles);
    Signal signal{std::to_string(i), 0, repetition, {0, repetition - 1}, 1};
    signal.node = shared ? static_cast<int>(random.integer(0, 1)) : 0;
    signal.bits = static_cast<int>(random.integer(1, instance.payload_bits));
    if (windowed) {
      signal.window.earliest = static_cast<int>(random.integer(0, repetition - 1));
      signal.window.latest = static_cast<int>(random.integer(signal.window.earliest, repetition - 1));
    }
    instance.signals.push_back(signal);
  }
  return instance;
}

TEST(Packer, SmallSetsAgainstTheExhaustiveOptimum) {
  int bound_reached = 0, sets = 0, above = 0;
  for (const bool shared : {false, true})
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      const Instance instance = tiny_instance(seed, shared);
      const Solution solution = pack(instance);
      const int optimum = fewest_bins(instance);
      ASSERT_TRUE(broken_rules(instance, solution).empty()) << seed;
      ASSERT_LE(solution.bound(), optimum) << seed;
      ASSERT_GE(solution.bins, optimum) << seed;
      bound_reached += solution.bound() == optimum ? 1 : 0;
      above += solution.bins > optimum ? 1 : 0;
      ++sets;
    }
  EXPECT_EQ(above, 0) << "of " << sets;
  EXPECT_GT(bound_reached, 500) << "of " << sets;
}

TEST(Packer, DrawnSetsAreSoundAndNeverBelowTheBound) {
  for (const bool shared : {false, true})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      Instance instance = like_instance(60 * static_cast<int>(seed), seed, seed % 2 == 0 ? 12 : 60);
      instance.shared_slots = shared;
      const Solution solution = pack(instance);
      EXPECT_TRUE(broken_rules(instance, solution).empty()) << seed;
      EXPECT_EQ(placed(solution.places), instance.signals.size());
      EXPECT_GE(solution.bins, solution.bound());
      EXPECT_LE(solution.bins, solution.bound() + (shared ? 2 : 1)) << "seed " << seed << " shared " << shared;
    }
}

TEST(Packer, LongFramesOverSeveralWords) {
  RandomStream random({1, 2, Purpose::kTest});
  Instance instance{{"a"}, {}, 254 * 8, 16, false};
  for (int i = 0; i < 400; ++i) {
    const int repetition = 1 << random.integer(0, 4);
    instance.signals.push_back(
        {std::to_string(i), 0, repetition, {0, repetition - 1}, static_cast<int>(random.integer(1, 300))});
  }
  const Solution solution = pack(instance);
  EXPECT_TRUE(broken_rules(instance, solution).empty());
  EXPECT_GE(solution.bins, solution.bound());
  EXPECT_LE(solution.bins, solution.bound() + 1);
}

TEST(Packer, IsTheSameTwice) {
  const Instance instance = like_instance(500, 3, 60);
  EXPECT_EQ(pack(instance).places, pack(instance).places);
}

TEST(Packer, LeavesOutSignalsWithoutAPlace) {
  Instance instance = like_instance(50, 1, 0);
  instance.signals[7].window = {1, 0};
  instance.signals[9].bits = 33;
  const Solution solution = pack(instance);
  EXPECT_EQ(placed(solution.places), 48u);
  EXPECT_FALSE(solution.places[7] || solution.places[9]);
}

TEST(Packer, TheImprovementRemovesABin) {
  // Among drawn sets, there is one that first fit alone packs into more bins than the improvement does.
  int better = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Instance instance = like_instance(150, seed, 70);
    const int without = pack(instance, {}, {0, 1}).bins, with = pack(instance, {}, {200, 1}).bins;
    EXPECT_LE(with, without);
    better += with < without ? 1 : 0;
  }
  EXPECT_GT(better, 0);
}

TEST(Packer, SharedSlotsNeedNoMore) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Instance instance = like_instance(300, seed);
    const int own = pack(instance).bins;
    instance.shared_slots = true;
    EXPECT_LE(pack(instance).bins, own);
  }
}

TEST(Packer, KeepsPlacesThatStandAndAddsOthers) {
  const Instance grown = like_instance(700, 5);
  Instance first = grown;
  first.signals.resize(500);
  for (const bool shared : {false, true}) {
    Instance before = first, after = grown;
    before.shared_slots = after.shared_slots = shared;
    const Solution stands = pack(before);
    const Solution solution = pack(after, stands.places);
    EXPECT_TRUE(broken_rules(after, solution).empty());
    for (std::size_t i = 0; i < 500; ++i) EXPECT_EQ(solution.places[i], stands.places[i]);
    EXPECT_EQ(placed(solution.places), 700u);
    EXPECT_GE(solution.bins, solution.bound());
    EXPECT_GE(solution.bound(), pack(after).bound());
  }
}

TEST(Packer, WithoutNewSignalsNothingChanges) {
  const Instance instance = like_instance(300, 8);
  const Solution stands = pack(instance), again = pack(instance, stands.places);
  EXPECT_EQ(again.places, stands.places);
  EXPECT_EQ(again.bins, stands.bins);
  EXPECT_TRUE(again.proven());  // no packing moves fewer of the bins that stand
}

}  // namespace
}  // namespace ttf::schedules::packing
