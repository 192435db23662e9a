// Files of task sets: what each column means, and one sentence for each mistake.
#include "schedules/timing/task_set/reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "schedules/timing/task_set/verdict.h"

namespace ttf::schedules::timing::task_set {
namespace {

const std::string kBraking = std::string(TTF_SOURCE_DIR) + "/schedules/task_sets/braking.csv";

TEST(TaskSetFile, Columns) {
  const TaskSet set = parse_task_set(
      "kind,name,resource,period\n"
      "chain, c, a > m > b, 90 ms\n"
      "processor,p,preemptive,here\nbus,can,can,500000\nbus,slots,table,,here\n"
      "task,a,p,10 ms,1 ms,250 us,1 ms,2ms,9 ms,7,implicit\n"
      "task,b,p,20 ms,,,,3 ms,,3,let\n"
      "message,m,can,,,,,8,,,event\n"
      "message,s,slots,5 ms,2 ms,,,40 us\n",
      "set.csv");
  ASSERT_EQ(set.tasks.size(), 4U);
  const Task& a = set.tasks[0];
  EXPECT_EQ(a.period, Duration::milliseconds(10));
  EXPECT_EQ(a.offset, Duration::milliseconds(1));
  EXPECT_EQ(a.jitter, Duration::microseconds(250));
  EXPECT_EQ(a.best, Duration::milliseconds(1));
  EXPECT_EQ(a.worst, Duration::milliseconds(2));
  EXPECT_EQ(a.deadline, Duration::milliseconds(9));
  EXPECT_EQ(a.priority, 7);
  EXPECT_FALSE(a.is_message);
  const Task& b = set.tasks[1];
  EXPECT_EQ(b.offset, std::nullopt);
  EXPECT_EQ(b.best, Duration{});
  EXPECT_EQ(b.deadline, Duration::milliseconds(20));
  EXPECT_EQ(b.communication, Communication::kLet);
  const Task& m = set.tasks[2];
  EXPECT_TRUE(m.is_message);
  EXPECT_EQ(m.activator, 0U);
  EXPECT_EQ(m.deadline, std::nullopt);
  EXPECT_EQ(m.worst, Duration::microseconds(270));  // 135 bits
  EXPECT_EQ(m.best, Duration::microseconds(222));   // 111 bits
  EXPECT_EQ(set.period_of(2), Duration::milliseconds(10));
  EXPECT_EQ(set.tasks[3].offset, Duration::milliseconds(2));
  ASSERT_EQ(set.chains.size(), 1U);
  EXPECT_EQ(set.chains[0].stages, (std::vector<std::size_t>{0, 2, 1}));
  EXPECT_EQ(set.chains[0].largest_age, Duration::milliseconds(90));
  EXPECT_EQ(set.resources[2].clock, set.resources[0].clock);
}

struct Mistake {
  std::string from, to, sentence;
};

// 47 to 55 bits of 1/300 ms: the shortest frame is rounded down, and the longest one up.
TEST(TaskSetFile, FramesOfBrokenNanoseconds) {
  const TaskSet set = parse_task_set("bus,can,can,300000\nmessage,m,can,10 ms,,,,0\n", "set.csv");
  EXPECT_EQ(set.tasks[0].best, Duration{156'666});
  EXPECT_EQ(set.tasks[0].worst, Duration{183'334});
}

TEST(TaskSetFile, OneSentenceForEachMistake) {
  const std::string times = "must be a time with its unit (ns, us, ms or s), ";
  const std::vector<Mistake> mistakes{
      {"task, exposure", "tsk, exposure",
       "11: kind = tsk: must be one of processor, bus, task, message, chain; did you mean task?"},
      {"task, exposure", "task, \"exposure",
       "line = exposure, camera_ecu, 40 ms, 0 ms, , 1 ms, 1 ms, , 1: must end its quoted field on the same line"},
      {"1 ms, 1 ms, , 1\n", "1 ms, 1 ms, , 1, implicit, more\n",
       "columns = 12: must be at most 11: kind, name, resource, period, offset, jitter, best, worst, deadline, "
       "priority, communication"},
      {"task, exposure", "task, ex>posure", "name = ex>posure: must be 1..60 printable ASCII characters without >"},
      {"task, control", "task, planner", "name = planner: must be the only task or message of this name"},
      {"drive_ecu, preemptive", "camera_ecu, preemptive", "name = camera_ecu: must be the only resource of this name"},
      {"drive_ecu, preemptive", "drive_ecu, premptive",
       "drive_ecu.policy = premptive: must be one of preemptive, non_preemptive, table; did you mean preemptive?"},
      {"camera_can, can, 500000", "camera_can, can", "camera_can.bit rate: is missing: must be 10000..1000000 bit/s"},
      {"camera_can, can, 500000", "camera_can, can, 5",
       "camera_can.bit rate = 5: must be a whole number 10000..1000000 bit/s"},
      {"backbone, table, ,", "backbone, table, 1000000,",
       "backbone.bit rate = 1000000: must be blank: only a CAN has one"},
      {"exposure, camera_ecu", "exposure, camera_eku",
       "exposure.resource = camera_eku: must be the name of a processor; did you mean camera_ecu?"},
      {"exposure, camera_ecu", "exposure, backbone", "exposure.resource = backbone: must be a processor: it is a bus"},
      {"status, camera_can", "status, brake_ecu", "status.resource = brake_ecu: must be a bus: it is a processor"},
      {"control, drive_ecu, 5 ms", "control, drive_ecu, 5", "control.period = 5: " + times + "1 us..1000 s"},
      {"control, drive_ecu, 5 ms", "control, drive_ecu, 0 ms", "control.period = 0 ms: " + times + "1 us..1000 s"},
      {"control, drive_ecu, 5 ms", "control, drive_ecu, ",
       "control.period: is missing: must be a time with its unit, 1 us..1000 s"},
      {"5 ms, 0 ms, , 1 ms, 1 ms", "5 ms, -1 ms, , 1 ms, 1 ms", "control.offset = -1 ms: " + times + "0 ns..1000 s"},
      {"5 ms, 0 ms, , 1 ms, 1 ms", "5 ms, 0 ms, x, 1 ms, 1 ms", "control.jitter = x: " + times + "0 ns..1000 s"},
      {"5 ms, 0 ms, , 1 ms, 1 ms", "5 ms, 0 ms, , 2 ms, 1 ms",
       "control.best = 2 ms: must be at most the worst case of 1 ms"},
      {"5 ms, 0 ms, , 1 ms, 1 ms", "5 ms, 0 ms, , 1 ms",
       "control.worst: is missing: must be a time with its unit, 1 ns..1000 s"},
      {"3 ms, 3 ms, , , let", "3 ms, 3 ms, 21 ms, , let",
       "planner.deadline = 21 ms: must be at most the period of 20 ms, where LET writes"},
      {"3 ms, 3 ms, , , let", "3 ms, 3 ms, , , lett",
       "planner.communication = lett: must be one of implicit, let, event; did you mean let?"},
      {"21 ms, , 2", "21 ms, , 1", "detection.priority = 1: must be another one than that of exposure"},
      {"21 ms, , 2", "21 ms, , ", "detection.priority: must be given for all on camera_ecu, or for none"},
      {"21 ms, , 2", "21 ms, , -2", "detection.priority = -2: must be a whole number 0..536870911"},
      {"10 ms, , , , 4", "10 ms, , , , 9", "status.worst = 9: must be a whole number 0..8 bytes"},
      {"10 ms, , , , 4", "10 ms, , , , ", "status.worst: is missing: must be a payload of 0..8 bytes"},
      {"10 ms, , , , 4", "10 ms, , , 4, 4", "status.best = 4: must be blank: the payload of a frame is its worst case"},
      {"objects, camera_can, ,", "objects, camera_can, 40 ms,",
       "objects.period = 40 ms: must be blank: detection activates it"},
      {"objects, camera_can, , ,", "objects, camera_can, , 1 ms,",
       "objects.offset = 1 ms: must be blank: events activate it"},
      {"objects, camera_can, , , ,", "objects, camera_can, , , 1 ms,",
       "objects.jitter = 1 ms: must be blank: it is that of the stage before"},
      {"backbone, 10 ms, 1 ms,", "backbone, 10 ms, ,", "command.offset: is missing: a table says when each job begins"},
      {"50 us, 50 us", "50 us, 50 us, , 1", "command.priority = 1: must be blank: a table has none"},
      {"50 us, 50 us", "50 us, 50 us, , , event",
       "command.communication = event: must be implicit or let: time activates what is in a table"},
      {"exposure > detection", "exposure > detectoin",
       "braking.stages = exposure > detectoin > objects > planner > command > brake: "
       "must be names of tasks and messages, as in a > b > c: detectoin is none; did you mean detection?"},
      {"> command > brake, 200", "> command > exposure, 200", "must have each stage once: exposure is there twice"},
      {"chain, braking, exposure > detection > objects > planner > command > brake, 200 ms\n", "",
       "objects.period: is missing: no chain has a stage before it, so events from outside activate it"},
      {"chain, command alone, planner > command", "chain, command alone, planner > objects > command",
       "must have detection before objects, as another chain has it: one stage activates it"},
      {"chain, command alone", "chain, braking", "name = braking: must be the only chain of this name"},
      {"brake, 70 ms", "brake, 70", "command alone.largest age = 70: " + times + "1 us..1000 s"}};
  const std::string text = read_file(kBraking);
  ASSERT_NO_THROW(parse_task_set(text, "set.csv"));
  for (const Mistake& mistake : mistakes) {
    std::string wrong = text;
    const std::size_t at = wrong.find(mistake.from);
    ASSERT_NE(at, std::string::npos) << mistake.from;
    wrong.replace(at, mistake.from.size(), mistake.to);
    try {
      parse_task_set(wrong, "set.csv");
      ADD_FAILURE() << "accepted: " << mistake.to;
    } catch (const InputError& error) {
      EXPECT_EQ(error.findings().size(), 1U) << error.what();
      EXPECT_THAT(error.what(), testing::HasSubstr(mistake.sentence));
      EXPECT_THAT(error.what(), testing::MatchesRegex("set.csv:[0-9]+: .*"));
    }
  }
}

TEST(TaskSetFile, TasksThatActivateThemselves) {
  EXPECT_THROW(
      {
        try {
          parse_task_set(
              "processor,p,preemptive\ntask,a,p,,,,,1 ms,,,event\ntask,b,p,,,,,1 ms,,,event\n"
              "chain,1,a > b\nchain,2,b > a\n",
              "set.csv");
        } catch (const InputError& error) {
          EXPECT_THAT(error.what(),
                      testing::HasSubstr("a.communication = event: must not let the task activate itself"));
          throw;
        }
      },
      InputError);
  EXPECT_THROW(parse_task_set("# nothing\n", "set.csv"), InputError);
}

TEST(TaskSetFile, ShippedSetHolds) {
  const TaskSet set = load_task_set(kBraking);
  const Verdict verdict = verdict_on(set);
  EXPECT_TRUE(verdict.holds()) << verdict_text(set, verdict);
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
