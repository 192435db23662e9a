// TT has all instants and waits only for older lists. Timelines: x measured, > arrives at the fusion node;
// fusion every 10 ms.
#include <gtest/gtest.h>

#include "tests/fusion/drives.h"

namespace ttf::fusion::strategies {
namespace {

// Laser (80 ms from 0, worst delay 60) and camera (40 ms from 20, worst delay 35):
//
//   t [ms]    0     10    20    30    40    50    60    70    80    90
//   laser     x0 --------------------------->50               x1
//   camera                x0 ------------>45      x1 ------------>85
//   fused                                   0/0, 1/0                1/1
//
// Camera 0 (20 ms) waits for the laser's 0 ms, which is due at 60 and comes at 50: then both are fused. BUFF
// would wait until 20 + 60 = 80 for a list that is not on the schedule. Camera 1 (60 ms) does not wait: the
// laser's next instant is younger.
TEST(TimeTriggered, WaitsOnlyForWhatIsOnTheSchedule) {
  const std::vector<Arrival> arrivals{
      {50, list_of(0, 0, at_ms(0))}, {45, list_of(1, 0, at_ms(20))}, {85, list_of(1, 1, at_ms(60))}};
  const auto tt = make_strategy(StrategyKind::kTt, {}, laser_and_camera());
  EXPECT_EQ(run(*tt, arrivals, 200), (std::vector{fused(50, 0, 0), fused(50, 1, 0), fused(90, 1, 1)}));
  const auto buff = make_strategy(StrategyKind::kBuff, {}, laser_and_camera());
  EXPECT_EQ(run(*buff, arrivals, 200), (std::vector{fused(50, 0, 0), fused(80, 1, 0), fused(120, 1, 1)}));
}

//   t [ms]    0     10    20    30    40    50    60
//   laser     x0 (lost)                           due
//   camera                x0 ------------>45
//   fused                                         1/0
TEST(TimeTriggered, DoesNotWaitForAMissingListBeyondItsDueInstant) {
  const auto strategy = make_strategy(StrategyKind::kTt, {}, laser_and_camera());
  EXPECT_EQ(run(*strategy, {{45, list_of(1, 0, at_ms(20))}}, 200), (std::vector{fused(60, 1, 0)}));
}

// The laser is due at 60:
//
//   t [ms]    0     10    20    30    40    50    60    70    80
//   laser     x0 ------------------------------------------>75
//   camera                x0 ------------>45
//   fused                                         1/0         0/0 late
TEST(TimeTriggered, RepairsAListThatComesAfterItWasDue) {
  const Lanes lanes{.objects = 3};
  const OwnedList laser = list_of(0, 0, at_ms(0), lanes.see(at_ms(0), 0)),
                  camera = list_of(1, 0, at_ms(20), lanes.see(at_ms(20), 1));
  const auto strategy = make_strategy(StrategyKind::kTt, {}, laser_and_camera()),
             in_order = make_strategy(StrategyKind::kTt, {}, laser_and_camera());
  EXPECT_EQ(run(*strategy, {{75, laser}, {45, camera}}, 100),
            (std::vector{fused(60, 1, 0), fused(80, 0, 0, Disposition::kFusedLate)}));
  run(*in_order, {{45, laser}, {45, camera}}, 100);
  EXPECT_EQ(strategy->tentative_count(), 3);
  EXPECT_EQ(strategy->newest_measured(), at_ms(20));
  // Both are confirmed with the same further lists: the images must be bitwise equal.
  std::vector<tracks::TrackView> image[2];
  int i = 0;
  for (Strategy* s : {strategy.get(), in_order.get()}) {
    for (std::uint32_t k = 1; k <= 3; ++k)
      s->accept(list_of(1, k, at_ms(20 + 40 * k), lanes.see(at_ms(20 + 40 * k), k)).view());
    s->fuse(at_ms(500));
    s->image(at_ms(500), image[i++]);
  }
  EXPECT_EQ(image[0].size(), 3u);
  EXPECT_TRUE(same_bits(image[0], image[1]));
}

// Stamps are clock readings. Both measure at 40 ms. The camera stamps 39.997 and arrives first, the laser
// stamps 39.995.
//   By its stamp alone the camera would have no scheduled predecessor, and the laser would come late.
TEST(TimeTriggered, SensorsOfOneInstantWaitForEachOtherWhateverTheStamps) {
  const std::vector<SensorTiming> together{scheduled(0, 60, 0, 40), scheduled(1, 35, 0, 40)};
  const GlobalTime laser_stamp{39'995'000}, camera_stamp{39'997'000};
  const auto strategy = make_strategy(StrategyKind::kTt, {}, together);
  EXPECT_EQ(run(*strategy,
                {{25, list_of(0, 0, at_ms(0))},
                 {25, list_of(1, 0, at_ms(0))},
                 {60, list_of(1, 1, camera_stamp)},
                 {90, list_of(0, 1, laser_stamp)}},
                200),
            (std::vector{fused(30, 0, 0), fused(30, 1, 0), fused(90, 0, 1), fused(90, 1, 1)}));
  // The laser's is lost: not beyond 40 + 60.
  const auto without = make_strategy(StrategyKind::kTt, {}, together);
  EXPECT_EQ(run(*without, {{60, list_of(1, 1, camera_stamp)}}, 200), (std::vector{fused(100, 1, 1)}));
}

// An instant of the schedule is recognised from a slightly early or late stamp.
TEST(TimeTriggered, RecognisesInstantsByStampsThatAreALittleOff) {
  for (const std::int64_t off_ns : {-300'000, 0, 300'000}) {
    const auto strategy = make_strategy(StrategyKind::kTt, {}, laser_and_camera());
    EXPECT_EQ(run(*strategy, {{30, list_of(0, 0, at_ms(0) + Duration{off_ns})}, {45, list_of(1, 0, at_ms(20))}}, 200),
              (std::vector{fused(30, 0, 0), fused(50, 1, 0)}));
  }
}

// Before a sensor's first instant there is no list to wait for.
TEST(TimeTriggered, TheScheduleHasABeginning) {
  const auto strategy =
      make_strategy(StrategyKind::kTt, {}, std::vector{scheduled(0, 60, 100, 80), scheduled(1, 35, 20, 40)});
  EXPECT_EQ(run(*strategy, {{45, list_of(1, 0, at_ms(20))}}, 200), (std::vector{fused(50, 1, 0)}));
}

}  // namespace
}  // namespace ttf::fusion::strategies
