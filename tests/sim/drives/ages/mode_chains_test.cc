// A drive whose detector works by modes. Each detection is where its mode says, and no list is lost. No chain is longer than its
// mode's bound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "schedules/check/checker.h"
#include "schedules/model/ports.h"
#include "schedules/modes/mode_text.h"
#include "schedules/modes/stated.h"
#include "sim/drives/detectors.h"
#include "tests/sim/drives/ages/followed_chains.h"
#include "tests/sim/drives/drive_fixture.h"
#include "tests/support/refusals.h"

namespace ttf::sim::drives::ages {
namespace {

using fusion::strategies::StrategyKind;
using schedules::modes::StatedModes;
using testing::HasSubstr;

constexpr const char* kDrive = "scenarios/adaptive_detection_modes.yaml";

// The detector's acts. A chain begins with a picture that it looks at: the others are kept from `chains`.
class DetectorsDrive final : public recording::records::Sink {
 public:
  DetectorsDrive(const Drive& drive, const StatedModes& stated)
      : chains(drive.cluster, evaluation_start(drive.scenario)), node_(stated.detector.node) {
    for (const schedules::model::PortBinding& out : stated.detector.task->writes) lists_.insert(out.pdu);
  }

  FollowedChains chains;
  std::vector<recording::records::TaskRun> runs;  // the detector's
  std::vector<std::string> frames;
  std::vector<GlobalTime> begun;  // by frame
  std::vector<recording::records::DetectionMade> made;
  std::map<recording::records::Hop, int> hops;  // its lists'

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::TaskRun& r) override {
    if (r.start.node == node_) runs.push_back(r);
  }
  void on(const recording::records::SequencePlanned& r) override {
    frames.emplace_back(r.text);
    begun.push_back(r.stamp.global);
  }
  void on(const recording::records::DetectionMade& r) override {
    made.push_back(r);
    frame_of[{r.id.sensor, r.id.sequence}] = r.frame;
    chains.on(measured_[{r.id.sensor, r.id.sequence}]);
  }
  void on(const recording::records::Measured& r) override { measured_[{r.id.sensor, r.id.sequence}] = r; }
  void on(const recording::records::ImageWritten& r) override { chains.on(r); }
  void on(const recording::records::CommandIssued& r) override { chains.on(r); }
  void on(const recording::records::ListHop& r) override {
    // The fusion cannot use a picture that is older than the first sample of odometry.
    if (lists_.contains(r.pdu) && r.stamp.true_time > TrueTime{} + Duration::milliseconds(100)) ++hops[r.hop];
    chains.on(r);
  }

  std::map<std::pair<SensorId, std::uint32_t>, std::uint32_t> frame_of;

 private:
  NodeId node_;
  std::set<PduId> lists_;
  std::map<std::pair<SensorId, std::uint32_t>, recording::records::Measured> measured_;
};

const schedules::modes::Mode& mode_named(const StatedModes& stated, const std::string& name) {
  return *std::ranges::find(stated.modes, name, &schedules::modes::Mode::name);
}

// All detections begin at their modes' instants, and end before the next ones begin.
void expect_at_instants(const DetectorsDrive& seen, const StatedModes& stated, Duration cycle) {
  std::size_t run = 0;
  for (std::size_t f = 0; f + 1 < seen.frames.size(); ++f) {
    const schedules::modes::Mode& mode = mode_named(stated, seen.frames[f]);
    EXPECT_EQ((seen.begun[f + 1] - seen.begun[f] + Duration{cycle.ns / 2}).ns / cycle.ns, mode.cycles);
    for (const schedules::modes::PlacedDetection& one : mode.detections) {
      ASSERT_LT(run, seen.runs.size());
      const auto& now = seen.runs[run++];
      const Duration late = now.start.global - seen.begun[f] - one.begins;
      EXPECT_LE(std::abs(late.ns), 1'000) << "a macrotick";
      EXPECT_EQ(now.start.global, now.activated.global);
      EXPECT_NEAR(in_ms(now.end.global - now.start.global), in_ms(one.worst_case), 0.2);
      if (run < seen.runs.size()) {  // the last one has not ended
        EXPECT_LT(now.end.global, seen.runs[run].start.global);
      }
      EXPECT_TRUE(now.deadline_met);
    }
  }
  EXPECT_GT(run, 30u);
}

void expect_within_bounds(const DetectorsDrive& seen, const Drive& drive, const StatedModes& stated) {
  using schedules::modes::BoundsOfMode;
  const std::string letters = "ABC";
  const schedules::modes::SoundModes sound{stated.detector, stated.grid, &stated.modes, letters};
  const auto ports = camera_ports(*stated.detector.task);
  const std::size_t chains = schedules::modes::chain_names(drive.cluster, stated.detector).size();
  ASSERT_EQ(chains, ports.size());
  std::size_t compared = 0;
  for (std::size_t c = 0; c < chains; ++c) {
    const SensorId camera = drive.cluster.pdu(ports[c]->pdu).sensor;
    std::map<std::string, schedules::modes::CameraBound> bounds;
    Duration longest_reaction{};
    for (const BoundsOfMode& row : bounds_by_mode(drive.cluster, sound, c)) {
      bounds[row.name] = row.cameras.at(0);
      longest_reaction = std::max(longest_reaction, row.cameras.at(0).reaction);
    }
    for (const FollowedChains::First& first : seen.chains.firsts()) {
      if (first.picture.sensor != camera) continue;
      const auto frame = seen.frame_of.at({first.picture.sensor, first.picture.sequence});
      EXPECT_GE(first.time, bounds.at(seen.frames[frame]).least) << seen.frames[frame];
      EXPECT_LE(first.time, bounds.at(seen.frames[frame]).most) << seen.frames[frame];
      ++compared;
    }
    for (const schedules::analysis::chain::Chain& chain : schedules::analysis::chain::chains(drive.cluster)) {
      if (chain.sensor != camera) continue;
      FollowedChains copy = seen.chains;
      EXPECT_LE(copy.seen(chain.command, camera).age_until_next_most, longest_reaction);
      EXPECT_GT(copy.seen(chain.command, camera).readings, 20u);
    }
  }
  EXPECT_GT(compared, 30u);
}

class ModesOfADrive : public ::testing::Test {
 protected:
  void drive_for(StrategyKind kind, std::int64_t ms, std::uint64_t seed) {
    Drive drive(kDrive, kind);
    drive.scenario.duration = Duration::milliseconds(ms);
    ASSERT_EQ(schedules::check::check(drive.cluster).size(), 0u);
    const std::vector<StatedModes> stated = schedules::modes::stated_modes(drive.cluster);
    ASSERT_EQ(stated.size(), 1u);
    DetectorsDrive seen(drive, stated[0]);
    const DriveOutcome outcome = drive.run(seen, seed);
    const std::set<std::string> modes(seen.frames.begin(), seen.frames.end());
    EXPECT_EQ(modes, (std::set<std::string>{"ABC", "AaBaCa"})) << "modes change in the drive";
    expect_at_instants(seen, stated[0], drive.cluster.cycle());
    using recording::records::Hop;
    EXPECT_GT(seen.hops[Hop::kWritten], 30);
    for (const Hop lost : {Hop::kTorn, Hop::kOverwritten, Hop::kStale, Hop::kDiscarded})
      EXPECT_EQ(seen.hops[lost], 0) << static_cast<int>(lost);
    EXPECT_LE(std::abs(seen.hops[Hop::kWritten] - seen.hops[Hop::kRead]), 1);
    expect_within_bounds(seen, drive, stated[0]);
  }
};

TEST_F(ModesOfADrive, BeginAtTheirInstantsWithinTheirBounds) {
  drive_for(StrategyKind::kTt, 5'500, 1);
  drive_for(StrategyKind::kAdva, 5'500, 2);
}

TEST_F(ModesOfADrive, TheSameInAWholeDriveWithManySeeds) {
  for (std::uint64_t seed = 3; seed < 8; ++seed) drive_for(StrategyKind::kAdva, 14'000, seed);
}

std::string refused(const std::string& rows) {
  std::string text = read_file(shipped(kDrive));
  const std::string row = "    - {mode: AaBaCa, regions: [camera_a]}\n";
  text.replace(text.find(row), row.size(), rows);
  for (const std::string path : {"../schedules/"})
    for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path))
      text.replace(at, path.size(), shipped("schedules/"));
  return support::refusal_of(
      [&] { check_tasks(parse_scenario(text, "modes.yaml"), Drive(kDrive, StrategyKind::kTt).cluster); }, "taken");
}

TEST(ModesOfAScenario, AreThoseOfTheDetectorAndItsCameras) {
  EXPECT_EQ(refused("    - {mode: AaBaCa}\n"), "taken");
  EXPECT_THAT(refused("    - {mode: AaBCa, regions: [camera_a]}\n"),
              HasSubstr("adaptive_camera.modes.mode = AaBCa: must be a mode of the detector of "));
  EXPECT_THAT(refused("    - {mode: AaBCa, regions: [camera_a]}\n"), HasSubstr(": ABC or AaBaCa"));
  EXPECT_THAT(refused("    - {mode: ABC, regions: [camera_d]}\n"),
              HasSubstr("adaptive_camera.modes.regions = camera_d: must be cameras of the detector of "));
  try {
    check_tasks(load_scenario(shipped(kDrive)),
                schedules::file::load_cluster(shipped("schedules/adaptive_loop_synchronised.yaml")));
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("adaptive_camera.modes.mode = ABC: must be absent: the detector of "));
  }
  Scenario slow = load_scenario(shipped(kDrive));
  slow.adaptive_camera.hardware_factor = 0.3;
  try {
    check_tasks(slow, Drive(kDrive, StrategyKind::kTt).cluster);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("modes.ABC.detections[0].lasts = 59 ms: must be at least 69.45 ms: a whole "
                                        "picture takes that by adaptive_camera.picture_time"));
  }
}

}  // namespace
}  // namespace ttf::sim::drives::ages
