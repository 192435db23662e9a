#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "report/plots/crowd_panel.h"
#include "report/plots/position_plot.h"
#include "report/plots/schedule_picture.h"
#include "schedules/file/loader.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_cluster.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::plots {
namespace {

constexpr std::int64_t kEnd = 1'500'000;

PositionPlots drive(PositionOptions options = {}) {
  PositionPlots plots(synthetic_names(), std::move(options));
  SyntheticDrive{}.drive(plots, kEnd);
  return plots;
}

TEST(PositionPlots, TakeOfEachListTheObservationOfTheObject) {
  const PositionPlots::Selection s = drive().select();
  ASSERT_EQ(s.observations.size(), 2u);
  // Every list carries a second observation 20 m away, which is another object's.
  EXPECT_EQ(s.observations[0].size(), s.laser_arrows.size());
  for (const auto& list : s.observations)
    for (const auto& o : list) EXPECT_LT(std::abs(o.x - SyntheticDrive::x_at(o.t)), 1.0);
  EXPECT_EQ(s.reference.size(), 16u);
  EXPECT_EQ(s.truth.size(), 151u);
  EXPECT_GT(s.fusion.size(), 30u);
}

TEST(PositionPlots, PutGlobalInstantsOnTrueTime) {
  // Global time is 3 us ahead in this run; the laser measured at 4 ms + k 80 ms of true time.
  const PositionPlots::Selection s = drive().select();
  ASSERT_FALSE(s.observations.empty());
  for (const auto& o : s.observations[0]) EXPECT_NEAR(std::fmod(o.t - 0.004 + 1e-9, 0.08), 0.0, 1e-8) << o.t;
}

TEST(PositionPlots, InstantsOfADamagedLogDoNotOverflow) {
  PositionPlots plots(synthetic_names(), {});
  constexpr std::int64_t kLowest = std::numeric_limits<std::int64_t>::min(),
                         kHighest = std::numeric_limits<std::int64_t>::max();
  recording::records::ObservationSeen seen;
  seen.stamp = {{kHighest}, {0}, {kLowest}, NodeId{0}};
  seen.measured = {kHighest};
  plots.on(seen);
  const PositionPlots::Selection s = plots.select();
  ASSERT_EQ(s.observations.size(), 1u);
  ASSERT_EQ(s.observations[0].size(), 1u);
  EXPECT_NEAR(s.observations[0][0].t, 3 * std::ldexp(1e-9, 63), 1.0);
  expect_renders(plots.over_time_svg());
}

// Objects side by side, 8 m apart, drive 10 m/s for 2 s. Each image has a track 0.1 m left of each but the last object, and one
// 20 m right of all.
PositionPlots crowd(int objects, PositionOptions options = {}) {
  PositionPlots plots(synthetic_names(), std::move(options));
  for (int step = 0; step <= 50; ++step) {
    const double t = 0.04 * step;
    const recording::records::Stamp stamp{{step * 40'000'000}, {}, {step * 40'000'000}, NodeId{5}};
    std::vector<recording::records::ImageObject> tracks;
    for (int o = 0; o < objects; ++o) {
      recording::records::TruthState truth;
      truth.at = stamp.true_time;
      truth.object = static_cast<ObjectId>(o);
      truth.x = 20 + 10 * t;
      truth.y = 8.0 * o;
      plots.on(truth);
      recording::records::ImageObject track;
      track.x = truth.x;
      track.y = o + 1 < objects ? truth.y + 0.1 : -20;
      tracks.push_back(track);
    }
    plots.on(recording::records::ImageWritten{
        stamp, static_cast<std::uint32_t>(step), stamp.global, stamp.global, tracks, {}});
  }
  return plots;
}

TEST(PositionCrowd, GivesEachTrackToTheNearestObject) {
  const PositionPlots plots = crowd(3);
  ASSERT_TRUE(plots.several());
  const PositionPlots::Crowd shown = plots.crowd();
  ASSERT_EQ(shown.trails.size(), 3u);
  EXPECT_FALSE(shown.dense());
  for (std::size_t o = 0; o < 3; ++o) {
    EXPECT_EQ(shown.trails[o].truth.size(), 51u);
    EXPECT_EQ(shown.trails[o].track.size(), o < 2 ? 51u : 0u);
    for (const auto& s : shown.trails[o].track) EXPECT_DOUBLE_EQ(s.y, 8.0 * static_cast<double>(o) + 0.1);
  }
  EXPECT_EQ(shown.tracks.size(), 51u) << "those without an object";
}

TEST(PositionCrowd, DrawsATrailForEachObject) {
  const PositionPlots plots = crowd(25);
  for (const std::string& svg : {plots.plane_svg(), plots.over_time_svg()}) {
    const std::size_t panels = svg == plots.plane_svg() ? 1 : 2;
    EXPECT_EQ(count_class(svg, "truth"), panels * 25);
    EXPECT_EQ(count_class(svg, "track"), panels * 24);
    EXPECT_EQ(count_class(svg, "end"), panels * 25);
    EXPECT_EQ(count_class(svg, "lost"), panels * 51);
    EXPECT_EQ(count(svg, ">23</text>"), 1u) << "over time beside y alone: x is the same for all";
    expect_no_overlaps(svg);
    expect_inside(svg);
    expect_renders(svg);
  }
  expect_on_paper(plots.plane_svg({88, 8}), 88, 8);
  expect_on_paper(plots.over_time_svg({88, 8}), 88, 8);
  std::set<std::string> colours;
  for (std::size_t i = 0; i < PositionPlots::Crowd::kMostTrails; ++i) colours.insert(object_colour(i));
  EXPECT_EQ(colours.size(), PositionPlots::Crowd::kMostTrails) << "each object has its own colour";
}

TEST(PositionCrowd, DrawsManyObjectsAsADensity) {
  const PositionPlots plots = crowd(1000);
  const PositionPlots::Crowd shown = plots.crowd();
  ASSERT_TRUE(shown.dense());
  EXPECT_EQ(shown.tracks.size(), 51u * 1000u);
  for (const std::string& svg : {plots.plane_svg(), plots.over_time_svg()}) {
    EXPECT_EQ(count_class(svg, "truth") + count_class(svg, "track"), 0u);
    EXPECT_GT(count_class(svg, "cell"), 10u);
    EXPECT_LT(svg.size(), 2'000'000u);
    EXPECT_NE(svg.find("1000 objects: a cell"), std::string::npos);
    expect_no_overlaps(svg);
    expect_inside(svg);
  }
}

TEST(PositionCrowd, ShowsWhereADensityHasNoTrack) {
  EXPECT_GT(count_class(crowd(37).plane_svg(), "untracked"), 0u) << "the last object's way";
  EXPECT_GT(count_class(crowd(37).over_time_svg(), "untracked"), 1u)
      << "its y, and its x, where the others' tracks are";
  PositionOptions window;  // it begins between two images
  window.from = TrueTime{} + Duration::milliseconds(1'005);
  for (const PositionPlots& plots : {crowd(37), crowd(37, window)})
    for (const auto& trail : plots.crowd().trails)
      EXPECT_EQ(std::ranges::count(trail.missed, true),
                index_of(trail.object) == 36 ? static_cast<std::ptrdiff_t>(trail.truth.size()) : 0)
          << index_of(trail.object);
  EXPECT_EQ(count_class(crowd(36).over_time_svg(), "untracked"), 0u) << "trails";
}

TEST(PositionCrowd, ImpossiblePlacesOfADamagedLogAreNoTrouble) {
  for (const int objects : {3, 40}) {
    PositionPlots plots = crowd(objects);
    for (const double value :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 1e300}) {
      recording::records::TruthState truth;
      truth.at = {3'000'000'000};
      truth.object = ObjectId{1};
      truth.x = value;
      plots.on(truth);
      truth.at = {std::numeric_limits<std::int64_t>::max()};
      plots.on(truth);
    }
    EXPECT_NE(plots.over_time_svg().find("</svg>"), std::string::npos);
    EXPECT_NE(plots.plane_svg().find("</svg>"), std::string::npos);
  }
}

TEST(PositionCrowd, AChosenObjectIsDrawnAsBefore) {
  const PositionPlots plots = crowd(25, {.object = ObjectId{7}});
  EXPECT_FALSE(plots.several());
  const std::string svg = plots.plane_svg();
  EXPECT_EQ(count_class(svg, "truth"), 1u);
  EXPECT_EQ(plots.objects().size(), 25u);
  for (const auto& s : plots.select().truth) EXPECT_DOUBLE_EQ(s.y, 56);
  EXPECT_FALSE(crowd(1).several());
}

TEST(PositionPlots, FitOnPaper) {
  const PositionPlots plots = drive({.title = "A drive with a long name, which takes two lines"});
  for (const auto& [width_mm, font_pt] : {std::pair{88.0, 8.0}, std::pair{180.0, 10.0}, std::pair{60.0, 7.0}}) {
    expect_on_paper(plots.over_time_svg({width_mm, font_pt}), width_mm, font_pt);
    expect_on_paper(plots.plane_svg({width_mm, font_pt}), width_mm, font_pt);
  }
}

TEST(PositionPlots, ArrowsLeadToTheStepThatIntegratedTheMeasurement) {
  const PositionPlots::Selection s = drive().select();
  EXPECT_GE(s.laser_arrows.size(), 17u);
  std::size_t late = 0;
  for (const auto& a : s.laser_arrows) {
    EXPECT_GT(a.fused.t, a.measured.t);
    EXPECT_LT(a.fused.t, a.measured.t + 0.1);
    EXPECT_NEAR(std::fmod(a.fused.t - 0.003 + 1e-9, 0.01), 0.0, 1e-7) << "steps are at 3 ms + k 10 ms";
    late += a.late;
  }
  EXPECT_GT(late, 0u);
  EXPECT_LT(late, s.laser_arrows.size());
}

TEST(PositionPlots, ShowEverythingThatTheySelect) {
  const PositionPlots plots = drive({.title = "A & B"});
  const PositionPlots::Selection s = plots.select();
  for (const std::string& svg : {plots.over_time_svg(), plots.plane_svg()}) {
    const std::size_t panels = svg == plots.plane_svg() ? 1 : 2;
    EXPECT_EQ(count_class(svg, "dgps"), panels * s.reference.size());
    EXPECT_EQ(count_class(svg, "observation"), panels * (s.observations[0].size() + s.observations[1].size()));
    EXPECT_EQ(count_class(svg, "fusion"), panels * s.fusion.size());
    EXPECT_EQ(count_class(svg, "arrow") + count_class(svg, "arrow late"), panels * s.laser_arrows.size());
    EXPECT_EQ(count_class(svg, "truth"), panels);
    EXPECT_GT(count_class(svg, "instant"), s.laser_arrows.size() / 2);
    for (const char* part :
         {"ISO 8855", "x, forward [m]", "y, left [m]", "A &amp; B", ">dgps<", ">laser<", ">camera<", ">truth<"})
      EXPECT_NE(svg.find(part), std::string::npos) << part;
    expect_no_overlaps(svg);
    expect_inside(svg);
    expect_renders(svg);
  }
  EXPECT_EQ(plots.over_time_svg(), drive({.title = "A & B"}).over_time_svg());
}

// Passes all records on, except some of the feature service's.
class FewerUses final : public recording::records::Sink {
 public:
  FewerUses(PositionPlots& out, std::uint32_t stale_from, std::uint32_t none_from)
      : out_(out), stale_from_(stale_from), none_from_(none_from) {}
  using recording::records::Sink::on;
  void on(const recording::records::FusionStep& r) override { out_.on(r); }
  void on(const recording::records::ImageWritten& r) override { out_.on(r); }
  void on(const recording::records::TruthState& r) override { out_.on(r); }
  void on(const recording::records::FeatureUsed& r) override {
    recording::records::FeatureUsed used = r;
    used.stale = r.image_sequence >= stale_from_;
    if (r.image_sequence < none_from_) out_.on(used);
  }

 private:
  PositionPlots& out_;
  std::uint32_t stale_from_, none_from_;
};

TEST(PositionPlots, ImagesThatNobodyUsedAreNotShownAsUsed) {
  const std::size_t all = drive().select().fusion.size();
  EXPECT_TRUE(drive().select().unused.empty());
  for (const auto& [stale_from, none_from] : {std::pair{100u, 7u}, std::pair{7u, 100u}, std::pair{7u, 10u}}) {
    PositionPlots plots(synthetic_names(), {});
    FewerUses fewer(plots, stale_from, none_from);
    SyntheticDrive{}.drive(fewer, kEnd);
    const PositionPlots::Selection s = plots.select();
    EXPECT_EQ(s.fusion.size(), 7u);
    EXPECT_EQ(s.unused.size(), all - 7);
    const std::string svg = plots.plane_svg();
    EXPECT_EQ(count_class(svg, "fusion"), 7u);
    EXPECT_EQ(count_class(svg, "unused"), all - 7);
    EXPECT_NE(svg.find(">unused image<"), std::string::npos);
  }
  PositionPlots none(synthetic_names(), {});
  FewerUses fewer(none, 0, 0);
  SyntheticDrive{}.drive(fewer, kEnd);
  EXPECT_EQ(none.plane_svg().find("image at its instant of use"), std::string::npos);
}

// The number starts again from 0 with the fusion node: the image of long ago was not used again.
TEST(PositionPlots, AUseBelongsToTheImageJustBefore) {
  PositionPlots plots(synthetic_names(), {});
  const SyntheticDrive made;
  recording::records::ImageObject object;
  recording::records::ImageWritten image;
  image.objects = {&object, 1};
  image.sequence = 3;
  for (const std::int64_t us : {100'000, 5'000'000}) {
    image.stamp = made.stamp(us, 5);
    image.valid_at = {(us + 37'000) * 1000};
    plots.on(image);
  }
  recording::records::FeatureUsed used;
  used.stamp = made.stamp(5'037'000, 6);
  used.image_sequence = 3;
  plots.on(used);
  const PositionPlots::Selection s = plots.select();
  ASSERT_EQ(s.fusion.size(), 1u);
  EXPECT_NEAR(s.fusion[0].t, 5.037, 0.001);
  EXPECT_EQ(s.unused.size(), 1u);
}

TEST(PositionPlots, KeepToTheWindow) {
  PositionOptions options;
  options.from = at_us(500'000);
  options.to = at_us(700'000);
  const PositionPlots::Selection s = drive(options).select();
  EXPECT_EQ(s.truth.size(), 21u);
  for (const auto& list : s.observations)
    for (const auto& o : list) EXPECT_TRUE(o.t >= 0.5 && o.t <= 0.7);
}

TEST(PositionPlots, WithoutTruthTheReferenceGuidesAndWithoutBothAllIsShown) {
  PositionPlots plots(synthetic_names(), {});
  const SyntheticDrive made;
  recording::records::ObservationSeen o;
  o.stamp = made.stamp(60'000, 5);
  o.measured = {50'000'000};
  o.x = 30;
  plots.on(o);
  o.x = 50;
  plots.on(o);
  EXPECT_EQ(plots.select().observations[0].size(), 2u);
  recording::records::ReferenceFix fix;
  fix.measured_true = at_us(40'000);
  fix.x = 49;
  plots.on(fix);
  ASSERT_EQ(plots.select().observations[0].size(), 1u);
  EXPECT_DOUBLE_EQ(plots.select().observations[0][0].x, 50);
}

TEST(PositionPlots, EmptyInputSaysSo) {
  const PositionPlots plots(synthetic_names(), {});
  EXPECT_NE(plots.over_time_svg().find("no positions"), std::string::npos);
  EXPECT_NE(plots.plane_svg().find("no positions"), std::string::npos);
  expect_renders(plots.plane_svg());
}

TEST(PositionPlots, ComparisonsShareTheirAxes) {
  const PositionPlots a = drive(), b = drive();
  const std::array<const PositionPlots*, 2> both{&a, &b};
  const std::vector<std::string> titles{"BUFF", "ADVA"};
  for (const PositionView view : {PositionView::kXOverTime, PositionView::kYOverTime, PositionView::kPlane}) {
    const std::string svg = comparison_svg(both, titles, view, "Both");
    EXPECT_EQ(count(svg, ">BUFF</text>"), 1u);
    EXPECT_EQ(count(svg, ">ADVA</text>"), 1u);
    EXPECT_EQ(count_class(svg, "truth"), 2u);
    expect_no_overlaps(svg);
    expect_inside(svg);
    for (const double width_mm : {60.0, 88.0, 180.0})  // below each other, and side by side
      expect_on_paper(comparison_svg(both, titles, view, "Both", {width_mm, 8}), width_mm, 8);
  }
}

TEST(SchedulePicture, ShowsSlotsTasksAndMultiplexing) {
  const std::string svg = schedule_svg(synthetic_cluster());
  // Three status slots and five image slots on both channels, five slots with one list on A and another on B.
  EXPECT_EQ(count_class(svg, "slot"), 2u * 13u);
  EXPECT_EQ(count_class(svg, "slot free"), 2u * 27u);
  EXPECT_EQ(count_class(svg, "segment"), 2u * 2u);
  EXPECT_EQ(count_class(svg, "task"), 3u);
  EXPECT_EQ(count_class(svg, "instant"), 1u);
  EXPECT_EQ(count_class(svg, "overrun"), 1u) << "track starts at 3.5 ms and takes 3 ms of a 5 ms cycle";
  // Eight cycles: three status slots in each, two lists of five slots in every other, the image in one.
  EXPECT_EQ(count_class(svg, "cell"), 8u * 3u + 4u * 10u + 5u);
  EXPECT_NE(svg.find("gateway: forward_laser runs when a list of laser_objects has arrived"), std::string::npos);
  expect_no_overlaps(svg);
  expect_inside(svg);
  expect_renders(svg);
  EXPECT_EQ(svg, schedule_svg(synthetic_cluster()));
}

TEST(SchedulePicture, DrawsEveryShippedClusterLegibly) {
  for (const char* name :
       {"paper_unsynchronised", "paper_synchronised", "laser_radar", "laser_radar_synchronised", "flexray_demo"}) {
    SCOPED_TRACE(name);
    const std::string svg =
        schedule_svg(schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/" + std::string(name) + ".yaml"));
    expect_no_overlaps(svg);
    expect_inside(svg);
    expect_renders(svg);
    const schedules::model::Cluster cluster =
        schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/" + std::string(name) + ".yaml");
    for (const double width_mm : {88.0, 180.0}) expect_on_paper(schedule_svg(cluster, {width_mm, 8}), width_mm, 8);
    // The demo alone has one, of 13 macroticks in 2000: too narrow for its name.
    const bool window = name == std::string_view("flexray_demo");
    EXPECT_EQ(count(svg, ">symbol window</text>"), window ? 1u : 0u) << "in the legend";
    EXPECT_EQ(count(svg, "80 minislots, symbol window 13 MT, NIT 427 MT</text>"), window ? 1u : 0u);
  }
}

TEST(SchedulePicture, AnEmptyClusterSaysSo) {
  schedules::model::Cluster c;
  c.name = "none";
  EXPECT_NE(schedule_svg(c).find("no nodes and no frames"), std::string::npos);
}

}  // namespace
}  // namespace ttf::report::plots
