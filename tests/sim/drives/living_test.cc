// Sensors, hosts and the gateway die, for good or for a while. The fusion goes on with the rest, the ages are
// the measurements' own, and unseen objects coast and end by the rule.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <utility>

#include "schedules/analysis/ages.h"
#include "tests/sim/drives/living_drive.h"

namespace ttf::sim::drives {
namespace {

using fusion::strategies::StrategyKind;

class Living : public testing::TestWithParam<StrategyKind> {};
INSTANTIATE_TEST_SUITE_P(All, Living, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

// Each fused list was measured, is fused once, and is no older than the schedule says. BUFF and TT may wait
// for lists that never come, ADVA never waits. `besides`: a list's longest wait in a node that starts up.
void expect_nothing_invented(const LivingDrive& drive, Duration besides = {}) {
  std::map<SensorId, Duration> most;
  for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(drive.drive.cluster))
    most[path.sensor] = drive.drive.strategy == StrategyKind::kAdva ? path.fused_worst : path.buffered_fused_worst;
  std::map<MeasurementId, std::vector<TrueTime>> measured;
  for (const auto& [id, at] : drive.seen.measured) measured[id].push_back(at);
  std::set<std::pair<MeasurementId, GlobalTime>> once;
  for (const FusedList& list : drive.seen.fused) {
    ASSERT_TRUE(list.disposition == recording::records::Disposition::kFused ||
                list.disposition == recording::records::Disposition::kFusedLate);
    ASSERT_TRUE(once.emplace(list.id, list.measured).second) << "twice";
    ASSERT_LE(list.fused - list.measured, most[list.id.sensor] + besides) << "sensor " << index_of(list.id.sensor);
    // The age is true: the device measured that long ago on any clock, up to clocks and stamps.
    const Duration age = list.fused - list.measured;
    const auto& instants = measured[list.id];
    ASSERT_TRUE(std::any_of(instants.begin(), instants.end(),
                            [&](TrueTime at) {
                              const Duration off = (list.at - at) - age;
                              return off < Duration::microseconds(300) && -off < Duration::microseconds(300);
                            }))
        << "sensor " << index_of(list.id.sensor) << " list " << list.id.sequence;
  }
  for (const SeenImage& image : drive.seen.images) {
    std::set<TrackId> names;
    for (const recording::records::ImageObject& object : image.objects) ASSERT_TRUE(names.insert(object.track).second);
  }
}

TEST_P(Living, WithOneSensorDeadTheOtherIsEnough) {
  for (const char* dead : {"laser", "camera"}) {
    LivingDrive drive(GetParam());
    drive.off(dead, 1.5);
    drive.run_to(4.0);
    expect_nothing_invented(drive);
    const SensorId sensor = drive.sensor(dead);
    std::uint32_t last = 0;
    std::size_t others = 0;
    for (const FusedList& list : drive.seen.fused) {
      if (list.id.sensor == sensor) {
        ASSERT_LT(list.at, at_s(1.7)) << dead << " measures no more";
        last = std::max(last, list.id.sequence);
      }
      others += list.id.sensor != sensor && list.at > at_s(2.0);
    }
    EXPECT_GT(others, 20u);
    std::size_t images = 0;
    for (const SeenImage& image : drive.seen.images) {
      if (image.at < at_s(1.8)) continue;
      ++images;
      ASSERT_EQ(image.objects.size(), 1u) << dead << " dead, the car at " << image.at.ns;
      EXPECT_FALSE(has(image.objects[0].status, recording::records::ImageStatus::kCoasting));
      EXPECT_TRUE(image.shows(sensor, last)) << "the last one there was";
    }
    EXPECT_GT(images, 50u);
  }
}

TEST_P(Living, ASensorThatRestartsIsFusedAgain) {
  for (const char* name : {"laser", "camera"}) {
    LivingDrive drive(GetParam());
    drive.off(name, 1.5);
    drive.on(name, 1.9);
    drive.run_to(4.0);
    expect_nothing_invented(drive);
    const SensorId sensor = drive.sensor(name);
    // Every receiver on its way accepts restarted numbers with the third list: host, gateway, fusion node.
    std::size_t again = 0;
    for (const FusedList& list : drive.seen.fused) again += list.id.sensor == sensor && list.at > at_s(2.6);
    EXPECT_GT(again, 15u) << name;
    const SeenImage& last = drive.seen.images.back();
    EXPECT_EQ(last.objects.size(), 1u);
    for (const MeasurementId& id : last.newest) {
      const auto fused = std::find_if(drive.seen.fused.rbegin(), drive.seen.fused.rend(),
                                      [&](const FusedList& list) { return list.id == id; });
      ASSERT_NE(fused, drive.seen.fused.rend());
      EXPECT_GT(fused->at, at_s(3.7)) << "sensor " << index_of(id.sensor) << ": the newest is of now";
    }
  }
}

// Both die. The image goes on: the object becomes less certain, is marked as coasting, and ends.
void expect_coasting_from(const LivingDrive& drive, double silent_s) {
  const fusion::config::TrackerConfig& rule = drive.drive.scenario.tracker;
  double trace = 0.0;
  int before = 0, coasting = 0, after = 0;
  for (const SeenImage& image : drive.seen.images) {
    if (image.at < at_s(silent_s)) continue;
    const Duration silent = image.valid_at - image.newest_measurement;
    ASSERT_GT(silent, Duration{});
    if (silent > rule.delete_after) {
      EXPECT_TRUE(image.objects.empty()) << silent.ns;
      ++after;
      continue;
    }
    ASSERT_EQ(image.objects.size(), 1u) << silent.ns;
    EXPECT_GT(image.traces[0], trace) << silent.ns;
    trace = image.traces[0];
    const bool called = has(image.objects[0].status, recording::records::ImageStatus::kCoasting);
    EXPECT_EQ(called, silent > rule.coast_after) << silent.ns;
    ++(called ? coasting : before);
  }
  EXPECT_GT(before, 2);
  EXPECT_GT(coasting, 14);
  EXPECT_GT(after, 14);
  for (const SeenUse& use : drive.seen.uses) EXPECT_FALSE(use.stale) << "the image is of now, whatever is in it";
}

TEST_P(Living, WithBothSensorsDeadTracksCoastAndEnd) {
  LivingDrive drive(GetParam());
  drive.off("laser", 1.5);
  drive.off("camera", 1.5);
  drive.run_to(3.5);
  expect_nothing_invented(drive);
  expect_coasting_from(drive, 1.68);
}

TEST_P(Living, WithoutTheGatewayTracksCoastAndWithItAgainTheyAreBornAnew) {
  LivingDrive drive(GetParam());
  drive.off("gateway", 1.5);
  drive.run_to(3.4);
  expect_coasting_from(drive, 1.55);
  const std::size_t images = drive.seen.images.size();
  std::set<TrackId> old;
  for (const SeenImage& image : drive.seen.images)
    for (const recording::records::ImageObject& object : image.objects) old.insert(object.track);
  drive.on("gateway", 3.4);
  drive.run_to(5.0);
  expect_nothing_invented(drive, Duration::milliseconds(60));
  ASSERT_EQ(drive.seen.images.back().objects.size(), 1u);
  for (std::size_t i = images; i < drive.seen.images.size(); ++i)
    for (const recording::records::ImageObject& object : drive.seen.images[i].objects)
      EXPECT_FALSE(old.contains(object.track)) << "what ended does not come back";
}

TEST_P(Living, WithoutTheFusionNodeTheLastImageIsRefusedWhenItIsTooOld) {
  LivingDrive drive(GetParam());
  drive.off("fusion", 1.5);
  drive.run_to(3.0);
  const Duration most = drive.drive.scenario.feature.max_image_age;
  int used = 0, refused = 0;
  for (const SeenUse& use : drive.seen.uses) {
    if (use.at < at_s(1.51)) continue;
    const Duration age = use.global - use.valid_at;
    EXPECT_EQ(use.stale, age > most) << age.ns;
    EXPECT_EQ(use.objects, use.stale ? 0u : 1u);
    EXPECT_EQ(use.sequence, drive.seen.images.back().sequence);
    ++(use.stale ? refused : used);
  }
  EXPECT_LE(used, 3);
  EXPECT_GT(refused, 30);
  ASSERT_FALSE(drive.seen.uses.empty());
  EXPECT_GT(drive.seen.uses.back().global - drive.seen.uses.back().valid_at, Duration::milliseconds(1'300))
      << "its age is what it is";
}

// It comes back empty, counts other rounds of the cycle counter than the rest, and numbers its images from 0.
TEST_P(Living, AFusionNodeThatRestartsBeginsWithNothingAndIsBelievedAgain) {
  LivingDrive drive(GetParam());
  drive.off("fusion", 1.5);
  drive.on("fusion", 1.9);
  drive.run_to(4.0);
  expect_nothing_invented(drive);
  EXPECT_FALSE(std::any_of(drive.seen.images.begin(), drive.seen.images.end(),
                           [](const SeenImage& image) { return image.at > at_s(1.51) && image.at < at_s(1.9); }));
  int stale = 0, again = 0;
  for (const SeenUse& use : drive.seen.uses) {
    EXPECT_TRUE(use.stale || use.at < at_s(1.7) || use.at > at_s(1.9)) << use.at.ns;
    stale += use.stale;
    if (use.at < at_s(2.5)) continue;
    EXPECT_TRUE(use.fresh && !use.stale) << use.at.ns;
    EXPECT_EQ(use.objects, 1u);
    ++again;
  }
  EXPECT_LT(stale, 25) << "start-up, and the third of its images is believed";
  EXPECT_GT(again, 30);
}

// The gateway goes on sending the last list of a dead laser. For a restarted fusion node this is the first
// list, of unknown age: whole rounds of the cycle counter look equal.
TEST_P(Living, AFusionNodeThatRestartsTakesNoOldListForANewOne) {
  for (const char* dead : {"laser", "camera"}) {
    LivingDrive drive(GetParam());
    drive.off(dead, 1.0);
    drive.off("fusion", 1.5);
    drive.on("fusion", 1.9);
    drive.run_to(4.0);
    expect_nothing_invented(drive);
    const SensorId sensor = drive.sensor(dead);
    std::size_t others = 0;
    for (const FusedList& list : drive.seen.fused) {
      EXPECT_FALSE(list.id.sensor == sensor && list.at > at_s(1.3)) << dead << " at " << list.at.ns;
      others += list.at > at_s(2.5);
    }
    EXPECT_GT(others, 15u);
    EXPECT_EQ(drive.seen.images.back().objects.size(), 1u);
  }
}

TEST_P(Living, AHostThatRestartsStampsWhatItMeansAgain) {
  for (const auto& [host, name] : {std::pair{"laser_pre", "laser"}, {"camera_pre", "camera"}}) {
    LivingDrive drive(GetParam());
    drive.off(host, 1.5);
    drive.on(host, 1.9);
    drive.run_to(4.0);
    expect_nothing_invented(drive);
    const SensorId sensor = drive.sensor(name);
    const auto again = std::count_if(drive.seen.fused.begin(), drive.seen.fused.end(), [&](const FusedList& list) {
      return list.id.sensor == sensor && list.at > at_s(2.4);
    });
    EXPECT_GT(again, 15) << host;
  }
}

}  // namespace
}  // namespace ttf::sim::drives
