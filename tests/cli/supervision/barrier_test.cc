// Nodes that are late for the barrier at the start. The others have little time, so these tests run by the wall clock.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "cli/supervision/supervisor.h"
#include "tests/cli/supervision/launch_fixture.h"

namespace ttf::cli::supervision {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr Duration kSoon = Duration::milliseconds(1);

using Barrier = Supervising;

TEST_F(Barrier, TheBarriersTimeoutNamesWhoIsMissing) {
  auto given = config({{"laser_pre", Policy::kRequired, child({"wait"})},
                       {"fusion", Policy::kRequired, child({"ready", "wait"})},
                       {"camera_pre", Policy::kRestart, child({"wait"})},
                       {"feature", Policy::kOptional, child({"wait"})}});
  given.ready_timeout = Duration::milliseconds(1500);
  Hooks hooks;
  hooks.on_all_ready = [] {
    ADD_FAILURE() << "not all are ready";
    return json::object();
  };
  const auto outcome = run(std::move(given), hooks);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.why, "nodes are not ready within 1.5 s: laser_pre, camera_pre");
  EXPECT_THAT(shown(), HasSubstr("launch     | stopping: nodes are not ready within 1.5 s: laser_pre, camera_pre\n"));
}

TEST_F(Barrier, OptionalOnesHoldUpNobodyBeyondTheBarrier) {
  auto given = config(
      {{"fusion", Policy::kRequired, child({"ready", "start"})}, {"feature", Policy::kOptional, child({"wait"})}});
  given.ready_timeout = Duration::milliseconds(200);
  given.optional_grace = kSoon;
  EXPECT_EQ(run(std::move(given)).exit_code, 0);
  EXPECT_THAT(shown(),
              HasSubstr("optional nodes are not ready within 0.2 s: feature; the others start\nfusion  | start {}\n"));
  EXPECT_THAT(shown(), HasSubstr("stopping: only optional nodes are left\nlaunch  | feature: signal 2 (Interrupt)\n"));
}

TEST_F(Barrier, ALateOptionalOneIsStartedAfterwards) {
  Hooks hooks;
  hooks.on_all_ready = [&] {
    std::ofstream(path("go")) << "x";
    return json{{"first", true}};
  };
  hooks.on_late_ready = [](std::size_t node) { return json{{"late", node}}; };
  const std::string wait_for_it =
      "until [ -e " + path("go") + " ]; do sleep 0.02; done; exec " TTF_LAUNCH_CHILD " ready start";
  auto given = config({{"feature", Policy::kOptional, {{"/bin/sh", "-c", wait_for_it}, {}}},
                       {"fusion", Policy::kRequired, child({"ready", "start"})}});
  given.ready_timeout = Duration::milliseconds(300);
  EXPECT_EQ(run(std::move(given), hooks).exit_code, 0);
  EXPECT_THAT(shown(), HasSubstr("fusion  | start {\"first\":true}\n"));
  EXPECT_THAT(shown(), HasSubstr("feature | start {\"late\":0}\n"));
}

}  // namespace
}  // namespace ttf::cli::supervision
