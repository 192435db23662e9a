#include "cli/supervision/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>

#include "cli/supervision/control.h"
#include "tests/cli/supervision/launch_fixture.h"

namespace ttf::cli::supervision {
namespace {

class ChildProcess : public Launching {
 protected:
  // All that it prints, to its end.
  static std::string all_output(Child& child) {
    std::string all;
    while (child.output_fd() >= 0) {
      pollfd watched{child.output_fd(), POLLIN, 0};
      poll(&watched, 1, -1);
      all += child.read_output(65'536);
    }
    return all;
  }
  static Ending end_of(Child& child) {
    pollfd watched{child.process_fd(), POLLIN, 0};
    poll(&watched, 1, -1);
    const auto ending = child.reap();
    EXPECT_TRUE(ending.has_value());
    return ending.value_or(Ending{});
  }
  static bool over(const Child& child) {
    pollfd watched{child.process_fd(), POLLIN, 0};
    return poll(&watched, 1, 0) > 0;
  }
  static std::optional<std::string> next_message(Child& child) {
    pollfd watched{child.control_fd(), POLLIN, 0};
    if (child.control_fd() >= 0) poll(&watched, 1, -1);
    return child.read_control();
  }
};

TEST_F(ChildProcess, HasARawTerminalAndASessionOfItsOwn) {
  auto command = child({"where"});
  command.environment = {{"MOOD", "good"}};
  const Descriptor leak(open("/dev/null", O_RDONLY));  // inheritable
  Child process(command);
  EXPECT_EQ(all_output(process),
            "input from nothing: yes\noutput on a terminal: yes\nraw: yes\nleads its session and group: yes\n"
            "no colour: 1\nmood: good\nother descriptors: 0\n");
  EXPECT_TRUE(end_of(process).success());
}

TEST_F(ChildProcess, PrintsAllBytesUnchanged) {
  std::string bytes, hex;
  for (int i = 0; i < 256; ++i) {
    bytes += static_cast<char>(i);
    hex += fmt::format("{:02x}", i);
  }
  Child process(child({"print:" + hex}));
  EXPECT_EQ(all_output(process), bytes);
}

TEST_F(ChildProcess, ReportsHowItEnded) {
  for (const int code : {0, 1, 3, 255}) {
    Child process(child({"exit:" + std::to_string(code)}));
    const Ending ending = end_of(process);
    EXPECT_FALSE(ending.by_signal);
    EXPECT_EQ(ending.exit_code(), code);
    EXPECT_EQ(ending.success(), code == 0);
    EXPECT_EQ(ending.text(), "exit " + std::to_string(code));
    EXPECT_EQ(process.reap(), std::nullopt);  // once
  }
  Child process(child({"raise:9"}));
  const Ending ending = end_of(process);
  EXPECT_TRUE(ending.by_signal);
  EXPECT_EQ(ending.exit_code(), 137);
  EXPECT_EQ(ending.text(), "signal 9 (Killed)");
  EXPECT_TRUE(has_no_children());
}

TEST_F(ChildProcess, SaysWhyItDoesNotRun) {
  std::ofstream(path("text")) << "no program\n";
  for (const auto& [program, code, why] :
       {std::tuple{path("absent"), 127, "No such file or directory"}, {path("text"), 126, "Permission denied"}}) {
    try {
      Child process({{program}, {}});
      ADD_FAILURE() << program << " runs";
    } catch (const StartFailure& failure) {
      EXPECT_EQ(failure.ending().exit_code(), code);
      EXPECT_EQ(failure.what(), program + ": cannot be started: " + why);
    }
  }
  EXPECT_TRUE(has_no_children());
}

TEST_F(ChildProcess, SpeaksOnItsControlLine) {
  Child process(child({"ready", "tell:{\"health\":{}}", "start", "exit:0"}));
  EXPECT_EQ(next_message(process), "{\"ready\":true}");
  EXPECT_EQ(next_message(process), "{\"health\":{}}");
  EXPECT_TRUE(process.send_control("{\"later\":1}"));  // unknown here, so it is skipped
  EXPECT_TRUE(process.send_control("{\"start\":{\"at\":5}}"));
  EXPECT_EQ(all_output(process), "start {\"at\":5}\n");
  EXPECT_EQ(next_message(process), std::nullopt);
  EXPECT_EQ(process.control_fd(), -1);
  EXPECT_FALSE(process.send_control("{}"));
  EXPECT_TRUE(end_of(process).success());
}

TEST_F(ChildProcess, LineIsOnlyWhereASupervisorIs) {
  unsetenv("TTF_CONTROL_FD");
  EXPECT_FALSE(ControlLine::from_environment().has_value());
  for (const char* const wrong : {"", "x", "-1", "1x", "9999", "0"}) {
    setenv("TTF_CONTROL_FD", wrong, 1);
    EXPECT_THROW((void)ControlLine::from_environment(), std::runtime_error) << wrong;
  }
  unsetenv("TTF_CONTROL_FD");
}

// A child that has only redirected its output is not hung up on.
TEST_F(ChildProcess, MayCloseItsOutput) {
  Child process({{"/bin/sh", "-c", "exec >/dev/null 2>&1; kill -STOP $$; exit 4"}, {}});
  EXPECT_EQ(all_output(process), "");
  EXPECT_TRUE(eventually([&] {
    process.signal_group(SIGCONT);
    return over(process);
  }));
  EXPECT_EQ(end_of(process).text(), "exit 4");
}

TEST_F(ChildProcess, TakesItsDescendantsWithIt) {
  Child process(child({"descend:" + path("grandchild"), "exit:0"}));
  EXPECT_TRUE(eventually([&] { return std::filesystem::exists(path("grandchild")) || over(process); }));
  EXPECT_TRUE(end_of(process).success());
  // It may have been killed before it could even leave its number.
  if (const pid_t grandchild = number_in(path("grandchild")); grandchild > 0) {
    EXPECT_TRUE(eventually([&] { return is_gone(grandchild); }));
  }
}

TEST_F(ChildProcess, IsKilledWithItsObject) {
  pid_t pid = 0, grandchild = 0;
  {
    Child process(child({"ignore:2", "ignore:15", "ignore:1", "descend:" + path("grandchild"), "wait"}));
    EXPECT_TRUE(eventually([&] { return std::filesystem::exists(path("grandchild")); }));
    pid = process.pid();
    grandchild = number_in(path("grandchild"));
  }
  EXPECT_TRUE(has_no_children());
  EXPECT_TRUE(is_gone(pid));
  ASSERT_GT(grandchild, 0);
  EXPECT_TRUE(eventually([&] { return is_gone(grandchild); }));
}

// It ignores and blocks no signals, even when its parent does.
TEST_F(ChildProcess, TakesSignalsWhateverItsParentDoes) {
  const SignalWatch blocked;
  signal(SIGUSR1, SIG_IGN);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGPIPE}) {
    Child process(child({"raise:" + std::to_string(number), "exit:0"}));
    EXPECT_EQ(end_of(process).exit_code(), 128 + number);
  }
  signal(SIGUSR1, SIG_DFL);
}

}  // namespace
}  // namespace ttf::cli::supervision
