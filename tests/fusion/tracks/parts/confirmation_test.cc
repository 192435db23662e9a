// Confirmation and deletion.
#include "fusion/tracks/parts/confirmation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "tests/fusion/scenes.h"

namespace ttf::fusion::tracks::parts {
namespace {

// Every pattern of hits and misses over ten lists, against the rule in words. A hit without a track starts a
// track. Three hits in its last five lists confirm it. A tentative track ends once 3 of 5 are out of reach. A
// confirmed track ends with the 4th miss in a row.
TEST(Confirmation, EveryPatternOfHitsFollowsTheRule) {
  config::TrackerConfig config;
  config.confirm_hits = 3;
  config.confirm_window = 5;
  config.delete_misses = 4;
  config.process_noise = 0.01;
  config.initial_velocity_sigma = 0.1;
  for (unsigned pattern = 0; pattern < 1u << 10; ++pattern) {
    Bench bench(config);
    std::optional<std::string> history;  // the living track's
    bool is_confirmed = false;
    unsigned born = 0;
    for (int k = 0; k < 10; ++k) {
      const bool hit = pattern >> k & 1u;
      bench.step(50 * k, hit ? std::vector{position(20.0, 3.0, 0.1)} : std::vector<sensors::Observation>{});
      if (!history && hit) {
        history = "";
        is_confirmed = false;
        born = static_cast<unsigned>(k);
      }
      if (history) {
        *history += hit ? 'h' : '-';
        const std::string recent = history->substr(history->size() > 5 ? history->size() - 5 : 0);
        const auto hits = std::count(recent.begin(), recent.end(), 'h');
        is_confirmed = is_confirmed || hits >= 3;
        const auto still_to_come = static_cast<std::ptrdiff_t>(5 - recent.size());
        const bool ends = is_confirmed ? history->size() >= 4 && history->substr(history->size() - 4) == "----"
                                       : hits + still_to_come < 3;
        if (ends) history.reset();
      }
      ASSERT_EQ(bench.set.tracks.size(), history ? 1u : 0u) << "pattern " << pattern << " list " << k;
      if (history) {
        ASSERT_EQ(bench.set.tracks[0].confirmed, is_confirmed) << "pattern " << pattern << " list " << k;
        ASSERT_EQ(bench.set.tracks[0].birth.measurement.sequence, born);
      }
    }
  }
}

TEST(Confirmation, TooUncertainAPositionEndsATrack) {
  config::TrackerConfig config;
  config.delete_misses = 1000;
  config.delete_after = Duration::milliseconds(100'000);
  config.delete_position_sigma = 2.0;
  Bench bench(config);
  for (int k = 0; k < 6; ++k) bench.step(50 * k, {position(20.0, 0.0, 0.1)});
  ASSERT_EQ(confirmed(bench.set), 1);
  std::int64_t ms = 250;
  while (!bench.set.tracks.empty() && ms < 10'000) bench.step(ms += 50, {});
  // With q = 3, sqrt(q t^3 / 3) alone reaches 2 m after 1.6 s.
  EXPECT_GT(ms, 500);
  EXPECT_LT(ms, 250 + 1600 + 50);
}

TEST(Confirmation, NoMoreConfirmedTracksThanTheImageHolds) {
  Bench bench;
  Lanes lanes{.objects = 30};
  for (int k = 0; k < 12; ++k) bench.step(40 * k, lanes.see(at_ms(40 * k), static_cast<std::uint32_t>(k)));
  EXPECT_EQ(confirmed(bench.set), 25);
  EXPECT_EQ(bench.set.tracks.size(), 30u);
}

}  // namespace
}  // namespace ttf::fusion::tracks::parts
