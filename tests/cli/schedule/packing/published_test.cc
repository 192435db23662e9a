// The published instance of docs/schedules/packing.md and its schedule, which ran on hardware. The repository does not contain
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <set>

#include "cli/schedule/packing/signal_file.h"
#include "core/file_bytes.h"
#include "schedules/packing/first_fit.h"
#include "schedules/packing/lower_bound.h"
#include "schedules/packing/orders.h"
#include "schedules/packing/packer.h"
#include "schedules/packing/variants/check.h"
#include "schedules/packing/variants/packer.h"
#include "tests/schedules/packing/like_variants.h"
#include "tests/support/recordings.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using ::testing::ElementsAre;

constexpr const char* kPublished = "flexray_signals/signals_4096.csv";

class PublishedSignals : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(support::recording_path(kPublished)))
      GTEST_SKIP() << support::recording_missing(kPublished);
    file_ = read_signals(support::recording_path(kPublished), {});
  }

  // The bins of first fit by lowest cycle, node by node.
  std::size_t first_fit_bins(const table::Instance& instance, std::string_view rule) const {
    std::size_t bins = 0;
    for (const table::OrderRule& one : table::order_rules()) {
      if (one.name != rule) continue;
      for (int node = 0; node < 6; ++node) {
        table::Packed packed{{}, table::Places(instance.signals.size())};
        const table::Order own = of_node(instance, possible_signals(instance), node);
        first_fit(instance, ordered(instance, own, one), table::Fit::kLowestCycle, packed);
        bins += packed.bins.size();
      }
    }
    return bins;
  }

  SignalFile file_;
};

TEST_F(PublishedSignals, TwoCannotKeepTheirOwnWindows) {
  ASSERT_EQ(file_.impossible.size(), 2u);
  EXPECT_EQ(file_.impossible[0].value, "1039");
  EXPECT_EQ(file_.impossible[0].line, 1041);
  EXPECT_EQ(file_.impossible[1].value, "3701");
}

// The two impossible signals are included.
TEST_F(PublishedSignals, HaveTheirKnownCountsAndLoads) {
  const table::Instance& instance = file_.instance;
  std::vector<int> of_node(6), of_period(7), of_length(8);
  std::vector<double> loads(6);
  for (const table::Signal& signal : instance.signals) {
    ++of_node[static_cast<std::size_t>(signal.node)];
    ++of_period[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(signal.repetition)))];
    ++of_length[static_cast<std::size_t>(signal.bits - 1)];
    loads[static_cast<std::size_t>(signal.node)] += signal.bits / 32.0 / signal.repetition;
  }
  EXPECT_EQ(instance.signals.size(), 4096u);
  EXPECT_THAT(of_node, ElementsAre(855, 956, 851, 464, 501, 469));
  EXPECT_THAT(of_period, ElementsAre(583, 491, 297, 1619, 606, 250, 250));
  EXPECT_THAT(of_length, ElementsAre(1409, 807, 501, 77, 78, 425, 160, 639));
  const std::vector<double> known{25.378, 29.441, 26.923, 14.253, 15.979, 12.489};
  for (std::size_t node = 0; node < known.size(); ++node) EXPECT_NEAR(loads[node], known[node], 5e-4) << node;
}

TEST_F(PublishedSignals, NeedTheirBoundOf127Slots) {
  const table::Solution solution = pack(file_.instance);
  EXPECT_EQ(solution.bins, 127);
  EXPECT_TRUE(solution.proven());
  std::vector<int> bins;
  for (const table::Part& part : solution.parts) bins.push_back(part.bins);
  EXPECT_THAT(bins, ElementsAre(26, 30, 27, 15, 16, 13));
  EXPECT_TRUE(
      violations(file_.instance, assigned(solution.places, slot_numbers({}, solution.bins, 1, table::ChannelUse::kOne)))
          .empty());
}

TEST_F(PublishedSignals, Need125SlotsIfNodesShareThem) {
  file_.instance.shared_slots = true;
  const table::Solution solution = pack(file_.instance);
  EXPECT_EQ(solution.bins, 125);
  EXPECT_TRUE(solution.proven());
}

TEST_F(PublishedSignals, FirstFitsOrdersHaveTheirKnownFigures) {
  EXPECT_EQ(first_fit_bins(file_.instance, "windows, period, length"), 127u);
  EXPECT_EQ(first_fit_bins(file_.instance, "period, length"), 128u);
  EXPECT_EQ(first_fit_bins(file_.instance, "length, period"), 130u);
  EXPECT_EQ(first_fit_bins(file_.instance, "bandwidth"), 129u);
  EXPECT_EQ(first_fit_bins(file_.instance, "as given"), 130u);
  // Without windows, and with the two impossible signals anywhere.
  table::Instance all = file_.instance;
  for (table::Signal& signal : all.signals)
    if (signal.window.empty()) signal.window = {0, signal.repetition - 1};
  EXPECT_EQ(first_fit_bins(all, "period, length"), 129u);
  for (table::Signal& signal : all.signals) signal.window = {0, signal.repetition - 1};
  EXPECT_EQ(first_fit_bins(all, "period, length"), 127u);
}

TEST_F(PublishedSignals, ThePublishedScheduleIsSoundAndHas127Slots) {
  const std::string path = support::recording_path(kPublished);
  const StandingPlaces standing = read_standing({path}, file_, table::ChannelUse::kOne);
  EXPECT_EQ(standing.numbers.size(), 127u);
  EXPECT_EQ(standing.notes.size(), 2u);  // the two have places there, outside their windows
  const table::Solution solution = pack(file_.instance, standing.places);
  EXPECT_EQ(solution.bins, 127);
  EXPECT_TRUE(solution.proven());
}

TEST_F(PublishedSignals, HalfOfThemCanStandWhileTheOthersAreAdded) {
  SignalFile half = file_;
  half.instance.signals.resize(2048);
  const table::Solution stands = pack(half.instance);
  const table::Solution grown = pack(file_.instance, stands.places);
  for (std::size_t i = 0; i < 2048; ++i) EXPECT_EQ(grown.places[i], stands.places[i]);
  EXPECT_GE(grown.bins, 127);
  EXPECT_LE(grown.bins, 129);
}

// Half of the signals are in drawn sets of four variants.
TEST_F(PublishedSignals, OfFourVariantsNeedFewerSlots) {
  const table::Instance instance = table::like_variants(file_.instance, 4, 1);
  const table::Solution solution = table::variants::pack_variants(instance, {}, {0, 1});
  EXPECT_TRUE(table::variants::variant_violations(
                  instance, assigned(solution.places, slot_numbers({}, solution.bins, 1, table::ChannelUse::kOne)))
                  .empty());
  EXPECT_EQ(solution.bound(), 100);
  EXPECT_GE(solution.bins, 100);
  EXPECT_LE(solution.bins, 103);
}

}  // namespace
}  // namespace ttf::cli::schedule::packing
