// Stopping a launch: all its processes end with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/supervision/supervisor.h"
#include "tests/cli/supervision/launch_fixture.h"

namespace ttf::cli::supervision {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

constexpr Duration kShort = Duration::milliseconds(50);

class Stopping : public Launching {
 protected:
  // Interrupted, as by Ctrl-C, as soon as all are ready.
  Outcome run_interrupted(SupervisorConfig given, Hooks hooks = {}, int signal = SIGINT) {
    hooks.on_all_ready = [signal] {
      kill(getpid(), signal);
      return json::object();
    };
    Supervisor supervisor(std::move(given), std::move(hooks));
    const Outcome outcome = supervisor.run();
    EXPECT_TRUE(has_no_children());
    return outcome;
  }
};

TEST_F(Stopping, InterruptsEverybody) {
  const auto outcome = run_interrupted(config({{"a", Policy::kRequired, child({"ready", "wait"})},
                                               {"b", Policy::kOptional, child({"on:2:0", "ready", "wait"})}}));
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_EQ(outcome.why, "interrupted (SIGINT)");
  EXPECT_THAT(shown(), HasSubstr("launch | stopping: interrupted (SIGINT)\n"));
  EXPECT_THAT(shown(), HasSubstr("a: signal 2 (Interrupt)\n"));
  EXPECT_THAT(shown(), HasSubstr("b: exit 0\n"));
  EXPECT_THAT(shown(), Not(HasSubstr("still running")));
}

TEST_F(Stopping, TakesOtherSignalsForTheSame) {
  for (const int signal : {SIGTERM, SIGHUP})
    EXPECT_EQ(run_interrupted(config({{"a", Policy::kRequired, child({"ready", "wait"})}}), {}, signal).exit_code,
              128 + signal);
  EXPECT_THAT(shown(), HasSubstr("stopping: SIGTERM\n"));
  EXPECT_THAT(shown(), HasSubstr("stopping: the terminal was closed (SIGHUP)\n"));
}

TEST_F(Stopping, TerminatesWhoIgnoresInterrupts) {
  auto given = config({{"deaf", Policy::kRequired, child({"ignore:2", "ready", "wait"})},
                       {"b", Policy::kRequired, child({"ready", "wait"})}});
  given.grace.interrupt = kShort;
  EXPECT_EQ(run_interrupted(std::move(given)).exit_code, 130);
  EXPECT_THAT(shown(), HasSubstr("still running, SIGTERM is sent: deaf\n"));
  EXPECT_THAT(shown(), HasSubstr("deaf: signal 15 (Terminated)\n"));
  EXPECT_THAT(shown(), Not(HasSubstr("SIGKILL")));
}

TEST_F(Stopping, KillsWhoIgnoresAll) {
  auto given = config({{"deaf", Policy::kRequired, child({"ignore:2", "ignore:15", "ready", "wait"})}});
  given.grace = {kShort, kShort};
  EXPECT_EQ(run_interrupted(std::move(given)).exit_code, 130);
  EXPECT_THAT(shown(), HasSubstr("still running, SIGTERM is sent: deaf\n"));
  EXPECT_THAT(shown(), HasSubstr("still running, SIGKILL is sent: deaf\n"));
  EXPECT_THAT(shown(), HasSubstr("deaf: signal 9 (Killed)\n"));
}

// The graces are an hour here: only another interrupt gets further.
TEST_F(Stopping, AnotherInterruptHurries) {
  std::vector<std::string> asked;
  Hooks hooks;
  hooks.on_health = [&](std::size_t, const json& facts) {
    asked.push_back(facts["state"]);
    kill(getpid(), SIGINT);
  };
  EXPECT_EQ(
      run_interrupted(config({{"deaf", Policy::kRequired, child({"report:2", "report:15", "ready", "wait"})}}), hooks)
          .exit_code,
      130);
  EXPECT_THAT(asked, testing::ElementsAre("asked 2", "asked 15"));
  EXPECT_THAT(shown(), HasSubstr("deaf: signal 9 (Killed)\n"));
}

TEST_F(Stopping, WakesWhoIsStopped) {
  // On SIGCONT it finds SIGINT waiting.
  auto given = config({{"frozen", Policy::kRequired, child({"ready", "raise:19", "wait"})}});
  EXPECT_EQ(run_interrupted(std::move(given)).exit_code, 130);
  EXPECT_THAT(shown(), HasSubstr("frozen: signal 2 (Interrupt)\n"));
}

TEST_F(Stopping, AFailureOnTheWayOutIsSeen) {
  const auto outcome = run_interrupted(config({{"a", Policy::kRequired, child({"on:2:6", "ready", "wait"})}}));
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_EQ(outcome.why, "a: exit 6");
}

TEST_F(Stopping, NobodyIsRestartedOnTheWayOut) {
  auto given = config({{"a", Policy::kRestart, child({"on:2:6", "ready", "wait"})},
                       {"waiting", Policy::kRestart, child({"exit:1"})},
                       {"b", Policy::kRequired, child({"ready", "wait"})}});
  given.restart = {kNever, kNever, 5, kNever};
  given.ready_timeout = Duration::milliseconds(500);
  Supervisor supervisor(std::move(given), {});
  EXPECT_EQ(supervisor.run().exit_code, 1);
  EXPECT_TRUE(has_no_children());
  EXPECT_EQ(supervisor.health().json()[1]["process"], "not restarted");
  EXPECT_THAT(shown(), HasSubstr("stopping: nodes are not ready within 0.5 s: waiting\n"));
}

TEST_F(Stopping, CanBeAskedFor) {
  Supervisor* running = nullptr;
  Hooks hooks;
  hooks.on_health = [&](std::size_t, const json&) { running->request_stop("that is enough", 5); };
  Supervisor supervisor(config({{"a", Policy::kRequired, child({"ready", "start", "tell:{\"health\":{}}", "wait"})}}),
                        hooks);
  running = &supervisor;
  const Outcome outcome = supervisor.run();
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_EQ(outcome.why, "that is enough");
}

TEST_F(Stopping, TakesGrandchildrenAlong) {
  // One grandchild belongs to an interrupted node, one to a node that ended well before.
  const auto outcome = run_interrupted(
      config({{"a", Policy::kRequired, child({"descend:" + path("first"), "ready", "wait"})},
              {"b",
               Policy::kRequired,
               {{"/bin/sh", "-c",
                 TTF_LAUNCH_CHILD " descend:" + path("second") + " exit:0; until [ -e " + path("second") +
                     " ]; do sleep 0.02; done; exec " TTF_LAUNCH_CHILD " ready exit:0"},
                {}}}}));
  EXPECT_EQ(outcome.exit_code, 130);
  for (const char* const name : {"first", "second"}) {
    // The first may have been killed before it could leave its number.
    const pid_t pid = number_in(path(name));
    EXPECT_TRUE(pid <= 0 || eventually([&] { return is_gone(pid); })) << name;
  }
  EXPECT_GT(number_in(path("second")), 0);
}

TEST_F(Stopping, ManifestIsCompleteAllTheSame) {
  LaunchFolder folder(path("run"), json::object(), std::chrono::system_clock::now());
  auto given = config({{"a", Policy::kRequired, child({"ready", "wait"})}});
  given.folder = &folder;
  EXPECT_EQ(run_interrupted(std::move(given)).exit_code, 130);
  const json manifest = json::parse(contents(path("run/manifest.json")));
  EXPECT_EQ(manifest["state"], "ended");
  EXPECT_EQ(manifest["exit_code"], 130);
  EXPECT_EQ(manifest["nodes"][0]["processes"][0]["signal"], 2);
}

// The kernel kills the children, and hangs up on theirs.
TEST_F(Stopping, NobodyOutlivesAKilledSupervisor) {
  const pid_t supervisor = fork();
  if (supervisor == 0) {
    execl(TTF_LAUNCH_CHILD, TTF_LAUNCH_CHILD, ("supervise:" + folder_).c_str(), nullptr);
    _exit(99);
  }
  ASSERT_TRUE(eventually([&] { return number_in(path("child")) > 0 && number_in(path("grandchild")) > 0; }));
  const pid_t node = number_in(path("child")), grandchild = number_in(path("grandchild"));
  EXPECT_FALSE(is_gone(node));
  EXPECT_FALSE(is_gone(grandchild));
  kill(supervisor, SIGKILL);
  int status = 0;
  EXPECT_EQ(waitpid(supervisor, &status, 0), supervisor);
  EXPECT_TRUE(eventually([&] { return is_gone(node); }));
  EXPECT_TRUE(eventually([&] { return is_gone(grandchild); }));
}

// A second supervisor in the same process finds signals unchanged.
TEST_F(Stopping, LeavesSignalsAsTheyWere) {
  const auto disposition = [](int signal) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    return now.sa_handler;
  };
  sigset_t before, after;
  sigprocmask(SIG_SETMASK, nullptr, &before);
  const auto pipe_before = disposition(SIGPIPE);
  run_interrupted(config({{"a", Policy::kRequired, child({"ready", "wait"})}}));
  sigprocmask(SIG_SETMASK, nullptr, &after);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
    EXPECT_EQ(sigismember(&before, signal), sigismember(&after, signal));
  EXPECT_EQ(disposition(SIGPIPE), pipe_before);
}

}  // namespace
}  // namespace ttf::cli::supervision
