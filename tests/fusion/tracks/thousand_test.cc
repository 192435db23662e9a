// 1,000 objects in the tracker alone; through a whole cluster: tests/sim/drives/thousand_test.cc.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "fusion/strategies/strategy.h"
#include "tests/fusion/scenes.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::tracks {
namespace {

constexpr int kObjects = 1000;
constexpr std::uint32_t kCycles = 14;

// Two sensors every 40 ms. The first one's lists come a cycle late, so each causes a rewind.
TEST(Thousand, ObjectsAreTrackedEachByOneTrackWithoutAllocation) {
  const Lanes laser{.objects = kObjects, .across = 40, .sigma = 0.2, .seed = 1};
  const Lanes camera{.objects = kObjects, .across = 40, .sigma = 0.4, .seed = 2};
  config::TrackerConfig config;
  config.max_objects = kObjects;
  config.max_observations = kObjects;
  config.history_scans = 8;
  const strategies::SensorTiming sensors[] = {{SensorId{0}, strategies::Settling::after(Duration::milliseconds(60)),
                                               true, at_ms(0), Duration::milliseconds(40)},
                                              {SensorId{1}, strategies::Settling::after(Duration::milliseconds(35)),
                                               true, at_ms(20), Duration::milliseconds(40)}};
  const auto strategy = make_strategy(strategies::StrategyKind::kAdva, config, sensors);
  std::vector<OwnedList> early, late;
  for (std::uint32_t k = 0; k < kCycles; ++k) {
    late.push_back(list_of(0, k, at_ms(40 * k), laser.see(at_ms(40 * k), k)));
    early.push_back(list_of(1, k, at_ms(40 * k + 20), camera.see(at_ms(40 * k + 20), k)));
  }
  std::vector<TrackView> image;
  image.reserve(kObjects);
  const GlobalTime end = at_ms(40 * (kCycles - 1) + 20);
  std::int64_t allocations = 0;
  for (std::uint32_t k = 0; k < kCycles; ++k) {
    const auto before = support::allocations();
    strategy->accept(early[k].view());
    strategy->fuse(early[k].measured);
    strategy->accept(late[k].view());
    strategy->fuse(early[k].measured);
    allocations += support::allocations() - before;
    EXPECT_EQ(strategy->last_fused()[0].disposition, strategies::Disposition::kFusedLate) << k;
  }
  strategy->image(end, image);
  EXPECT_EQ(allocations, 0);
  ASSERT_EQ(image.size(), static_cast<std::size_t>(kObjects));
  std::set<int> tracked;
  double sum = 0.0;
  for (const TrackView& track : image) {
    for (int object = 0; object < kObjects; ++object) {
      const estimators::State apart = track.state - laser.truth(object, end);
      if (std::hypot(apart(0), apart(1)) > 1.0) continue;
      tracked.insert(object);
      sum += apart(0) * apart(0) + apart(1) * apart(1);
    }
  }
  EXPECT_EQ(tracked.size(), static_cast<std::size_t>(kObjects));
  // Two coordinates; one list of the better sensor alone would leave 0.2 m in each.
  EXPECT_LT(std::sqrt(sum / (2 * kObjects)), 0.15);
}

}  // namespace
}  // namespace ttf::fusion::tracks
