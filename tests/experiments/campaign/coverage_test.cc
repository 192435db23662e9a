// A campaign of all classes. With guardians and two channels, no single fault of the hypothesis harms a
// fault-free node.
#include "experiments/campaign/coverage.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/experiments/campaign/small_campaign.h"

namespace ttf::experiments::campaign {
namespace {

const ClassCoverage& row(const Coverage& coverage, faults::FaultKind kind) {
  for (const ClassCoverage& one : coverage.classes)
    if (one.kind == kind && one.in_hypothesis) return one;
  static const ClassCoverage none;
  ADD_FAILURE() << faults::name_of(kind) << " is not in the table";
  return none;
}

TEST(FaultNames, AreThoseWhoseBitsAreSetJoinedByPlus) {
  const std::vector<std::string_view> all{"left_active", "not_started", "precision"};
  EXPECT_EQ(names_of(0, all), "");
  EXPECT_EQ(names_of(1u << 1, all), "not_started");
  EXPECT_EQ(names_of(1u | 1u << 2, all), "left_active+precision");
}

TEST(Coverage, OfTwoThousandSingleFaults) {
  const CampaignFile campaign = small_campaign(2000);
  const auto bus = bus_of(campaign);
  const std::vector<FaultResult> results = run_campaign(campaign, *bus, {}, 2, nullptr);
  const Coverage guarded = coverage_of(campaign, *bus, results, kGuardian);
  const Coverage unguarded = coverage_of(campaign, *bus, results, kBus);
  EXPECT_EQ(guarded.harmed_in_hypothesis, 0u) << coverage_text(guarded, bus->words());
  std::istringstream lines(coverage_text(guarded, bus->words()));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_GT(unguarded.harmed_in_hypothesis, 100u) << "or what would the guardian be for";
  std::uint64_t injected = 0;
  for (const ClassCoverage& one : guarded.classes) {
    injected += one.injected;
    EXPECT_GT(one.activated, 0u) << faults::name_of(one.kind);
    EXPECT_GT(one.detected, 0u) << faults::name_of(one.kind);
    EXPECT_EQ(one.without, 0u) << "every start-up succeeds without the fault";
  }
  EXPECT_EQ(injected, 2000u);

  // The required observable of every class, on the bus, where all effects reach the others.
  using faults::FaultKind;
  for (const auto& [kind, check] : {std::pair{FaultKind::kCrash, evaluation::faults::Check::kNoFrame},
                                    std::pair{FaultKind::kOmission, evaluation::faults::Check::kNoFrame},
                                    std::pair{FaultKind::kBabblingIdiot, evaluation::faults::Check::kBoundary},
                                    std::pair{FaultKind::kMasquerading, evaluation::faults::Check::kContent},
                                    std::pair{FaultKind::kSosValue, evaluation::faults::Check::kSyntax},
                                    std::pair{FaultKind::kBitFlipHeader, evaluation::faults::Check::kSyntax},
                                    std::pair{FaultKind::kBitFlipPayload, evaluation::faults::Check::kSyntax},
                                    std::pair{FaultKind::kBitFlipTrailer, evaluation::faults::Check::kSyntax},
                                    std::pair{FaultKind::kChannelSwap, evaluation::faults::Check::kSyntax},
                                    std::pair{FaultKind::kDrift, evaluation::faults::Check::kBoundary},
                                    std::pair{FaultKind::kWrongSchedule, evaluation::faults::Check::kContent},
                                    std::pair{FaultKind::kNoise, evaluation::faults::Check::kSyntax},
                                    std::pair{FaultKind::kTransient, evaluation::faults::Check::kSyntax}})
    EXPECT_GT(row(unguarded, kind).by_check[static_cast<std::size_t>(check)], 0u) << faults::name_of(kind);
  EXPECT_EQ(row(guarded, FaultKind::kBabblingIdiot).detected, row(guarded, FaultKind::kBabblingIdiot).activated);
}

}  // namespace
}  // namespace ttf::experiments::campaign
