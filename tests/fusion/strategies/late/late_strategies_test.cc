// TrackerConfig::late, as the strategies heed it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tests/fusion/strategies/late/late_scenes.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::strategies::late {
namespace {

using oosm::Kind;

std::vector<SensorTiming> free_and_scheduled() { return {free_running(0, 60), scheduled(1, 35, 20, 40)}; }

TEST(LateRefusal, NamesWhatCannotBe) {
  for (const oosm::NamedKind& named : oosm::kKinds) {
    const Kind kind = named.kind;
    const bool clone = kind == Kind::kClone, rewind = kind == Kind::kRewind;
    const auto refusal = [&](StrategyKind strategy, bool scheduled) {
      return late_refusal(strategy, kind, scheduled ? laser_and_camera() : free_and_scheduled());
    };
    for (const bool any : {true, false})
      EXPECT_EQ(refusal(StrategyKind::kBuff, any), "") << "BUFF goes back, whatever is said";
    EXPECT_EQ(refusal(StrategyKind::kAdva, true), "");
    EXPECT_EQ(
        refusal(StrategyKind::kAdva, false),
        clone ? "must not be clone if a sensor measures freely: the schedule must state the instants beforehand" : "");
    EXPECT_EQ(refusal(StrategyKind::kTt, true), rewind || clone ? "" : "must be rewind or clone with strategy tt");
  }
}

// The state at the end of a drive; all lists have arrived, though not in order.
struct Ending {
  std::vector<tracks::TrackView> image;
  std::size_t lists = 0, late = 0, dropped = 0;
};
Ending end_of(StrategyKind kind, Kind late, const std::vector<Arrival>& arrivals) {
  const auto strategy = make_strategy(kind, taking_late(late), laser_and_camera());
  const std::vector<Fused> result = run(*strategy, arrivals, 3500);
  const auto count = [&](Disposition what) {
    return static_cast<std::size_t>(
        std::count_if(result.begin(), result.end(), [&](const Fused& f) { return f.disposition == what; }));
  };
  Ending ending{{}, result.size(), count(Disposition::kFusedLate), count(Disposition::kDroppedTooOld)};
  strategy->image(at_ms(3300), ending.image);
  return ending;
}

class LateUnderAdva : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(All, LateUnderAdva,
                         testing::Values(Kind::kAugmented, Kind::kClone, Kind::kAdjoint, Kind::kAl1, Kind::kBl1,
                                         Kind::kA, Kind::kB, Kind::kC),
                         name_of_kind);

// 25 objects, one in twenty or ten missed. Rewinding reconsiders associations that these methods keep, and
// starts tracks from late lists. The difference is small.
TEST_P(LateUnderAdva, ImagesAreNearlyThoseOfRewinding) {
  const std::vector<Arrival> arrivals = drawn_drive(1, 40);
  const Ending rewinding = end_of(StrategyKind::kAdva, Kind::kRewind, arrivals),
               other = end_of(StrategyKind::kAdva, GetParam(), arrivals);
  EXPECT_EQ(other.lists, arrivals.size());
  EXPECT_EQ(other.late + other.dropped, rewinding.late);
  EXPECT_GT(other.late, 5u);
  ASSERT_EQ(other.image.size(), 25u);
  ASSERT_EQ(rewinding.image.size(), 25u);
  const double sigmas = GetParam() == Kind::kC ? 1.0 : 0.5;
  for (const tracks::TrackView& one : rewinding.image) {
    const auto same = std::min_element(
        other.image.begin(), other.image.end(), [&](const tracks::TrackView& a, const tracks::TrackView& b) {
          return (a.state - one.state).head<2>().squaredNorm() < (b.state - one.state).head<2>().squaredNorm();
        });
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(same->state(c), one.state(c), sigmas * std::sqrt(one.covariance(c, c))) << "component " << c;
  }
}

TEST_P(LateUnderAdva, AllocatesNothing) {
  std::vector<Arrival> arrivals = drawn_drive(4, 40);
  sort_by_arrival(arrivals);
  config::TrackerConfig config = taking_late(GetParam());
  config.history_scans = 20;
  const auto strategy = make_strategy(StrategyKind::kAdva, config, laser_and_camera());
  std::vector<tracks::TrackView> image;
  image.reserve(static_cast<std::size_t>(config.max_objects));
  std::size_t next = 0, late = 0;
  const std::int64_t before_all = support::allocations();
  for (std::int64_t now = 0; now <= 3500; now += 10) {
    for (; next < arrivals.size() && arrivals[next].ms <= now; ++next) strategy->accept(arrivals[next].list.view());
    strategy->fuse(at_ms(now));
    strategy->image(at_ms(now + 40), image);
    for (const FusedList& f : strategy->last_fused()) late += f.disposition == Disposition::kFusedLate ? 1 : 0;
  }
  EXPECT_EQ(support::allocations(), before_all);
  EXPECT_EQ(next, arrivals.size());
  EXPECT_GT(late, 5u);
}

// A list that comes after its instant was settled is taken in by rewinding: the bits of plain BUFF.
TEST(LateUnderBuff, IsAlwaysRewinding) {
  std::vector<Arrival> arrivals = drawn_drive(5, 40);
  for (std::size_t i = 10; i < arrivals.size(); i += 7) arrivals[i].ms += 100;  // after their instants were settled
  const Ending rewinding = end_of(StrategyKind::kBuff, Kind::kRewind, arrivals);
  EXPECT_GT(rewinding.late, 5u);
  for (const Kind kind : {Kind::kAugmented, Kind::kClone, Kind::kC}) {
    const Ending other = end_of(StrategyKind::kBuff, kind, arrivals);
    EXPECT_EQ(other.late, rewinding.late);
    EXPECT_TRUE(same_bits(other.image, rewinding.image));
  }
}

TEST(LateUnderTt, ClonesChangeNothingIfAllListsComeBeforeTheyAreDue) {
  const std::vector<Arrival> arrivals = drawn_drive(6, 40);
  const Ending rewinding = end_of(StrategyKind::kTt, Kind::kRewind, arrivals),
               clones = end_of(StrategyKind::kTt, Kind::kClone, arrivals);
  EXPECT_EQ(clones.late, 0u);
  EXPECT_TRUE(same_bits(clones.image, rewinding.image));
}

TEST(LateUnderTt, AListThatComesAfterItWasDueIsForTheClone) {
  std::vector<Arrival> arrivals = drawn_drive(6, 40);
  for (std::size_t i = 10; i < arrivals.size(); i += 7) arrivals[i].ms += 60;
  const Ending rewinding = end_of(StrategyKind::kTt, Kind::kRewind, arrivals),
               clones = end_of(StrategyKind::kTt, Kind::kClone, arrivals);
  EXPECT_GT(rewinding.late, 5u);
  EXPECT_EQ(clones.late, rewinding.late);
  EXPECT_EQ(clones.dropped, 0u);
  EXPECT_EQ(clones.image.size(), rewinding.image.size());
}

}  // namespace
}  // namespace ttf::fusion::strategies::late
