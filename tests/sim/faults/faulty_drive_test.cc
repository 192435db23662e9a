// Faults in a whole drive: nodes with their tasks, not controllers alone.
#include <gtest/gtest.h>

#include <map>

#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::faults {
namespace {

using sim::drives::Drive;
using ttf::faults::FaultKind;

// The drive as a number: frames as they left, tasks, problems and images, without the faults' records.
struct Sum final : recording::records::Sink {
  using recording::records::Sink::on;
  std::uint64_t sum = 0xcbf29ce484222325;
  std::uint64_t frames = 0, images = 0;
  std::map<std::string, std::uint64_t> acts;
  std::map<bus::controller::SlotStatus, std::uint64_t> problems;  // by bit of their status
  std::map<int, std::uint64_t> empty;                             // by slot: no frame in it

  void on(const recording::records::SlotFrameSent& frame) override {
    ++frames;
    add(frame.stamp.true_time.ns);
    for (const std::byte byte : frame.bytes) add(static_cast<std::int64_t>(byte));
  }
  void on(const recording::records::TaskRun& run) override { add(run.end.true_time.ns), add(run.task); }
  void on(const recording::records::SlotProblem& problem) override {
    add(problem.stamp.true_time.ns), add(static_cast<std::int64_t>(problem.status));
    if (has(problem.status, bus::controller::kNoFrame)) ++empty[problem.slot];
    using enum recording::records::SlotStatus;
    for (const auto bit :
         {kSyntaxError, kContentError, kBoundaryViolation, kTransmissionConflict, kNoFrame, kUnexpectedFrame})
      problems[bit] += has(problem.status, bit) ? 1 : 0;
  }
  void on(const recording::records::ImageWritten& image) override { ++images, add(image.valid_at.ns); }
  void on(const recording::records::FaultActivity& activity) override {
    if (activity.what == recording::records::FaultAct::kActs) ++acts[std::string(activity.kind)];
  }

 private:
  void add(std::int64_t value) { sum = (sum ^ static_cast<std::uint64_t>(value)) * 0x100000001b3; }
};

class FaultyDrive : public testing::TestWithParam<fusion::strategies::StrategyKind> {};

TEST_P(FaultyDrive, TheShippedOneRunsToItsEndAndEveryFaultActs) {
  const Drive drive("scenarios/faulty_bus.yaml", GetParam());
  Sum sum;
  const sim::drives::DriveOutcome outcome = drive.run(sum);
  ASSERT_EQ(outcome.faults.size(), drive.scenario.faults.faults.size());
  for (std::size_t i = 0; i < outcome.faults.size(); ++i) {
    const ttf::faults::Fault& fault = drive.scenario.faults.faults[i];
    EXPECT_GT(outcome.faults[i].times, 0U) << ttf::faults::name_of(fault.kind);
    EXPECT_GE(outcome.faults[i].first, engine::kFirstCycle + fault.from) << ttf::faults::name_of(fault.kind);
    EXPECT_EQ(sum.acts[std::string(ttf::faults::name_of(fault.kind))], outcome.faults[i].times);
  }
  using enum recording::records::SlotStatus;
  for (const auto status : {kSyntaxError, kBoundaryViolation, kTransmissionConflict, kNoFrame})
    EXPECT_GT(sum.problems[status], 0U) << to_text(status);
  // The camera's host: 200 ms and the time of integration, on two channels, at four receivers.
  const int slot = drive.cluster.node(*drive.cluster.find_node("camera_pre")).flexray->pKeySlotId;
  EXPECT_GE(sum.empty[slot], 40U * 2 * 4);
  EXPECT_GT(sum.images, 70U) << "one every 40 ms, whatever happens";
}

TEST_P(FaultyDrive, TheSameSeedGivesTheSameDriveAndAnotherOneAnother) {
  const Drive drive("scenarios/faulty_bus.yaml", GetParam());
  Sum one, again, other;
  drive.run(one, 3);
  drive.run(again, 3);
  drive.run(other, 4);
  EXPECT_EQ(one.sum, again.sum);
  EXPECT_EQ(one.acts, again.acts);
  EXPECT_NE(one.sum, other.sum);
}

TEST_P(FaultyDrive, FaultsThatNeverActChangeNothing) {
  const Drive without("scenarios/paper_scenario1.yaml", GetParam());
  Drive with = without;
  ttf::faults::Fault fault;
  fault.kind = FaultKind::kOmission;
  fault.node_name = "gateway";
  fault.probability = 0.0;
  with.scenario.faults.faults = {fault};
  Sum here, there;
  without.run(here);
  with.run(there);
  EXPECT_EQ(here.sum, there.sum);
  EXPECT_GT(here.frames, 1'000U);
  EXPECT_TRUE(there.acts.empty());
}

TEST_P(FaultyDrive, ANodeRunsOnTheScheduleThatItBelievesIn) {
  Drive drive("scenarios/paper_scenario1.yaml", GetParam());
  drive.scenario.duration = Duration::milliseconds(200);
  ttf::faults::Fault fault;
  fault.kind = FaultKind::kWrongSchedule;
  fault.wrong = ttf::faults::WrongSchedule::kPayloadLength;
  fault.by = 1;
  fault.node_name = "gateway";
  drive.scenario.faults.faults = {fault};
  Sum sum;
  const sim::drives::DriveOutcome outcome = drive.run(sum);
  EXPECT_GT(outcome.faults[0].times, 100U);
  EXPECT_GT(sum.problems[bus::controller::kContentError], 100U);
}

TEST_P(FaultyDrive, NamesThatTheClusterHasNotAreRefusedBeforeAnythingRuns) {
  Drive drive("scenarios/paper_scenario1.yaml", GetParam());
  ttf::faults::Fault fault;
  fault.kind = FaultKind::kCrash;
  fault.node_name = "radar";
  fault.line = 30;
  drive.scenario.faults = {drive.scenario.file, {fault}};
  Sum sum;
  EXPECT_THROW(drive.run(sum), InputError);
  EXPECT_EQ(sum.frames, 0U);
}

INSTANTIATE_TEST_SUITE_P(Strategies, FaultyDrive, testing::ValuesIn(fusion::strategies::kAllStrategies),
                         [](const auto& strategy) { return std::string(name_of(strategy.param)); });

}  // namespace
}  // namespace ttf::sim::faults
