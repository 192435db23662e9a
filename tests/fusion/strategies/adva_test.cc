// ADVA fuses every list at once. Timelines: x measured, > arrives at the fusion node; fusion every 10 ms.
#include <gtest/gtest.h>

#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies {
namespace {

// Everything at the fusion instant after its arrival, the older one as late:
//
//   t [ms]    0     10    20    30    40    50    60    70
//   sensor 0  x0 ------------------------------>55
//   sensor 1        x0 --------->30         x1 ------>65
//   fused                       1/0               0/0   1/1
//                                                 late
TEST(Adva, FusesOnArrival) {
  const std::vector<SensorTiming> sensors{free_running(0, 60), free_running(1, 30)};
  const auto strategy = make_strategy(StrategyKind::kAdva, {}, sensors);
  const std::vector<Arrival> arrivals{
      {55, list_of(0, 0, at_ms(0))}, {30, list_of(1, 0, at_ms(10))}, {65, list_of(1, 1, at_ms(50))}};
  EXPECT_EQ(run(*strategy, arrivals, 150),
            (std::vector{fused(30, 1, 0), fused(60, 0, 0, Disposition::kFusedLate), fused(70, 1, 1)}));
}

TEST(Adva, ListsThatArriveTogetherAreFusedInOrder) {
  const auto strategy = make_strategy(StrategyKind::kAdva, {}, std::vector{free_running(0, 60), free_running(1, 30)});
  EXPECT_EQ(run(*strategy, {{25, list_of(1, 0, at_ms(10))}, {25, list_of(0, 0, at_ms(0))}}, 50),
            (std::vector{fused(30, 0, 0), fused(30, 1, 0)}));
}

TEST(Adva, OlderThanTheHistoryIsDropped) {
  config::TrackerConfig config;
  config.history_scans = 2;
  const auto strategy = make_strategy(StrategyKind::kAdva, config, std::vector{free_running(0, 60)});
  std::vector<Arrival> arrivals;
  for (std::uint32_t k = 1; k <= 4; ++k) arrivals.push_back({10 * k, list_of(0, k, at_ms(10 * k))});
  arrivals.push_back({60, list_of(0, 0, at_ms(0))});
  EXPECT_EQ(run(*strategy, arrivals, 60).back(), fused(60, 0, 0, Disposition::kDroppedTooOld));
  ASSERT_EQ(strategy->newest().size(), 1u);
  EXPECT_EQ(strategy->newest()[0].sequence, 4u);
}

}  // namespace
}  // namespace ttf::fusion::strategies
