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
const std::string kBuses = std::string(TTF_SOURCE_DIR) + "/schedules/task_sets/buses.csv";

struct Mistake {
  std::string from, to, sentence;
};

void expect_one_sentence_each(const std::string& file, const std::vector<Mistake>& mistakes) {
  const std::string text = read_file(file);
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

TEST(TaskSetFile, ColumnsOfBusesAndSlots) {
  const TaskSet set = parse_task_set(
      "processor,p,tdma,,4 ms\nbus,d,dynamic,,,5 ms,60,20 us,start\nbus,e,can,500000,,,,,,10 ms\n"
      "bus,r,can,500000,,,,,,0.25/s\n"
      "task,a,p,10 ms,,,,1 ms,,,,500 us\n"
      "message,m,d,20 ms,,,2,24,,7,,,3/4,30\nmessage,n,d,20 ms,,,,24,,7,,,0/2\n",
      "set.csv");
  EXPECT_EQ(set.resources[0].cycle, Duration::milliseconds(4));
  EXPECT_EQ(set.resources[1].cycle, Duration::milliseconds(5));
  EXPECT_EQ(set.resources[1].minislots, 60);
  EXPECT_EQ(set.resources[1].minislot, Duration::microseconds(20));
  EXPECT_TRUE(set.resources[1].decides_at_start);
  EXPECT_EQ(set.resources[2].errors_apart, Duration::milliseconds(10));
  EXPECT_EQ(set.resources[3].errors_apart, std::nullopt);
  EXPECT_DOUBLE_EQ(set.resources[3].errors_per_s, 0.25);
  EXPECT_EQ(set.tasks[0].slot, Duration::microseconds(500));
  const Task& m = set.tasks[1];
  EXPECT_EQ(m.best, Duration::microseconds(40));
  EXPECT_EQ(m.worst, Duration::microseconds(480));
  EXPECT_EQ(m.minislots, 24);
  EXPECT_EQ(m.base_cycle, 3);
  EXPECT_EQ(m.repetition, 4);
  EXPECT_EQ(m.latest_tx, 30);
  EXPECT_EQ(set.tasks[2].latest_tx, 37);
  EXPECT_EQ(set.tasks[2].repetition, 2);
}

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
      {"1 ms, 1 ms, , 1\n", "1 ms, 1 ms, , 1, implicit, , , , more\n",
       "columns = 15: must be at most 14: kind, name, resource, period, offset, jitter, best, worst, deadline, "
       "priority, communication, slot, cycles, latest tx"},
      {"task, exposure", "task, ex>posure", "name = ex>posure: must be 1..60 printable ASCII characters without >"},
      {"task, control", "task, planner", "name = planner: must be the only task or message of this name"},
      {"drive_ecu, preemptive", "camera_ecu, preemptive", "name = camera_ecu: must be the only resource of this name"},
      {"drive_ecu, preemptive", "drive_ecu, premptive",
       "drive_ecu.policy = premptive: must be one of preemptive, non_preemptive, tdma, table; did you mean "
       "preemptive?"},
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
  expect_one_sentence_each(kBraking, mistakes);
}

TEST(TaskSetFile, MistakesOfBusesAndSlots) {
  const std::string errors =
      "must be the least time between two errors, 1 us..1000 s, or their rate at random, 0.000001/s..10000/s";
  const std::string cycles = "must be BASE/REPETITION, as in 1/4: a repetition of 1, 2, 4, ..., 64 and a base below it";
  const std::vector<Mistake> mistakes{
      {"tdma, brakes, 2 ms", "tdma, brakes", "brake_ecu.cycle: is missing: must be a time with its unit, 1 us..1000 s"},
      {"preemptive, radar", "preemptive, radar, 2 ms", "radar_ecu.cycle = 2 ms: must be blank: only tdma has one"},
      {"vehicle, 5 ms, 60", "vehicle, 50 ms, 60",
       "dynamic.cycle = 50 ms: must be a time with its unit (ns, us, ms or s), 10 us..16 ms"},
      {"5 ms, 60, 20 us", "5 ms, , 20 us", "dynamic.minislots: is missing: must be the number of minislots, 1..7988"},
      {"5 ms, 60, 20 us", "5 ms, 600, 20 us",
       "dynamic.minislots = 600: must fit the cycle: 600 of 20 us are longer than 5 ms"},
      {"5 ms, 60, 20 us", "5 ms, 60, 20 us, end", "dynamic.decision = end: must be one of turn, start"},
      {"5 ms, 60, 20 us", "5 ms, 60, 20 us, , 1 ms", "dynamic.errors = 1 ms: must be blank: only a CAN has them"},
      {"body, , , , , 10 ms", "body, , , , , 10", "body_can.errors = 10: " + errors},
      {"body, , , , , 10 ms", "body, , , , , -1/s", "body_can.errors = -1/s: " + errors},
      {"body, , , , , 10 ms", "body, , 7, , , 10 ms",
       "body_can.minislots = 7: must be blank: only a dynamic segment has it"},
      {"body, , , , , 10 ms", "body, 1 ms, , , , 10 ms",
       "body_can.cycle = 1 ms: must be blank: only tdma and dynamic have one"},
      {", 500 us\n", "\n", "brake.slot: is missing: must be a time with its unit, 1 ns..2 ms"},
      {", 500 us\n", ", 1900 us\n",
       "watchdog.slot = 200 us: must fit the cycle of brake_ecu, which is 2 ms, with the slots before it"},
      {"1500 us, , ,", "1500 us, , 1,", "brake.priority = 1: must be blank: each has a slot of its own"},
      {"9 ms\n", "9 ms, , , , 1 ms\n", "tracking.slot = 1 ms: must be blank: only tdma has one"},
      {"9 ms\n", "9 ms, , , , , 0/2\n", "tracking.cycles = 0/2: must be blank: only a dynamic segment has it"},
      {", , 24, 25 ms", ", , 61, 25 ms", "objects.worst = 61: must be a whole number 1..60 minislots"},
      {", , 24, 25 ms", ", , , 25 ms", "objects.worst: is missing: must be a length of 1..60 minislots"},
      {", , 24, 25 ms", ", 25, 24, 25 ms", "objects.best = 25: must be a whole number 0..24 minislots"},
      {"25 ms, 2, event", "25 ms, , event",
       "objects.priority: is missing: must be the slot's number in the dynamic segment, 1..2047"},
      {"1/2, 20", "1/2, 32", "calibration.latest tx = 32: must be a whole number 1..31"},
      {"1/2, 20", "2/2, 20", "calibration.cycles = 2/2: " + cycles},
      {"1/2, 20", "1/3, 20", "calibration.cycles = 1/3: " + cycles},
      {"1/2, 20", "1, 20", "calibration.cycles = 1: " + cycles},
      {"1/2, 20", "0/4, 20",
       "calibration.priority = 1: must be another one than that of diagnosis, or have other cycles"}};
  expect_one_sentence_each(kBuses, mistakes);
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

TEST(TaskSetFile, ShippedSetsHold) {
  for (const std::string& file : {kBraking, kBuses}) {
    const TaskSet set = load_task_set(file);
    const Verdict verdict = verdict_on(set);
    EXPECT_TRUE(verdict.holds()) << verdict_text(set, verdict);
  }
}

}  // namespace
}  // namespace ttf::schedules::timing::task_set
