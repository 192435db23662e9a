// Families of conflicting variants, the bound from them, and the parts of the second stage.
#include <gtest/gtest.h>

#include "schedules/packing/variants/check.h"
#include "schedules/packing/variants/columns.h"
#include "schedules/packing/variants/families.h"
#include "schedules/packing/variants/lower_bound.h"
#include "schedules/packing/variants/pieces.h"
#include "schedules/packing/variants/use.h"

namespace ttf::schedules::packing {
namespace {

using namespace variants;

// Whole frames of every cycle, one for each set, sent by the node of that number.
Instance whole_frames_of(const std::vector<std::pair<int, VariantSet>>& signals, int variants) {
  Instance instance{
      {"a", "b", "c"}, {}, 8, 1, false, std::vector<std::string>(static_cast<std::size_t>(variants), "v")};
  for (const auto& [node, set] : signals) instance.signals.push_back({"s", node, 1, {0, 0}, 8, set});
  return instance;
}

int bound_of_all(const Instance& instance) { return least_slots(instance, possible_signals(instance), {}); }

// All maximal families, by trying all subsets of the sets.
std::set<Family> all_maximal_families(const std::vector<VariantSet>& sets) {
  const auto conflict = [&](std::uint32_t chosen) {
    for (std::size_t a = 0; a < sets.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if ((chosen >> a & 1) != 0 && (chosen >> b & 1) != 0 && (sets[a] & sets[b]) == 0) return false;
    return true;
  };
  std::set<Family> maximal;
  for (std::uint32_t chosen = 1; chosen < 1u << sets.size(); ++chosen) {
    if (!conflict(chosen)) continue;
    bool grows = false;
    for (std::size_t a = 0; a < sets.size(); ++a)
      grows = grows || ((chosen >> a & 1) == 0 && conflict(chosen | 1u << a));
    if (grows) continue;
    Family family;
    for (std::size_t a = 0; a < sets.size(); ++a)
      if ((chosen >> a & 1) != 0) family.push_back(sets[a]);
    maximal.insert(family);
  }
  return maximal;
}

TEST(VariantFamilies, AreTheVariantsAndAllMaximalOnesWithoutACommonVariant) {
  std::vector<std::pair<int, VariantSet>> all;
  for (VariantSet set = 1; set < 16; ++set) all.emplace_back(0, set);
  const Instance instance = whole_frames_of(all, 4);
  const Order signals = possible_signals(instance);
  const std::vector<Family> found = families(instance, signals, 1000);
  const std::set<Family> expected = all_maximal_families(sets_of(instance, signals));
  EXPECT_EQ(std::set<Family>(found.begin(), found.end()), expected);
  EXPECT_EQ(found.size(), 12u);  // the maximal intersecting families of the subsets of four: 1, 2, 4, 12, 81, ...
  EXPECT_EQ(families(instance, signals, 3).size(), 4u + 3u);
}

TEST(VariantBound, IsThatOfTheLargestVariant) {
  EXPECT_EQ(bound_of_all(whole_frames_of({{0, 1}, {0, 1}, {1, 1}, {1, 2}, {2, 2}}, 2)), 3);
  EXPECT_EQ(bound_of_all(whole_frames_of({{0, 1}, {1, 2}, {2, 4}}, 3)), 1);
}

TEST(VariantBound, OfSignalsThatConflictInPairsWithoutACommonVariant) {
  const Instance triangle = whole_frames_of({{0, 3}, {1, 6}, {2, 5}}, 3);
  for (int variant : least_slots_by_variant(triangle, possible_signals(triangle))) EXPECT_EQ(variant, 2);
  EXPECT_EQ(bound_of_all(triangle), 3);
}

TEST(VariantBound, CountsTheSlotsThatStand) {
  const Instance instance = whole_frames_of({{0, 1}, {1, 2}}, 2);
  EXPECT_EQ(least_slots(instance, {0, 1}, {BitPlace{0, 0, 0}, BitPlace{1, 0, 0}}), 2);
  EXPECT_EQ(least_slots(instance, {0, 1}, {BitPlace{0, 0, 0}, BitPlace{0, 0, 0}}), 1);
}

TEST(VariantColumns, AreSharedByBinsWithoutACommonVariant) {
  EXPECT_EQ(columns_of({}, {1, 2, 4}).count, 1);
  EXPECT_EQ(columns_of({}, {3, 6, 5}).count, 3);
  EXPECT_EQ(columns_of({7, 1}, {6, 2, 4}).count, 3);
  const Columns columns = columns_of({1, 2}, {1, 2});
  EXPECT_EQ(columns.of_bin, (std::vector{1, 0}));
  EXPECT_EQ(columns.count, 2);
}

TEST(VariantPieces, AreSignalsThatShareVariantsAlsoThroughOthers) {
  Instance instance{{"a"}, {}, 8, 1, false, {"v", "w", "x", "y"}};
  for (const VariantSet set : {1, 6, 4, 8, 2}) instance.signals.push_back({"s", 0, 1, {0, 0}, 1, set});
  const Places places{BitPlace{0, 0, 0}, BitPlace{0, 0, 0}, BitPlace{0, 0, 1}, BitPlace{0, 0, 0}, BitPlace{1, 0, 0}};
  const auto pieces = pieces_of(instance, places, {std::nullopt, std::nullopt, places[2]});
  ASSERT_EQ(pieces.size(), 2u);
  ASSERT_EQ(pieces[0].size(), 3u);  // 1, 6 with 4, 8
  EXPECT_EQ(pieces[0][1].variants, 6u);
  EXPECT_TRUE(pieces[0][1].stands);
  EXPECT_FALSE(pieces[0][2].stands);
  EXPECT_EQ(whole_bins(pieces)[0][0].variants, 15u);
}

TEST(VariantCheck, LooksAtEachVariantsVehicle) {
  const Instance instance = whole_frames_of({{0, 1}, {1, 2}, {1, 3}}, 2);
  const auto at = [](int slot) { return Assigned{{slot, model::Channels::kA}, 0, 0}; };
  EXPECT_TRUE(variant_violations(instance, {at(1), at(1), at(2)}).empty());
  const auto found = variant_violations(instance, {at(1), at(1), at(1)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].signal, 2u);
  EXPECT_EQ(found[0].text, "must not be in slot 1, which belongs to node a of signal s, in variant v");
  EXPECT_EQ(violations(instance, {at(1), at(1), at(2)}).size(), 1u);  // as one vehicle
}

TEST(VariantUse, CountsEachVariantsSignalsAndSlots) {
  const Instance instance = whole_frames_of({{0, 1}, {1, 2}, {1, 3}}, 2);
  const auto of = uses(instance, {BitPlace{0, 0, 0}, BitPlace{0, 0, 0}, std::nullopt});
  ASSERT_EQ(of.size(), 2u);
  EXPECT_EQ(of[0].signals, 1u);
  EXPECT_DOUBLE_EQ(of[1].load, 1.0);
  EXPECT_EQ(of[1].bins, std::set<int>{0});
  EXPECT_EQ(of[1].bound, 1);
}

}  // namespace
}  // namespace ttf::schedules::packing
