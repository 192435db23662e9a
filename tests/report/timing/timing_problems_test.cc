// Timing diagrams of runs in real time.
#include <gtest/gtest.h>

#include "report/timing/diagram.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::timing {
namespace {

TEST(TimingDiagram, WhatWasNotInItsTimeIsMarked) {
  TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(d, 500'000);
  const auto problem = [&](std::int64_t ms, int node, std::uint8_t what, std::int64_t late_us, std::uint16_t slot,
                           std::uint32_t count = 1) {
    d.on(recording::records::TimingProblem{SyntheticDrive{}.stamp(ms * 1000, node), what,
                                           Duration::microseconds(late_us), 43, slot, 1, count});
  };
  problem(210, 5, recording::records::kLateWakeUp, 812, 0);
  problem(215, 4, recording::records::kSlotMissed, 900, 1);
  problem(220, 6, recording::records::kLateFrame, 1234, 2);
  problem(225, 6, recording::records::kEarlyFrame, -77, 2);
  problem(230, 6, recording::records::kFramesLost, 0, 2, 3);
  problem(235, 6, recording::records::kFramesLost, 0, 3, 1);
  problem(240, 99, recording::records::kLateWakeUp, 5, 0);  // a node without a lane
  problem(100, 5, recording::records::kLateWakeUp, 6, 0);   // before the window
  problem(350, 5, recording::records::kLateWakeUp, 7, 0);   // after it
  const std::string svg = d.svg();
  EXPECT_EQ(count_class(svg, "problem"), 6u);
  for (const char* words : {"fusion: woken up 812 us late", "gateway: missed its slot 1 of cycle 43, 900 us late",
                            "feature: the frame of slot 2 of cycle 43 came 1234 us late",
                            "feature: the frame of slot 2 of cycle 43 came 77 us early",
                            "feature: 3 frames of slot 2 never came", "feature: a frame of slot 3 never came"})
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
