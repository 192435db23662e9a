#include <gtest/gtest.h>

#include "schedules/analysis/parameter_bounds.h"
#include "schedules/check/checker.h"
#include "schedules/model/wire_times.h"

namespace ttf::schedules::check {
namespace {

std::vector<Finding> findings_of_cycle(const model::GlobalParameters& flexray) {
  model::Cluster cluster;
  cluster.flexray = flexray;
  ClusterFindings findings(cluster);
  check_cycle(cluster, findings);
  return findings.take();
}

const Finding* about(const std::vector<Finding>& findings, const std::string& key) {
  for (const Finding& finding : findings)
    if (finding.key == "flexray." + key) return &finding;
  return nullptr;
}

// The FIBEX demo file's numbers: 60 x 43 + 210 x 5 + 6 = 3636.
model::GlobalParameters fibex_example() {
  model::GlobalParameters g;
  g.gMacroPerCycle = 3636;
  g.gdMacrotick_ps = 1'375'000;
  g.gdCycle_ps = 3636 * g.gdMacrotick_ps;
  g.gNumberOfStaticSlots = 60;
  g.gdStaticSlot = 43;
  g.gPayloadLengthStatic = 21;
  g.gdActionPointOffset = 2;
  g.gNumberOfMinislots = 210;
  g.gdMinislot = 5;
  g.gdMinislotActionPointOffset = 2;
  g.gdSymbolWindow = 0;
  g.gdNIT = 6;
  g.gOffsetCorrectionStart = 3632;
  g.gdTSSTransmitter = 9;
  return g;
}

TEST(CycleRules, FibexExampleAddsUpToConstraint18) {
  const auto findings = findings_of_cycle(fibex_example());
  EXPECT_EQ(about(findings, "gMacroPerCycle"), nullptr);
  EXPECT_EQ(about(findings, "gOffsetCorrectionStart"), nullptr);
  EXPECT_EQ(about(findings, "gdCycle"), nullptr);
}

TEST(CycleRules, FibexExampleNeeds44MacroticksPerSlotWithLongCables) {
  model::GlobalParameters g = fibex_example();
  g.gdMaxPropagationDelay_ps = 2'500'000;
  EXPECT_EQ(analysis::shortest_static_slot(g), 44);
  const auto findings = findings_of_cycle(g);
  ASSERT_NE(about(findings, "gdStaticSlot"), nullptr);
  EXPECT_NE(about(findings, "gdStaticSlot")->expected.find("at least 44"), std::string::npos);
}

TEST(CycleRules, FibexExampleHoldsUpToOneMicrosecondOfCable) {
  model::GlobalParameters g = fibex_example();
  g.gdMaxPropagationDelay_ps = 1'000'000;
  EXPECT_EQ(analysis::shortest_static_slot(g), 43);
  EXPECT_EQ(about(findings_of_cycle(g), "gdStaticSlot"), nullptr);
}

TEST(CycleRules, SecondExampleNeedsAtLeast33MacroticksPerSlot) {
  model::GlobalParameters g = fibex_example();
  g.gNumberOfStaticSlots = 70;
  g.gdStaticSlot = 31;
  g.gPayloadLengthStatic = 16;
  g.gdActionPointOffset = 1;
  g.gdMinislotActionPointOffset = 1;
  g.gNumberOfMinislots = 291;
  g.gdSymbolWindow = 1;
  g.gdNIT = 3636 - 70 * 31 - 291 * 5 - 1;
  g.gOffsetCorrectionStart = 3632;
  g.gdMaxPropagationDelay_ps = 0;  // even without any cable
  EXPECT_EQ(analysis::shortest_static_slot(g), 33);
  const auto findings = findings_of_cycle(g);
  ASSERT_NE(about(findings, "gdStaticSlot"), nullptr);
  EXPECT_NE(about(findings, "gdStaticSlot")->expected.find("at least 33"), std::string::npos);
  EXPECT_EQ(about(findings, "gMacroPerCycle"), nullptr);
}

TEST(CycleRules, ACycleIsWholeNanoseconds) {
  model::GlobalParameters g = fibex_example();
  EXPECT_EQ(about(findings_of_cycle(g), "gdCycle"), nullptr);  // 3636 * 1.375 us = 4999.5 us
  g.gdMacrotick_ps = 1'375'001;
  g.gdCycle_ps = 3636 * g.gdMacrotick_ps;
  const auto findings = findings_of_cycle(g);
  ASSERT_NE(about(findings, "gdCycle"), nullptr);
  EXPECT_EQ(about(findings, "gdCycle")->value, "4999.503636 us");
  EXPECT_EQ(about(findings, "gdCycle")->expected, "must be a whole number of nanoseconds");
}

// 5 ms layout of the facts: (34 + 20 * 2) * 25 ns + 2 * 2.5 us = 6.85 us, action point 7, slot 84.
TEST(CycleRules, PaperLayoutIsTheTightestThatHolds) {
  model::GlobalParameters g;
  EXPECT_EQ(assumed_precision_ps(g), 6'850'000);
  EXPECT_EQ(analysis::shortest_static_slot(g), 84);
}

// The assumed distance of clocks is never less than the parameters' value, with any fraction of a nanosecond.
TEST(CycleRules, TheAssumedPrecisionIsWholeNanosecondsRoundedUp) {
  model::GlobalParameters g;
  EXPECT_EQ(assumed_precision(g), Duration::nanoseconds(6'850));
  g.gdMaxPropagationDelay_ps += 1;
  EXPECT_EQ(assumed_precision(g), Duration::nanoseconds(6'851));
  g.gdMaxPropagationDelay_ps += 499;
  EXPECT_EQ(assumed_precision(g), Duration::nanoseconds(6'851));
}

TEST(Instants, ActionPointDifferenceCountsOnlyWithADynamicSegment) {
  model::GlobalParameters g = fibex_example();
  g.gdMinislotActionPointOffset = 1;  // one below the action point: one macrotick more
  EXPECT_NE(about(findings_of_cycle(g), "gMacroPerCycle"), nullptr);
  g.gNumberOfMinislots = 0;
  g.gMacroPerCycle -= 210 * 5;
  EXPECT_EQ(about(findings_of_cycle(g), "gMacroPerCycle"), nullptr);
}

TEST(Instants, NextOccurrenceIsTheFirstAtOrAfter) {
  model::GlobalParameters g;
  g.gMacroPerCycle = 3636;
  g.gdMacrotick_ps = 1'375'000;  // 1.375 us: instants between nanoseconds
  for (const int repetition : {1, 2, 8, 64})
    for (const int base : {0, repetition - 1})
      for (const std::int64_t offset : {0, 1, 777, 3635}) {
        const model::CycleInstant at{base, repetition, Macroticks{offset}};
        // By going through all of them, against the jump.
        std::int64_t cycle = base;
        for (std::int64_t from = -3'000'000; from < 700'000'000; from += 1'234'567) {
          while (time_of(g, cycle, at.offset).ns < from) cycle += repetition;
          const model::Occurrence found = next_occurrence(g, at, GlobalTime{from});
          ASSERT_EQ(found.cycle, cycle);
          ASSERT_EQ(found.time, time_of(g, cycle, at.offset));
        }
        const GlobalTime exact = time_of(g, base + 3 * repetition, at.offset);
        EXPECT_EQ(next_occurrence(g, at, exact).time, exact);
        EXPECT_EQ(next_occurrence(g, at, exact + Duration{1}).cycle, base + 4 * repetition);
      }
}

TEST(Instants, TimeIsRoundedUpToANanosecondThatHasReachedIt) {
  model::GlobalParameters g;
  g.gMacroPerCycle = 10;
  g.gdMacrotick_ps = 1'000'300;
  EXPECT_EQ(time_of(g, 0, Macroticks{1}).ns, 1001);
  EXPECT_EQ(time_of(g, 1, Macroticks{0}).ns, 10'003);
  // 10^9 cycles on, no error has accumulated.
  EXPECT_EQ(time_of(g, 1'000'000'000, Macroticks{0}).ns, 10'003'000'000'000);
}

// Every repetition that FlexRay has or had, of instants and of frames, in counters and in counted cycles.
TEST(InCycle, IsTheRemainderOfTheRepetition) {
  for (const int repetition : {1, 2, 4, 5, 8, 10, 16, 20, 32, 40, 50, 64})
    for (int base = 0; base < repetition; ++base) {
      const model::CycleInstant instant{base, repetition, {}};
      model::FrameSlot frame;
      frame.base_cycle = base;
      frame.repetition = repetition;
      for (std::int64_t cycle = 0; cycle < 200; ++cycle)
        for (const std::int64_t round : {std::int64_t{0}, std::int64_t{repetition} << 40}) {
          ASSERT_EQ(in_cycle(instant, round + cycle), cycle % repetition == base) << base << " of " << repetition;
          ASSERT_EQ(in_cycle(frame, round + cycle), cycle % repetition == base) << base << " of " << repetition;
        }
    }
}

}  // namespace
}  // namespace ttf::schedules::check
