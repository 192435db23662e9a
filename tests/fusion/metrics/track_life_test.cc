// Lives of objects: a published sequence, and sequences by hand.
#include "fusion/metrics/track_life.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include "fusion/metrics/clear_mot.h"
#include "tests/support/allocation_counter.h"

namespace ttf::fusion::metrics {
namespace {

using Objects = std::vector<Identity>;

TrueTime instant(int i) { return TrueTime{} + Duration::milliseconds(100 * i); }

// One object's life, one letter an instant: a track's letter, '.' missed, ' ' not listed.
ObjectLife life_of(std::string_view letters) {
  ClearMot mot(1.0);
  TrackLives lives;
  int i = 0;
  for (const char letter : letters) {
    const Objects objects(letter == ' ' ? 0u : 1u, 7u);
    const Objects tracks(letter == ' ' || letter == '.' ? 0u : 1u, static_cast<Identity>(letter));
    const std::vector<double> distances(objects.size() * tracks.size(), 0.5);
    lives.step(instant(i++), objects, mot.step(objects, tracks, distances));
  }
  EXPECT_EQ(lives.lives().size(), 1u);
  return lives.lives().front();
}

// py-motmetrics, README.md: two objects, one mostly and one partly tracked, one switch, one fragmentation.
TEST(TrackLivesPublished, Readme) {
  constexpr double kBeyond = std::numeric_limits<double>::quiet_NaN();
  ClearMot mot(10.0);
  TrackLives lives;
  const Objects objects{1, 2};
  lives.step(instant(0), objects,
             mot.step(objects, Objects{1, 2, 3}, std::vector<double>{0.1, kBeyond, 0.3, 0.5, 0.2, 0.3}));
  lives.step(instant(1), objects, mot.step(objects, Objects{1}, std::vector<double>{0.2, 0.4}));
  const LifeSummary part = lives.summary();
  EXPECT_EQ(part.mostly_tracked, 1u);
  EXPECT_EQ(part.partly_tracked, 1u);
  EXPECT_EQ(part.mostly_lost, 0u);
  EXPECT_EQ(part.switches, 0u);
  EXPECT_EQ(part.fragmentations, 0u);
  lives.step(instant(2), objects, mot.step(objects, Objects{1, 3}, std::vector<double>{0.6, 0.2, 0.1, 0.6}));
  const LifeSummary full = lives.summary();
  EXPECT_EQ(full.mostly_tracked, 1u);
  EXPECT_EQ(full.partly_tracked, 1u);
  EXPECT_EQ(full.mostly_lost, 0u);
  EXPECT_EQ(full.switches, 1u);
  EXPECT_EQ(full.fragmentations, 1u);
}

TEST(TrackLives, BirthConfirmationAndFraction) {
  const ObjectLife life = life_of("  ...aaaaa. ");
  EXPECT_EQ(life.born, instant(2));
  EXPECT_EQ(life.last, instant(10));
  EXPECT_EQ(life.confirmed_after(), Duration::milliseconds(300));
  EXPECT_EQ(life.instants, 9u);
  EXPECT_EQ(life.tracked, 5u);
  EXPECT_DOUBLE_EQ(life.fraction_tracked(), 5.0 / 9.0);
  EXPECT_EQ(life.fragmentations, 0u) << "before the first and after the last match";
}

TEST(TrackLives, NeverConfirmed) {
  const ObjectLife life = life_of("....");
  EXPECT_EQ(life.confirmed_after(), std::nullopt);
  EXPECT_EQ(life.fraction_tracked(), 0.0);
  EXPECT_EQ(life.coverage(), Coverage::kMostlyLost);
}

TEST(TrackLives, FragmentationsAndSwitches) {
  const struct {
    const char* letters;
    std::uint64_t fragmentations, switches;
  } rows[] = {{"aaaa", 0, 0},    {"aabb", 0, 1},  {"a.a", 1, 0},    {"a...a", 1, 0}, {"a.b", 1, 1},
              {"a.a.b.a", 3, 2}, {"abab", 0, 3},  {"a..", 0, 0},    {"..a", 0, 0},   {"a  a", 0, 0},
              {"a  b", 0, 1},    {"a . a", 1, 0}, {".a. .b.", 1, 1}};
  for (const auto& row : rows) {
    const ObjectLife life = life_of(row.letters);
    EXPECT_EQ(life.fragmentations, row.fragmentations) << '"' << row.letters << '"';
    EXPECT_EQ(life.switches, row.switches) << '"' << row.letters << '"';
  }
}

TEST(TrackLives, CoverageAtItsBounds) {
  EXPECT_EQ(life_of("aaaa.").coverage(), Coverage::kMostlyTracked);  // 80 %
  EXPECT_EQ(life_of("aaa.").coverage(), Coverage::kPartlyTracked);
  EXPECT_EQ(life_of("a....").coverage(), Coverage::kPartlyTracked);  // 20 %
  EXPECT_EQ(life_of("a.....").coverage(), Coverage::kMostlyLost);
}

//   object 3   . a a a .      object 9      . . .      object 4   b b
TEST(TrackLives, SummaryOfSeveral) {
  TrackLives lives;
  const auto match = [](Identity object, Identity track) { return Match{object, track, 0.5, false}; };
  lives.step(instant(0), Objects{3}, {});
  lives.step(instant(1), Objects{3}, std::vector<Match>{match(3, 1)});
  lives.step(instant(2), Objects{9, 3}, std::vector<Match>{match(3, 1)});
  lives.step(instant(3), Objects{9, 4, 3}, std::vector<Match>{match(3, 1), match(4, 2)});
  lives.step(instant(4), Objects{4, 3, 9}, std::vector<Match>{match(4, 2)});
  ASSERT_EQ(lives.lives().size(), 3u);
  EXPECT_EQ(lives.lives()[0].object, 3u);
  EXPECT_EQ(lives.lives()[1].object, 4u);
  EXPECT_EQ(lives.lives()[2].object, 9u);
  const LifeSummary all = lives.summary();
  EXPECT_EQ(all.objects, 3u);
  EXPECT_EQ(all.confirmed, 2u);
  EXPECT_EQ(all.mostly_tracked, 1u);
  EXPECT_EQ(all.partly_tracked, 1u);
  EXPECT_EQ(all.mostly_lost, 1u);
  EXPECT_NEAR(all.mean_confirmed_after_s, 0.05, 1e-15);
  EXPECT_EQ(all.worst_confirmed_after, Duration::milliseconds(100));
  EXPECT_NEAR(all.mean_fraction_tracked, (0.6 + 1.0 + 0.0) / 3.0, 1e-15);
}

TEST(TrackLives, NothingToSumUp) {
  const LifeSummary none = TrackLives().summary();
  EXPECT_EQ(none.objects, 0u);
  EXPECT_TRUE(std::isnan(none.mean_fraction_tracked));
  EXPECT_TRUE(std::isnan(none.mean_confirmed_after_s));
}

TEST(TrackLives, AllocatesNothingOnceAllObjectsHaveAppeared) {
  TrackLives lives;
  const Objects early{49, 3, 17}, late{3, 18, 0, 49};
  const std::vector<Match> matches{{3, 1, 0.5, false}};
  lives.step(instant(0), early, matches);
  lives.step(instant(1), late, matches);
  const std::int64_t before = support::allocations();
  for (int i = 2; i < 20; ++i) lives.step(instant(i), i < 10 ? early : late, matches);
  EXPECT_EQ(support::allocations(), before);
  EXPECT_EQ(lives.lives().size(), 5u);
}

TEST(TrackLivesDeathTest, InstantsAndListsAreChecked) {
  TrackLives lives;
  lives.step(instant(3), Objects{1}, {});
  EXPECT_DEATH(lives.step(instant(3), Objects{1}, {}), "300000000 ns after 300000000 ns");
  EXPECT_DEATH(lives.step(instant(4), Objects{1, 1}, {}), "object 1 listed twice");
  const std::vector<Match> match{{1, 5, 0.5, false}}, twice{match[0], match[0]};
  EXPECT_DEATH(lives.step(instant(4), Objects{2}, match), "object 1 at 400000000 ns matched twice, or not listed");
  EXPECT_DEATH(lives.step(instant(4), Objects{1}, twice), "matched twice");
}

}  // namespace
}  // namespace ttf::fusion::metrics
