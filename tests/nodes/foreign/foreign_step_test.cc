// A library's step: what it is handed, what is refused, and how its failures end.
#include "nodes/foreign/foreign_step.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cfenv>
#include <thread>

#include "core/errors.h"
#include "tests/nodes/foreign/one_task.h"

namespace ttf::nodes::foreign {
namespace {

using testing::HasSubstr;

constexpr const char* kPlace = "schedules/paper_synchronised.yaml:243: nodes.gateway.tasks.forward_laser.step = ";

std::string refusal(const std::string& library, const StepFolder* folder = &kSteps) {
  try {
    OneTask task(library, folder);
  } catch (const InputError& error) {
    return error.findings().front().sentence();
  }
  return "";
}

double some_value(int element, std::size_t signal) { return 0.25 * element + 0.125 * static_cast<double>(signal); }

TEST(ForeignStep, PassesAListOnBitByBit) {
  OneTask task("copy.so");
  task.run();
  EXPECT_FALSE(task.output().written()) << "no list has arrived";
  for (std::uint32_t k = 0; k < 3; ++k) {
    task.arrives(65'535 + k, static_cast<int>(7 * k), GlobalTime{40'000'000 + 1000 * k}, some_value);
    task.run();
    ASSERT_TRUE(task.output().written());
    const bus::cni::ListView sent = task.output().view(), source = task.source().view();
    EXPECT_EQ(sent.sequence, source.sequence);
    EXPECT_TRUE(std::ranges::equal(sent.bytes, source.bytes)) << k;
    task.run();
    EXPECT_FALSE(task.output().written()) << "the list is no longer fresh";
  }
}

// A list may come before the node has integrated: its stamp means nothing then.
TEST(ForeignStep, HasNoTimeStampsWithoutGlobalTime) {
  OneTask task("copy.so");
  task.context().global_time = false;
  task.arrives(1, 1, GlobalTime{40'000'000}, some_value);
  task.run();
  EXPECT_EQ(host::time_stamp(task.layout(), task.output().view(), GlobalTime{}, task.cluster().round()).ns, 0);
}

TEST(ForeignStep, LeavesTheFloatingPointEnvironmentAlone) {
  OneTask task("rounds.so");
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  for (int k = 0; k < 10; ++k) task.run();
  const int after = std::fegetround();
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(after, FE_UPWARD);
  ASSERT_TRUE(task.output().written());
  EXPECT_NEAR(host::element_value(task.layout(), task.output().view(), 0, 0), 8.0, 0.1) << "the call's is the default";
}

TEST(ForeignStep, LeavesTheSignalMaskAlone) {
  OneTask task("blocks.so");
  for (int k = 0; k < 10; ++k) task.run();
  sigset_t mask;
  pthread_sigmask(SIG_SETMASK, nullptr, &mask);
  EXPECT_EQ(sigismember(&mask, SIGTERM), 0);
}

TEST(ForeignStep, LibrariesThatDoNotFitAreOneSentence) {
  EXPECT_THAT(refusal("copy.so", nullptr),
              HasSubstr(std::string(kPlace) +
                        "copy.so: needs --steps FOLDER, the library's folder: a cluster file alone loads no code"));
  EXPECT_THAT(refusal("absent.so"),
              HasSubstr(std::string(kPlace) + "absent.so: must be a file in the folder of --steps: there is no "));
  EXPECT_THAT(refusal("no_library.so"), HasSubstr("must be a shared library that can be loaded: "));
  EXPECT_THAT(refusal("no_run.so"), HasSubstr("must have the functions of ttfusion_step.h: "));
  EXPECT_THAT(refusal("no_run.so"), HasSubstr("lacks ttf_step_run"));
  EXPECT_THAT(refusal("other_version.so"), HasSubstr("must be built with version 1 of ttfusion_step.h: "));
  EXPECT_THAT(refusal("other_version.so"), HasSubstr("other_version.so is of version 2"));
  EXPECT_THAT(
      refusal("refuses.so"),
      HasSubstr(std::string(kPlace) + "refuses.so: is refused by the library: in of laser_objects is not what I read"));
  EXPECT_THAT(refusal("throws_at_creation.so"),
              HasSubstr(std::string(kPlace) + "throws_at_creation.so: ttf_step_create threw: no such object"));
}

std::string failure(const std::string& library) {
  OneTask task(library);
  try {
    for (int k = 0; k < 10; ++k) task.run();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(ForeignStep, AnExceptionHasItsPlace) {
  EXPECT_EQ(failure("throws.so").substr(failure("throws.so").find("nodes.gateway")),
            "nodes.gateway.tasks.forward_laser.step = throws.so: ttf_step_run threw: no such object");
  EXPECT_THAT(failure("throws_seven.so"),
              HasSubstr("throws_seven.so: ttf_step_run threw something else than a std::exception"));
}

TEST(ForeignStep, ListsThatAPortCannotHoldEndTheNode) {
  EXPECT_THAT(failure("fails.so"), HasSubstr(std::string(kPlace) + "fails.so: failed: ttf_step_run returned 7"));
  EXPECT_EQ(failure("too_many.so"), "") << "the list is not written";
  const auto with_list = [](const std::string& library) {
    OneTask task(library);
    try {
      for (std::uint32_t k = 0; k < 10; ++k) {
        task.arrives(k, 2, GlobalTime{}, some_value);
        task.run();
      }
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(with_list("too_many.so"), HasSubstr("gave 1000 elements to the port out, which has room for 25"));
  EXPECT_THAT(with_list("not_finite.so"),
              HasSubstr("gave nan as y of element 0 to the port out: values must be finite"));
  EXPECT_THAT(with_list("too_late.so"),
              HasSubstr("gave the time stamp 9223372036854775807 ns to the port out: it must be within 2^62 ns"));
  EXPECT_THAT(with_list("replaces.so"), HasSubstr("replaced the pointer to the values of the port out: "));
}

// Each runs the test program anew: a fork would have no timer.
class ForeignStepDeaths : public testing::Test {
 protected:
  ForeignStepDeaths() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

void run_ten(const std::string& library, Duration limit) {
  const StepFolder folder{TTF_TEST_STEPS, limit};
  OneTask task(library, &folder);
  for (int k = 0; k < 10; ++k) task.run();
}

TEST_F(ForeignStepDeaths, AHangEndsTheProcess) {
  EXPECT_EXIT(
      run_ten("hangs.so", Duration::milliseconds(100)), testing::ExitedWithCode(1),
      "^error: .*paper_synchronised.yaml:243: nodes.gateway.tasks.forward_laser.step = hangs.so: a call did not "
      "return within 0.1 s \\(--step-limit\\)\n");
}

TEST_F(ForeignStepDeaths, AHangOnAnotherThreadEndsTheProcess) {
  EXPECT_EXIT(std::thread([] { run_ten("hangs.so", Duration::milliseconds(100)); }).join(), testing::ExitedWithCode(1),
              "hangs.so: a call did not return within 0.1 s");
}

TEST_F(ForeignStepDeaths, AnExitIsAFailure) {
  for (const char* library : {"exits.so", "quits.so"})
    EXPECT_EXIT(run_ten(library, StepFolder::kUsualLimit), testing::ExitedWithCode(1),
                std::string("^error: .*forward_laser.step = ") + library + ": a call ended the process\n");
}

#ifndef TTF_SANITIZED  // sanitizers have handlers of their own
TEST_F(ForeignStepDeaths, ACrashHasASentence) {
  EXPECT_EXIT(run_ten("crashes.so", StepFolder::kUsualLimit), testing::KilledBySignal(SIGSEGV),
              "^error: .*forward_laser.step = crashes.so: a call crashed\n");
  EXPECT_EXIT(run_ten("overflows.so", StepFolder::kUsualLimit), testing::KilledBySignal(SIGSEGV),
              "overflows.so: a call crashed\n");
  EXPECT_EXIT(run_ten("aborts.so", StepFolder::kUsualLimit), testing::KilledBySignal(SIGABRT),
              "aborts.so: a call crashed\n");
  EXPECT_EXIT(run_ten("traps.so", StepFolder::kUsualLimit), testing::KilledBySignal(SIGTRAP),
              "traps.so: a call crashed\n");
  EXPECT_EXIT(run_ten("throws_at_end.so", StepFolder::kUsualLimit), testing::KilledBySignal(SIGABRT),
              "throws_at_end.so: a call crashed\n");
}
#endif

}  // namespace
}  // namespace ttf::nodes::foreign
