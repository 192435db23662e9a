// Recording frames or comparing clocks changes nothing else.
#include <gtest/gtest.h>

#include <type_traits>

#include "recording/records/tee.h"
#include "sim/drives/drive.h"
#include "tests/recording/record_text.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::processes {
namespace {

// Every record but those of FlexRay's frames, which are counted.
class Others final : public recording::records::Every<Others> {
 public:
  explicit Others(bool wants_frames) : wants_frames_(wants_frames) {}
  bool wants_frames() const override { return wants_frames_; }
  template <class Record> void each(const Record& record) {
    if constexpr (std::is_same_v<Record, recording::records::SlotFrameSent> ||
                  std::is_same_v<Record, recording::records::ChannelFrame>)
      ++frames;
    else
      text.on(record);
  }

  recording::TextSink text;
  int frames = 0;

 private:
  bool wants_frames_;
};

void compare(const sim::drives::Drive& drive) {
  const fusion::strategies::StrategyKind strategy = drive.strategy;
  const sim::drives::DriveConfig config{&drive.scenario, &drive.cluster, strategy, 3, 1, nullptr};
  Others all(true), others(false);
  const sim::drives::DriveOutcome with = run_drive(config, all), without = run_drive(config, others);
  EXPECT_GT(all.frames, 1000);
  EXPECT_EQ(others.frames, 0);
  ASSERT_EQ(all.text.lines.size(), others.text.lines.size());
  for (std::size_t line = 0; line < all.text.lines.size(); ++line)
    ASSERT_EQ(all.text.lines[line], others.text.lines[line]);
  EXPECT_EQ(with.frames_sent, without.frames_sent);
  EXPECT_EQ(with.flexray_load, without.flexray_load);
  EXPECT_EQ(with.counts.slot_problems, without.counts.slot_problems);
}

TEST(UnwantedFrames, LeaveAllOtherRecordsAsTheyAre) {
  for (const fusion::strategies::StrategyKind strategy : fusion::strategies::kAllStrategies)
    compare({"scenarios/paper_scenario1.yaml", strategy});
}

// Every cluster has a different mixture of slots that repeat, take turns, or have fragments of lists of many.
TEST(UnwantedFrames, OfEveryClusterLeaveAllOtherRecordsAsTheyAre) {
  for (const char* cluster : {"paper_dynamic", "paper_event_triggered", "paper_free_running", "flexray_demo"}) {
    sim::drives::Drive drive("scenarios/dynamics.yaml", fusion::strategies::StrategyKind::kAdva);
    drive.cluster = schedules::file::load_cluster(sim::drives::shipped("schedules/") + cluster + ".yaml");
    SCOPED_TRACE(cluster);
    compare(drive);
  }
  compare({"scenarios/twin_cameras.yaml", fusion::strategies::StrategyKind::kAdva});
  compare({"scenarios/crowd_25.yaml", fusion::strategies::StrategyKind::kTt});
}

// Nodes powered on later receive some of the frames under way, and all frames that are new to them.
TEST(UnwantedFrames, BelongToStartupLikeOthers) {
  compare({"scenarios/cold_start.yaml", fusion::strategies::StrategyKind::kAdva});
}

// Uncorrected clocks drift apart until frames cross the others' slots, and then collide.
TEST(UnwantedFrames, MayBeOutsideOfTheirSlots) {
  sim::drives::Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kAdva);
  drive.cluster.synchronisation = false;
  drive.scenario.duration = Duration::milliseconds(1500);
  compare(drive);
}

TEST(UnwantedFrames, AreStillSubjectToFaults) {
  for (const fusion::strategies::StrategyKind strategy : fusion::strategies::kAllStrategies)
    compare({"scenarios/faulty_bus.yaml", strategy});
}

// Every record but those of how far clocks are apart, which are counted.
class NotTheClocks final : public recording::records::Every<NotTheClocks> {
 public:
  template <class Record> void each(const Record& record) {
    if constexpr (std::is_same_v<Record, recording::records::PrecisionSample>)
      ++samples;
    else
      text.on(record);
  }

  recording::TextSink text;
  int samples = 0;
};

TEST(UncomparedClocks, LeaveAllOtherRecordsAsTheyAre) {
  for (const char* scenario :
       {"scenarios/paper_scenario1.yaml", "scenarios/cold_start.yaml", "scenarios/faulty_bus.yaml"}) {
    SCOPED_TRACE(scenario);
    const sim::drives::Drive drive(scenario, fusion::strategies::StrategyKind::kAdva);
    NotTheClocks compared, uncompared;
    const sim::drives::DriveOutcome with = drive.run(compared), without = drive.run(uncompared, 1, false);
    EXPECT_GT(compared.samples, 100);
    EXPECT_EQ(uncompared.samples, 0);
    EXPECT_EQ(compared.text.lines, uncompared.text.lines);
    EXPECT_GT(with.precision, Duration{});
    EXPECT_EQ(without.precision, Duration{});
    EXPECT_EQ(with.frames_sent, without.frames_sent);
  }
}

TEST(UnwantedFrames, AreThoseThatNoListenerWants) {
  Others some(true), none(false);
  EXPECT_TRUE(recording::records::Tee({&none, &some}).wants_frames());
  EXPECT_FALSE(recording::records::Tee({&none}).wants_frames());
}

}  // namespace
}  // namespace ttf::sim::processes
