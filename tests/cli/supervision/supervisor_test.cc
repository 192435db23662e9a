// Policies, output and exit codes. How a launch is stopped: supervisor_stop_test.cc; who is late for its barrier: barrier_test.cc.
#include "cli/supervision/supervisor.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <optional>

#include "cli/supervision/control.h"
#include "tests/cli/supervision/launch_fixture.h"

namespace ttf::cli::supervision {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

constexpr Duration kSoon = Duration::milliseconds(1);

TEST_F(Supervising, ANodeSetFromStartToEnd) {
  std::vector<std::string> events;
  Hooks hooks;
  hooks.on_all_ready = [&] {
    events.emplace_back("all ready");
    return json{{"at", 17}};
  };
  hooks.on_health = [&](std::size_t node, const json& facts) {
    events.push_back(fmt::format("{} health {}", node, facts.dump()));
  };
  hooks.on_done = [&](std::size_t node, const json& facts) {
    events.push_back(fmt::format("{} done {}", node, facts.dump()));
  };
  hooks.on_gone = [&](std::size_t node, const Ending& ending, bool back) {
    events.push_back(fmt::format("{} {}{}", node, ending.text(), back ? " comes back" : ""));
  };
  const auto outcome =
      run(config({{"fusion", Policy::kRequired,
                   child({"ready", "start", "tell:{\"health\":{\"drops\":2}}", "tell:{\"done\":{\"frames\":3}}"})}}),
          hooks);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.why, "");
  EXPECT_THAT(events, testing::ElementsAre("all ready", "0 health {\"drops\":2}", "0 done {\"frames\":3}", "0 exit 0"));
  EXPECT_THAT(shown(), testing::StartsWith(
                           "launch | all nodes are ready\nfusion | start {\"at\":17}\nlaunch | fusion: exit 0\n"));
  EXPECT_EQ(health_[0]["drops"], 2);
  EXPECT_EQ(health_[0]["process"], "exit 0");
}

// A device in place of a node: the others do not wait for it, and the hooks report it.
TEST_F(Supervising, AnExternalNodeIsListenedTo) {
  Hooks hooks;
  int received = 0;
  hooks.listen = [&] { ++received; };
  hooks.external = [&](std::size_t node) {
    EXPECT_EQ(node, 1u);
    return ExternalHealth{received > 0, received > 0, "sending, 3 in window", 2};
  };
  NodeSpec device{"device", Policy::kRequired, {}, true};
  EXPECT_EQ(run(config({{"fusion", Policy::kRequired, child({"ready", "start"})}, device}), hooks).exit_code, 0);
  EXPECT_GE(received, 1);
  EXPECT_THAT(shown(), HasSubstr("launch | device: sending, 3 in window\n"));
  EXPECT_EQ(health_[1]["process"], "sending, 3 in window");
  EXPECT_EQ(health_[1]["missed_slots"], 2);
  EXPECT_EQ(health_[1]["restarts"], 0);
}

TEST_F(Supervising, AnExternalNodeThatNeverSendsFailsTheLaunch) {
  for (const Policy policy : {Policy::kRequired, Policy::kOptional}) {
    const auto outcome =
        run(config({{"fusion", Policy::kRequired, child({"ready", "start"})}, {"device", policy, {}, true}}));
    EXPECT_EQ(outcome.exit_code, policy == Policy::kRequired ? 1 : 0);
    EXPECT_EQ(outcome.why, policy == Policy::kRequired ? "nothing was heard of device" : "");
    EXPECT_EQ(health_[1]["process"], "waiting");
  }
}

// The timeout begins with the start.
TEST_F(Supervising, AnExternalNodeIsNotAwaitedForEver) {
  auto given = config({{"fusion", Policy::kRequired, child({"ready", "start", "wait"})},
                       {"device", Policy::kRequired, {}, true},
                       {"other", Policy::kOptional, {}, true}});
  given.silence_timeout = kSoon;
  const auto outcome = run(std::move(given));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.why, "nothing was heard within 0.001 s of device");
}

// A ready process waits for the last one.
TEST_F(Supervising, NobodyStartsBeforeAllAreReady) {
  Hooks hooks;
  hooks.on_all_ready = [&] {
    EXPECT_EQ(std::filesystem::file_size(path("late")), 1u);
    return json::object();
  };
  EXPECT_EQ(run(config({{"a", Policy::kRequired, child({"ready", "start"})},
                        {"late", Policy::kRequired, child({"try:" + path("late") + ":1", "ready", "start"})},
                        {"c", Policy::kRequired, child({"ready", "start"})}}),
                hooks)
                .exit_code,
            0);
}

TEST_F(Supervising, ARequiredOnesFailureStopsAllAndIsTheExitCode) {
  const auto outcome = run(config({{"sensor", Policy::kRequired, child({"ready", "wait"})},
                                   {"fusion", Policy::kRequired, child({"ready", "start", "exit:3"})},
                                   {"feature", Policy::kOptional, child({"ready", "wait"})}}));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.why, "fusion: exit 3");
  EXPECT_THAT(shown(), HasSubstr("stopping: fusion: exit 3\n"));
  EXPECT_THAT(shown(), HasSubstr("sensor: signal 2 (Interrupt)\n"));
  EXPECT_THAT(shown(), HasSubstr("feature: signal 2 (Interrupt)\n"));
  EXPECT_THAT(shown(), HasSubstr("launch  | ended: fusion: exit 3\n"));
}

TEST_F(Supervising, ASignalIs128More) {
  EXPECT_EQ(run(config({{"fusion", Policy::kRequired, child({"ready", "start", "raise:10"})}})).exit_code, 138);
  EXPECT_THAT(shown(), HasSubstr("fusion: signal 10 (User defined signal 1)\n"));
}

// The one that fails while all are being stopped is not the first.
TEST_F(Supervising, TheFirstFailureCounts) {
  EXPECT_EQ(run(config({{"second", Policy::kRequired, child({"on:2:5", "ready", "wait"})},
                        {"first", Policy::kRequired, child({"ready", "start", "exit:4"})}}))
                .exit_code,
            4);
  EXPECT_THAT(shown(), HasSubstr("second: exit 5\n"));
}

TEST_F(Supervising, EndingBeforeBeingReadyIsAFailure) {
  const auto outcome = run(config(
      {{"fusion", Policy::kRequired, child({"exit:0"})}, {"other", Policy::kRequired, child({"ready", "wait"})}}));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.why, "fusion: exit 0, before it was ready");
}

// A library may end a node's process by _exit(0).
TEST_F(Supervising, EndingWithoutItsResultIsAFailureWhereOneIsDue) {
  for (const bool due : {false, true}) {
    std::optional<Ending> last;
    Hooks hooks;
    hooks.on_gone = [&](std::size_t, const Ending& ending, bool) { last = ending; };
    auto given = config({{"gateway", Policy::kRequired, child({"ready", "start"})}});
    given.results_due = due;
    const auto outcome = run(std::move(given), hooks);
    EXPECT_EQ(outcome.exit_code, due ? 1 : 0);
    EXPECT_EQ(outcome.why, due ? "gateway: exit 0 without its result" : "");
    EXPECT_EQ(health_[0]["process"], due ? "exit 0 without its result" : "exit 0");
    ASSERT_TRUE(last);
    EXPECT_EQ(last->success(), !due);
  }
}

// Each process owes its own: the first one's does not count for the second.
TEST_F(Supervising, ARestartedOneOwesItsResultAnew) {
  const std::string two = "[ -e " + path("tried") + " ] && exec " TTF_LAUNCH_CHILD " ready start; >" + path("tried") +
                          "; exec " TTF_LAUNCH_CHILD " ready start 'tell:{\"done\":{}}' exit:3";
  auto given = config({{"gateway", Policy::kRestart, {{"/bin/sh", "-c", two}, {}}}});
  given.results_due = true;
  given.restart = {kSoon, kSoon, 1, kNever};
  EXPECT_EQ(run(std::move(given)).why, "gateway: exit 0 without its result");
  EXPECT_EQ(health_[0]["restarts"], 1);
}

TEST_F(Supervising, ReadyAndGoneAtOnceIsNone) {
  EXPECT_EQ(run(config({{"brief", Policy::kRequired, child({"ready", "exit:0"})},
                        {"fusion", Policy::kRequired, child({"ready", "start"})}}))
                .exit_code,
            0);
  EXPECT_EQ(health_[0]["process"], "exit 0");
}

TEST_F(Supervising, AnOptionalOnesFailureIsOnlySaid) {
  EXPECT_EQ(run(config({{"fusion", Policy::kRequired, child({"ready", "start"})},
                        {"feature", Policy::kOptional, child({"exit:9"})},
                        {"absent", Policy::kOptional, {{path("absent")}, {}}}}))
                .exit_code,
            0);
  EXPECT_THAT(shown(), HasSubstr("feature: exit 9\n"));
  EXPECT_THAT(shown(), HasSubstr("absent: " + path("absent") + ": cannot be started: No such file or directory\n"));
}

TEST_F(Supervising, RestartsUntilItSucceeds) {
  std::vector<bool> comes_back;
  Hooks hooks;
  hooks.on_gone = [&](std::size_t node, const Ending&, bool back) {
    if (node == 0) comes_back.push_back(back);
  };
  auto given = config({{"sensor", Policy::kRestart, child({"try:" + path("tries") + ":3", "ready", "start"})},
                       {"fusion", Policy::kRequired, child({"ready", "start"})}});
  given.restart = {kSoon, kSoon * 10, 5, kNever};
  EXPECT_EQ(run(std::move(given), hooks).exit_code, 0);
  EXPECT_EQ(std::filesystem::file_size(path("tries")), 3u);
  EXPECT_EQ(comes_back, (std::vector<bool>{true, true, false}));
  EXPECT_THAT(shown(), HasSubstr("sensor: exit 7; restart 1 of 5 in 0.001 s\n"));
  EXPECT_THAT(shown(), HasSubstr("sensor: exit 7; restart 2 of 5 in 0.002 s\n"));
}

TEST_F(Supervising, ARestartedOneReceivesThePresentState) {
  Hooks hooks;
  hooks.on_all_ready = [] { return json{{"cycle", 0}}; };
  hooks.on_late_ready = [](std::size_t) { return json{{"cycle", 90}}; };
  auto given = config({{"sensor",
                        Policy::kRestart,
                        {{"/bin/sh", "-c",
                          "if [ -e " + path("once") + " ]; then exec " TTF_LAUNCH_CHILD " ready start; fi; touch " +
                              path("once") + "; exec " TTF_LAUNCH_CHILD " ready start raise:6"},
                         {}}}});
  given.restart = {kSoon, kSoon, 1, kNever};
  EXPECT_EQ(run(std::move(given), hooks).exit_code, 0);
  EXPECT_THAT(shown(),
              HasSubstr("sensor | start {\"cycle\":0}\nlaunch | sensor: signal 6 (Aborted); restart 1 of 1 in 0.001 s\n"
                        "sensor | start {\"cycle\":90}\nlaunch | sensor: exit 0\n"));
}

TEST_F(Supervising, GivesUpRestartingAsIfRequired) {
  auto given = config({{"sensor", Policy::kRestart, child({"ready", "start", "raise:6"})},
                       {"fusion", Policy::kRequired, child({"ready", "start", "wait"})}});
  given.restart = {kSoon, kSoon, 2, kNever};
  const auto outcome = run(std::move(given));
  EXPECT_EQ(outcome.exit_code, 134);
  EXPECT_EQ(outcome.why, "sensor: signal 6 (Aborted)");
}

TEST_F(Supervising, AProgramThatIsNotThereIsAShells127) {
  const auto outcome = run(
      config({{"fusion", Policy::kRequired, {{path("absent")}, {}}}, {"later", Policy::kRequired, child({"wait"})}}));
  EXPECT_EQ(outcome.exit_code, 127);
  EXPECT_EQ(health_[1]["process"], "not started");
}

TEST_F(Supervising, PrefixesLinesAndEscapesJunk) {
  // "whole\n" "a\tb\x1b[31mred\xff\n" "held back", the last without a newline
  EXPECT_EQ(run(config({{"a", Policy::kRequired,
                         child({"print:77686f6c650a6109621b5b33316d726564ff0a68656c64206261636b", "ready"})},
                        {"longer_name", Policy::kRequired, child({"ready"})}}))
                .exit_code,
            0);
  std::string of_a;
  std::string line;
  for (std::istringstream lines(shown()); std::getline(lines, line);)
    if (line.starts_with("a ") && line.find('|') != std::string::npos) of_a += line + '\n';
  EXPECT_EQ(of_a,
            "a           | whole\n"
            "a           | a\tb\\x1b[31mred\\xff\n"
            "a           | held back\n");
}

TEST_F(Supervising, TimeStampsEveryLine) {
  auto given = config({{"a", Policy::kRequired, child({"print:780a", "ready"})}});
  EXPECT_EQ(run(std::move(given)).exit_code, 0);
  std::string bytes(4096, '\0');
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(pread(screen_, bytes.data(), bytes.size(), 0), 0)));
  EXPECT_THAT(bytes.substr(0, bytes.find('\n')), MatchesRegex("   [0-9]\\.[0-9][0-9][0-9] a      \\| x"));
}

TEST_F(Supervising, AFloodWithoutNewlineIsShownInPieces) {
  LaunchFolder folder(path("run"), json::object(), std::chrono::system_clock::now());
  auto given = config({{"a", Policy::kRequired, child({"flood:300000", "ready"})}});
  given.folder = &folder;
  EXPECT_EQ(run(std::move(given)).exit_code, 0);
  const std::string text = shown();
  std::ptrdiff_t count = 0;
  std::string line;
  for (std::istringstream lines(text); std::getline(lines, line);)
    if (line.starts_with("a      | ")) count += std::ranges::count(line, 'x');
  EXPECT_EQ(count, 300'000);
  EXPECT_THAT(text, HasSubstr("a      | " + std::string(kLongestLine, 'x') + " [...]\n"));
  EXPECT_EQ(contents(path("run/a.txt")), std::string(300'000, 'x'));
}

TEST_F(Supervising, LeavesAFolderWithAllFacts) {
  LaunchFolder folder(path("run"), {{"scenario", "s.yaml"}}, std::chrono::system_clock::now());
  auto given =
      config({{"sensor", Policy::kRestart, child({"try:" + path("tries") + ":2", "print:ff0a", "ready", "start"})},
              {"fusion", Policy::kRequired, child({"ready", "start", "tell:{\"health\":{\"drops\":5}}", "raise:9"})}});
  given.folder = &folder;
  given.restart = {kSoon, kSoon, 5, kNever};
  EXPECT_EQ(run(std::move(given)).exit_code, 137);
  const json manifest = json::parse(contents(path("run/manifest.json")));
  EXPECT_EQ(manifest["scenario"], "s.yaml");
  EXPECT_EQ(manifest["state"], "ended");
  EXPECT_EQ(manifest["exit_code"], 137);
  EXPECT_EQ(manifest["why"], "fusion: signal 9 (Killed)");
  EXPECT_EQ(manifest["health"][1]["drops"], 5);
  const json& sensor = manifest["nodes"][0];
  EXPECT_EQ(sensor["policy"], "restart");
  ASSERT_EQ(sensor["processes"].size(), 2u);
  EXPECT_EQ(sensor["processes"][0]["exit"], 7);
  EXPECT_NE(sensor["processes"][0]["pid"], sensor["processes"][1]["pid"]);
  EXPECT_EQ(manifest["nodes"][1]["processes"][0]["signal"], 9);
  for (const json& node : manifest["nodes"])
    for (const json& process : node["processes"])
      EXPECT_TRUE(process["began"].is_string() && process["ended"].is_string());
  EXPECT_EQ(contents(path("run/sensor.txt")).substr(0, 2), "\xff\n");
  EXPECT_THAT(contents(path("run/launch.log")), HasSubstr("sensor | \\xff\n"));
  EXPECT_THAT(contents(path("run/launch.log")), HasSubstr("ended: fusion: signal 9 (Killed)\n"));
}

TEST_F(Supervising, SaysWhatItDoesNotUnderstand) {
  const std::string long_text(kLongestMessage + 10, 'x');
  EXPECT_EQ(run(config({{"a", Policy::kRequired,
                         child({"tell:nonsense", "tell:[1]", "tell:" + long_text, "tell:{\"health\":{\"drops\":-1}}",
                                "tell:{\"ready\":1}", "tell:{\"novelty\":1}", "ready", "ready"})}}))
                .exit_code,
            0);
  const std::string left_out = "launch | a: sent an invalid message, which is ignored: ";
  EXPECT_THAT(shown(), HasSubstr(left_out + "not a JSON object\n" + left_out + "not a JSON object\n" + left_out +
                                 "too long\n" + left_out + "health.drops: must be a whole number from 0\n"));
}

TEST_F(Supervising, AThrowingHookEndsTheLaunch) {
  Hooks hooks;
  hooks.on_all_ready = []() -> json { throw std::runtime_error("the medium is lost"); };
  const auto outcome = run(config({{"a", Policy::kRequired, child({"ready", "start"})}}), hooks);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.why, "the medium is lost");
  EXPECT_THAT(shown(), Not(HasSubstr("a      | start")));
}

// On a capable terminal: colours, and the table in place while the nodes run, not only at the end.
// A child that lives until three statuses have reported its health, however slow the machine is.
class Shown : public Supervising {
 protected:
  SupervisorConfig lingering() const {
    return config({{"a",
                    Policy::kRequired,
                    {{"/bin/sh", "-c",
                      TTF_LAUNCH_CHILD " ready start 'tell:{\"health\":{\"drops\":77}}'; until [ -e " + path("enough") +
                          " ]; do sleep 0.02; done"},
                     {}}}});
  }
  // `before` is called before each status.
  Hooks counted(std::function<void()> before) {
    Hooks hooks;
    hooks.on_health = [this](std::size_t, const json&) { reported_ = 0; };
    hooks.status = [this, before] {
      before();
      if (reported_ && ++*reported_ == 3) std::ofstream(path("enough")) << "x";
      return "3 of 4 s";
    };
    return hooks;
  }

 private:
  std::optional<int> reported_;  // statuses since the health came
};

TEST_F(Shown, OnATerminalTheTableIsInPlace) {
  const Descriptor terminal(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK));
  ASSERT_TRUE(terminal.open() && unlockpt(terminal.get()) == 0);
  const Descriptor screen(ioctl(terminal.get(), TIOCGPTPEER, O_RDWR | O_NOCTTY));
  ASSERT_TRUE(screen.open());
  unsetenv("NO_COLOR");
  setenv("TERM", "xterm", 1);  // a test runner may have none, or a dumb one
  auto given = lingering();
  given.screen = screen.get();
  given.status_every = Duration::milliseconds(100);
  const winsize size{50, 90, 0, 0};
  ASSERT_EQ(ioctl(screen.get(), TIOCSWINSZ, &size), 0);
  std::string text;
  const auto read_on = [&] {  // the terminal holds some tables only
    char bytes[4096];
    for (ssize_t got = 0; (got = read(terminal.get(), bytes, sizeof bytes)) > 0;)
      text.append(bytes, static_cast<std::size_t>(got));
  };
  EXPECT_EQ(run(std::move(given), counted(read_on)).exit_code, 0);
  read_on();
  // This terminal's line discipline is not raw. The status has a line for the launch, three of a head and one for the node.
  EXPECT_THAT(text, HasSubstr("\x1b[5A\x1b[J3 of 4 s: 1 of 1 nodes up\r\n"));
  EXPECT_THAT(text, HasSubstr(" 77 "));
  EXPECT_THAT(text, MatchesRegex(".*\x1b\\[5A\x1b\\[J[^\x1b]*exit 0 .*"));  // the last table is not in place
  EXPECT_THAT(text, HasSubstr(" a      |\x1b[0m start {}\r\n"));
}

TEST_F(Shown, ElsewhereALineOfWordsReportsTheHealth) {
  auto given = lingering();
  given.words_every = Duration::milliseconds(100);
  EXPECT_EQ(run(std::move(given), counted([] {})).exit_code, 0);
  EXPECT_THAT(shown(), HasSubstr("launch | 3 of 4 s: 1 of 1 nodes up; 0 late wake-ups, 0 slots missed, 77 drops\n"));
  EXPECT_THAT(shown(), Not(HasSubstr("\x1b")));
}

// Every descriptor at its end would keep an idle loop busy. The process lives on with its own terminal and
// control line closed.
TEST_F(Supervising, SleepsWhileNothingHappens) {
  const auto processor_ms = [] {
    timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return used.tv_sec * 1000 + used.tv_nsec / 1'000'000;
  };
  const auto before = processor_ms();
  EXPECT_EQ(run(config({{"a", Policy::kRequired, child({"ready", "start", "exit:0"})},
                        {"idle",
                         Policy::kOptional,
                         {{"/bin/bash", "-c",
                           TTF_LAUNCH_CHILD " ready; exec >/dev/null 2>&1; "
                                            "eval \"exec $TTF_CONTROL_FD>&-\"; sleep 2"},
                          {}}}}))
                .exit_code,
            0);
  EXPECT_LT(processor_ms() - before, 1000);  // an idle loop would take the two seconds
}

}  // namespace
}  // namespace ttf::cli::supervision
