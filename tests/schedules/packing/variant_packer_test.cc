// Schedules of drawn variants: sound in each variant, never below the bound, and compared with the exhaustive optimum.
#include "schedules/packing/variants/packer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/random.h"
#include "schedules/packing/room.h"
#include "schedules/packing/variants/check.h"
#include "schedules/packing/variants/lower_bound.h"
#include "schedules/packing/variants/projection.h"
#include "tests/schedules/packing/exhaustive.h"
#include "tests/schedules/packing/like_variants.h"

namespace ttf::schedules::packing {
namespace {

using namespace variants;

std::vector<Violation> broken_by_variant(const Instance& instance, const Solution& solution) {
  return variant_violations(instance, assigned(solution.places, slot_numbers({}, solution.bins, 1, ChannelUse::kOne)));
}

// Up to five signals of two nodes and three variants. Frames have at most 4 bits. They repeat in 1, 2 or 4 cycles.
Instance tiny_variants(std::uint64_t seed, bool shared) {
  RandomStream random({seed, 2, Purpose::kTest});
  Instance instance{{"a", "b"},     {}, static_cast<int>(random.integer(1, 4)), 1 << random.integer(0, 2), shared,
                    {"x", "y", "z"}};
  const std::int64_t signals = random.integer(1, 6);
  for (int i = 0; i < signals; ++i) {
    const int repetition = std::min(1 << random.integer(0, 2), instance.cycles);
    Signal signal{std::to_string(i), static_cast<int>(random.integer(0, 1)), repetition, {0, repetition - 1}, 1};
    signal.bits = static_cast<int>(random.integer(1, instance.payload_bits));
    signal.variants = static_cast<VariantSet>(random.integer(1, 7));
    if (random.uniform() < 0.3) signal.window.latest = static_cast<int>(random.integer(0, repetition - 1));
    instance.signals.push_back(signal);
  }
  return instance;
}

TEST(VariantPacker, SmallSetsAgainstTheExhaustiveOptimum) {
  int bound_reached = 0, sets = 0, above = 0, shared_places = 0;
  for (const bool shared : {false, true})
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      const Instance instance = tiny_variants(seed, shared);
      const Solution solution = pack_variants(instance);
      const int optimum = fewest_bins(instance);
      ASSERT_TRUE(broken_by_variant(instance, solution).empty()) << seed;
      ASSERT_LE(solution.bound(), optimum) << seed;
      ASSERT_GE(solution.bins, optimum) << seed;
      bound_reached += solution.bound() == optimum ? 1 : 0;
      above += solution.bins > optimum ? 1 : 0;
      shared_places += fewest_bins(one_vehicle(instance)) > optimum ? 1 : 0;
      ++sets;
    }
  EXPECT_EQ(above, 0) << "of " << sets;
  EXPECT_GT(bound_reached, 1880) << "of " << sets;
  EXPECT_GT(shared_places, 400) << "of " << sets;
}

std::vector<Violation> broken_as_one_vehicle(const Instance& instance, const Solution& solution) {
  return violations(one_vehicle(instance),
                    assigned(solution.places, slot_numbers({}, solution.bins, 1, ChannelUse::kOne)));
}

TEST(VariantPacker, DrawnSetsAreSoundAndNeverBelowTheBoundOrAboveOneVehicle) {
  for (const bool shared : {false, true})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      Instance instance =
          like_variants(like_instance(50 * static_cast<int>(seed), seed), 1 + static_cast<int>(seed), seed);
      instance.shared_slots = shared;
      const Solution solution = pack_variants(instance);
      EXPECT_TRUE(broken_by_variant(instance, solution).empty()) << seed;
      EXPECT_TRUE(
          std::all_of(solution.places.begin(), solution.places.end(), [](const auto& place) { return !!place; }));
      EXPECT_GE(solution.bins, solution.bound());
      EXPECT_LE(solution.bins, solution.bound() + solution.bound() / 4 + 1) << "seed " << seed << " shared " << shared;
      EXPECT_LE(solution.bins, pack(one_vehicle(instance)).bins);
    }
}

TEST(VariantPacker, VariantsThatNeverCoincideOverlap) {
  const Instance instance = like_variants(like_instance(300, 4), 3, 4, 20);
  const Solution solution = pack_variants(instance);
  EXPECT_FALSE(broken_as_one_vehicle(instance, solution).empty());
  EXPECT_LT(solution.bins, pack(one_vehicle(instance)).bins);
}

TEST(VariantPacker, OneVariantIsOneVehicle) {
  const Instance plain = like_instance(400, 6);
  const Instance named = like_variants(plain, 1, 6, 100);
  EXPECT_EQ(pack_variants(named).bins, pack(plain).bins);
  EXPECT_EQ(pack_variants(named).bound(), pack(plain).bound());
}

TEST(VariantPacker, DisjointVariantsNeedAsManySlotsAsTheLargest) {
  Instance instance = like_instance(400, 6);
  int largest = 0;
  instance.variants = {"x", "y"};
  for (std::size_t i = 0; i < 400; ++i) instance.signals[i].variants = i % 3 == 0 ? 1 : 2;
  for (int variant = 0; variant < 2; ++variant)
    largest = std::max(largest, pack(projection(instance, variant).instance).bins);
  EXPECT_EQ(pack_variants(instance).bins, largest);
  EXPECT_TRUE(pack_variants(instance).proven());
}

TEST(VariantPacker, AddingAVariantMovesNothing) {
  for (const bool shared : {false, true}) {
    Instance grown = like_variants(like_instance(600, 5), 4, 5);
    grown.shared_slots = shared;
    Instance before = grown;
    before.variants.pop_back();
    // The first signals are those with another variant than the last one.
    const auto is_old = [](const Signal& signal) { return (signal.variants & 7) != 0; };
    std::stable_partition(grown.signals.begin(), grown.signals.end(), is_old);
    before.signals = grown.signals;
    std::erase_if(before.signals, [&](const Signal& signal) { return !is_old(signal); });
    ASSERT_LT(before.signals.size(), grown.signals.size());
    const Solution stands = pack_variants(before);
    // A signal that comes into a variant that another one at its place has, too, does not stand: it is packed anew.
    Places fixed = stands.places;
    const auto numbers = slot_numbers({}, stands.bins, 1, ChannelUse::kOne);
    Assignment assignment = assigned(fixed, numbers);
    assignment.resize(grown.signals.size());
    int moved = 0;
    for (const Violation& violation : variant_violations(grown, assignment)) {
      fixed[violation.signal] = std::nullopt;
      ++moved;
    }
    fixed.resize(grown.signals.size());
    const Solution solution = pack_variants(grown, fixed);
    EXPECT_TRUE(broken_by_variant(grown, solution).empty());
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (fixed[i]) {
        EXPECT_EQ(solution.places[i], fixed[i]);
      }
    EXPECT_GE(solution.bins, solution.bound());
    EXPECT_LT(moved, static_cast<int>(before.signals.size()));
  }
}

// The signals of a new variant never hinder those that stand.
TEST(VariantPacker, ANewVariantsOwnSignalsNeedNoMoreThanItsVehicle) {
  Instance grown = like_variants(like_instance(400, 9), 2, 9);
  const std::size_t old = grown.signals.size();
  const Solution stands = pack_variants(grown);
  grown.variants.push_back("new");
  for (Signal signal : like_instance(150, 10).signals) {
    signal.name += " of the new one";
    signal.variants = 4;
    grown.signals.push_back(signal);
  }
  const Solution solution = pack_variants(grown, stands.places);
  EXPECT_TRUE(broken_by_variant(grown, solution).empty());
  for (std::size_t i = 0; i < old; ++i) EXPECT_EQ(solution.places[i], stands.places[i]);
  const int alone = pack(projection(grown, 2).instance).bins;
  EXPECT_EQ(solution.bins, std::max(stands.bins, alone));
}

// As RoomLeft.IsFilledExactly, for further signals in all variants.
TEST(VariantPacker, TheRoomIsFilledExactly) {
  const Instance instance = like_variants(like_instance(250, 2), 3, 2);
  const Solution solution = pack_variants(instance);
  std::set<std::pair<int, int>> of_node;  // node and bin
  for (std::size_t i = 0; i < instance.signals.size(); ++i)
    of_node.emplace(instance.signals[i].node, solution.places[i]->bin);
  int most = 0;
  for (const Room& room : room_left(instance, solution.places, 3))
    for (std::size_t k = 0; k < room.signals.size(); ++k) {
      Packed packed = with_fixed(instance, solution.places);
      const Signal more{"more", room.node, 1 << k, {0, (1 << k) - 1}, 3};
      int added = 0;
      for (std::size_t b = 0; b < packed.bins.size(); ++b) {
        if (!of_node.contains({room.node, static_cast<int>(b)})) continue;
        while (const auto place = packed.bins[b].first_place(more, Fit::kLowestBit)) {
          packed.bins[b].occupy(more, *place);
          ++added;
        }
      }
      EXPECT_EQ(room.signals[k], added) << "node " << room.node << " repetition " << (1 << k);
      most = std::max(most, added);
    }
  EXPECT_GT(most, 0);
}

TEST(VariantPacker, IsTheSameTwice) {
  const Instance instance = like_variants(like_instance(500, 3, 60), 5, 3);
  EXPECT_EQ(pack_variants(instance).places, pack_variants(instance).places);
}

TEST(VariantPacker, LeavesOutSignalsWithoutAPlace) {
  Instance instance = like_variants(like_instance(50, 1, 0), 2, 1);
  instance.signals[7].window = {1, 0};
  instance.signals[9].bits = 33;
  const Solution solution = pack_variants(instance);
  EXPECT_FALSE(solution.places[7] || solution.places[9]);
  EXPECT_TRUE(solution.places[8]);
}

}  // namespace
}  // namespace ttf::schedules::packing
