// Timing diagrams of runs in real time.
#include <gtest/gtest.h>

#include "report/timing/diagram.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::timing {
namespace {

TEST(TimingDiagram, TimingProblemsInTheWindowAreMarked) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(d, 500'000);
  const auto problem = [&](std::int64_t ms, int node, recording::records::TimingFault what, std::int64_t late_us,
                           std::uint16_t slot, std::uint32_t count = 1) {
    d.on(recording::records::TimingProblem{SyntheticDrive{}.stamp(ms * 1000, node), what,
                                           Duration::microseconds(late_us), 43, slot, 1, count});
  };
  problem(210, 5, recording::records::TimingFault::kLateWakeUp, 812, 0);
  problem(215, 4, recording::records::TimingFault::kSlotMissed, 900, 1);
  problem(220, 6, recording::records::TimingFault::kLateFrame, 1234, 2);
  problem(225, 6, recording::records::TimingFault::kEarlyFrame, -77, 2);
  problem(230, 6, recording::records::TimingFault::kFramesLost, 0, 2, 3);
  problem(235, 6, recording::records::TimingFault::kFramesLost, 0, 3, 1);
  problem(240, 99, recording::records::TimingFault::kLateWakeUp, 5, 0);  // a node without a lane
  problem(100, 5, recording::records::TimingFault::kLateWakeUp, 6, 0);   // before the window
  problem(350, 5, recording::records::TimingFault::kLateWakeUp, 7, 0);   // after it
  const std::string svg = d.svg();
  EXPECT_EQ(count_class(svg, "problem"), 6u);
  for (const char* words : {"fusion: woken up late, by 812 us", "gateway: slot missed, slot 1 of cycle 43, by 900 us",
                            "feature: frame came late, slot 2 of cycle 43, by 1234 us",
                            "feature: frame came early, slot 2 of cycle 43, by 77 us",
                            "feature: frames lost, 3 of slot 2", "feature: frames lost, 1 of slot 3"})
    EXPECT_EQ(count(svg, std::string("<title>") + words + "</title>"), 1u) << words;
  EXPECT_EQ(count(svg, ">late, early or lost in real time</text>"), 1u);
  expect_no_overlaps(svg);
  expect_renders(svg);
  TimingDiagram clean(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(clean, 500'000);
  EXPECT_EQ(count_class(clean.svg(), "problem"), 0u);
  EXPECT_EQ(count(clean.svg(), "in real time"), 0u);
}

}  // namespace
}  // namespace ttf::report::timing
