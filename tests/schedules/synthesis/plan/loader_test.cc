#include "schedules/synthesis/plan/loader.h"

#include <algorithm>
#include <filesystem>

#include "schedules/file/inherit.h"
#include "schedules/file/loader.h"
#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/synthesis/plans.h"
#include "tests/support/refusals.h"

namespace ttf::schedules::synthesis::plan {
namespace {

TEST(PlanLoader, LoadsWhatThePaperPlanLeavesOut) {
  const Plan plan = load_plan(plan_path("paper"));
  EXPECT_TRUE(plan.free_cycle);
  EXPECT_TRUE(plan.parameters.static_slots && plan.parameters.idle_time && plan.parameters.correction_start);
  ASSERT_EQ(plan.lists.size(), 3u);
  for (const PlannedList& list : plan.lists) EXPECT_TRUE(list.at.instant && list.at.repetition);
  ASSERT_EQ(plan.cluster.frames.size(), 5u);  // the key slots
  for (const PlannedSensor& sensor : plan.sensors) EXPECT_TRUE(sensor.at.instant && sensor.rate);
  ASSERT_EQ(plan.chains.size(), 2u);
  EXPECT_EQ(plan.cluster.node(plan.chains[0].node).name, "feature");
}

struct Mistake {
  const char* name;
  const char* pattern;
  const char* replacement;
  const char* key;    // the finding's
  const char* words;  // in its sentence
};

// Every mistake is one sentence with line and key.
TEST(PlanLoader, NamesEachMistake) {
  const Mistake mistakes[] = {
      {"no section", "plan:\n", "plans:\n", "plan", "is missing"},
      {"cycle twice", "  gdMacrotick: 1 ", "  gdCycle: 5000\n  gdMacrotick: 1 ", "flexray.gdCycle", "must be left out"},
      {"no macrotick", "  gdMacrotick: 1 [^\n]*\n", "", "flexray.gdMacrotick", "is missing"},
      {"one channel of nothing", "plan:\n", "plan:\n  one_channel: [laser_scan]\n", "plan.one_channel",
       "laser_scan is none"},
      {"one channel twice", "plan:\n", "plan:\n  one_channel: [image, image]\n", "plan.one_channel", "once"},
      {"cycle backwards", "longest: 9 ms, step", "longest: 8 ms, step", "plan.cycle.longest", "8500 us"},
      {"no step", ", step: [^}]*", "", "plan.cycle.step", "is missing"},
      {"tiny step", "longest: 9 ms, step: [^}]*", "longest: 16 ms, step: 100 ns", "plan.cycle.step", "must be"},
      {"too long a cycle", "longest: 9 ms, step", "longest: 90 ms, step", "plan.cycle.longest", "16 ms"},
      {"negative age", "largest_age: 60 ms", "largest_age: -1 ms", "plan.chains.laser.largest_age", "must be"},
      {"absurd age", "largest_age: 60 ms", "largest_age: 90 s", "plan.chains.laser.largest_age", "must be"},
      {"from nowhere", "from: laser, to", "from: lidar, to", "plan.chains.laser.from", "is not the name of a sensor"},
      {"to nowhere", "to: feature.use", "to: feature.abuse", "plan.chains.laser.to", "must be NODE.TASK"},
      {"no way there", "from: laser, to: feature.use", "from: laser, to: camera_pre.preprocess", "plan.chains.laser.to",
       "no list leads there"},
      {"to a measurement", "from: laser, to: feature.use", "from: laser, to: laser.measure", "plan.chains.laser.to",
       "must be a task that time activates"},
      {"unknown objective", "objective: \\[data_age", "objective: [beauty", "plan.objective[0]", "must be one of"},
      {"objective twice", "objective: \\[data_age", "objective: [slots", "plan.objective", "once"},
      {"no rate", "    laser: \\{shortest: [^}]*\\}\n", "", "plan.rates", "must say how often laser measures"},
      {"rate of nothing", "    laser: \\{shortest", "    lidar: {shortest", "plan.rates.lidar", "is not the name"},
      {"rate backwards", "laser: \\{shortest: 34 ms", "laser: {shortest: 54 ms", "plan.rates.laser.longest", "must be"},
      {"half an instant", "measurement: scheduled\\}", "measurement: scheduled, offset: 5}", "sensors.laser.base_cycle",
       "leaves out both"},
      {"half a task's instant", "\\{kind: time\\}", "{kind: time, base_cycle: 0}",
       "nodes.laser_pre.tasks.preprocess.activation.offset", "leaves out both"},
      {"half a slot", "\\{sender: fusion, pdu: image\\}", "{sender: fusion, pdu: image, slot: 9}",
       "frames[7].base_cycle", "leaves out both"},
      {"a part of a list", "\\{sender: fusion, pdu: image\\}", "{sender: fusion, pdu: image, first_fragment: 1}",
       "frames[7].first_fragment", "whole lists"},
      {"unknown key", "  objective:", "  objectives: 1\n  objective:", "plan.objectives", ""},
      {"key of a cluster", "draw: worst", "draw: often", "nodes.laser.tasks.measure.draw", "must be one of"},
      {"range of a cluster", "gPayloadLengthStatic: 28", "gPayloadLengthStatic: 200", "flexray.gPayloadLengthStatic",
       "0..127"},
      {"like nothing", "  objective:", "  sensors: {rear: {like: lidar}}\n  objective:", "plan.sensors.rear.like",
       "= lidar: must be an earlier sensor: laser or camera"},
      {"like a list", "  objective:", "  sensors: {rear: {like: [laser]}}\n  objective:", "plan.sensors.rear.like",
       "= [laser]: must be an earlier sensor: laser or camera"},
      {"like misspelt", "  objective:", "  sensors: {rear: {lik: laser}}\n  objective:", "plan.sensors.rear.lik",
       "= laser: is not a known key here; did you mean like?"},
      {"more than a header counts",
       "  objective:", "  sensors: {rear: {like: laser, objects: 255}, left: {like: camera, raw: 65}}\n  objective:",
       "plan.sensors.left.raw", "at most 63"},
      {"a copy among the sensors", "sensors:\n  laser:", "sensors:\n  rear: {like: laser}\n  laser:",
       "sensors.rear.like", "plan.sensors has the sensors whose nodes are copies"},
      {"like itself", "  objective:", "  sensors: {laser: {like: laser}}\n  objective:", "plan.sensors.laser",
       "is the name of an earlier sensor"},
  };
  const std::string original = plan_text("paper");
  ASSERT_TRUE(plan_findings(original).empty());
  for (const Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.name);
    const std::string text = changed(original, mistake.pattern, mistake.replacement);
    const auto findings = plan_findings(text);
    const bool named = std::any_of(findings.begin(), findings.end(), [&](const Finding& one) {
      return one.file == "plan.yaml" && one.line > 0 && one.key == mistake.key &&
             one.sentence().find(mistake.words) != std::string::npos;
    });
    EXPECT_TRUE(named) << mistake.key << ": " << mistake.words;
    if (!named)
      for (const Finding& one : findings) ADD_FAILURE() << one.sentence();
  }
}

// Returns the findings of a plan in a folder of its own, beside the paper's plan with one change.
std::vector<Finding> findings_beside(const std::string& base, const std::string& heir) {
  const std::string folder = testing::TempDir() + "plans";
  std::filesystem::create_directories(folder);
  for (const auto& [name, text] : {std::pair{"base.yaml", base}, std::pair{"heir.yaml", heir}})
    std::ofstream(folder + "/" + name, std::ios::binary) << text;
  return support::findings_of([&] { (void)load_plan(folder + "/heir.yaml"); });
}

// A finding about what a base says names the base's file and line.
TEST(PlanLoader, AnExtendingPlanNamesItsBase) {
  const std::string paper = plan_text("paper");
  EXPECT_TRUE(findings_beside(paper, "extends: base.yaml\nname: heir\n").empty());
  const std::string wrong = changed(paper, "draw: worst", "draw: often");
  const auto line =
      1 + std::count(wrong.begin(), wrong.begin() + static_cast<std::ptrdiff_t>(wrong.find("often")), '\n');
  const auto findings = findings_beside(wrong, "extends: base.yaml\nname: heir\n");
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_TRUE(findings[0].file.ends_with("base.yaml")) << findings[0].file;
  EXPECT_EQ(findings[0].line, line);
  EXPECT_THROW((void)parse_plan(plan_text("paper_two_lasers_radar"), "plan.yaml"), InputError);  // no folder
}

// The entry of the heir is the mistake, if its base cannot be read or leads back.
TEST(PlanLoader, ABaseThatCannotBeIsAMistakeOfItsHeir) {
  const std::pair<const char*, const char*> mistakes[] = {{"extends: nothing.yaml\nname: heir\n", "nothing.yaml"},
                                                          {"name: heir\nextends: base.yaml\n", "lead back"}};
  for (const auto& [heir, words] : mistakes) {
    const auto findings = findings_beside("extends: heir.yaml\n", heir);
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].key, "extends");
    EXPECT_GT(findings[0].line, 0);
    EXPECT_NE(findings[0].sentence().find(words), std::string::npos) << findings[0].sentence();
  }
}

TEST(PlanLoader, FurtherSensorsHaveAllThatTheirListsNeed) {
  const Plan plan = load_plan(plan_path("paper_two_lasers_radar"));
  ASSERT_EQ(plan.cluster.sensors.size(), 4u);
  const auto rear = plan.cluster.find_sensor("rear_laser"), radar = plan.cluster.find_sensor("front_radar");
  ASSERT_TRUE(rear && radar);
  EXPECT_EQ(plan.cluster.sensor(*radar).kind, model::SensorKind::kRadar);
  const model::Node& host = plan.cluster.node(plan.cluster.sensor(*radar).host);
  EXPECT_EQ(host.tasks[0].step, "radar_preprocessing");
  EXPECT_FALSE(host.flexray->pKeySlotUsedForSync);
  EXPECT_NE(host.flexray->pKeySlotId, plan.cluster.node(plan.cluster.sensor(*rear).host).flexray->pKeySlotId);
  EXPECT_EQ(plan.lists.size(), 5u);
  EXPECT_EQ(plan.cluster.can_buses.size(), 4u);
  EXPECT_EQ(plan.chains.size(), 4u);
  for (const model::CanBus& bus : plan.cluster.can_buses)
    for (const model::CanMessage& message : bus.messages) {
      const model::Node& sender = plan.cluster.node(message.sender);
      ASSERT_EQ(sender.tasks.size(), 1u);
      EXPECT_EQ(sender.tasks[0].writes[0].pdu, message.pdu);
    }
}

// Every mistake about a free payload is one sentence, too.
TEST(PlanLoader, NamesMistakesAboutAFreePayload) {
  const std::string original = file::inherited(plan_path("paper_payload")).text;
  EXPECT_TRUE(plan_findings(original).empty());
  const std::string layout = "(camera_objects:\n +sensor: camera\n)";
  const Mistake mistakes[] = {
      {"payload twice", "  gdMacrotick: 1", "  gPayloadLengthStatic: 28\n  gdMacrotick: 1",
       "flexray.gPayloadLengthStatic", "must be left out"},
      {"odd", "payload: \\{shortest: 24", "payload: {shortest: 25", "plan.payload.shortest", "must be even"},
      {"backwards", "shortest: 24, longest: 120", "shortest: 40, longest: 30", "plan.payload.longest", "40..254 bytes"},
      {"none at all", "shortest: 24, longest: 120", "shortest: 0, longest: 120", "plan.payload.shortest",
       "2..254 bytes"},
      {"half a layout", layout.c_str(), "$1    fragment_bytes: 56\n", "pdus.camera_objects.elements_per_fragment",
       "leaves out both"},
      {"layout of a CAN", "    fragment_bytes: 8\n    max_elements: 40\n    elements_per_fragment: 1\n",
       "    max_elements: 40\n", "pdus.camera_frame.fragment_bytes", "must be said"},
  };
  for (const Mistake& one : mistakes) {
    SCOPED_TRACE(one.name);
    const auto findings = plan_findings(changed(original, one.pattern, one.replacement));
    ASSERT_EQ(findings.size(), 1u) << findings.size();
    EXPECT_EQ(findings[0].key, one.key);
    EXPECT_NE(findings[0].sentence().find(one.words), std::string::npos) << findings[0].sentence();
    EXPECT_GT(findings[0].line, 0);
  }
}

// The values that it leaves out are no findings.
TEST(PlanLoader, InPlaceOfAClusterAPlanIsOneSentence) {
  try {
    (void)file::parse_cluster(plan_text("paper"), "plan.yaml");
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.findings().size(), 1u);
    EXPECT_EQ(error.findings()[0].sentence(),
              "plan.yaml:12: plan: is of a plan, not of a cluster; `ttfusion schedule synthesize` takes it");
  }
}

// The keys of the other sensor stand there, left-out ones, too.
TEST(PlanLoader, ASensorOfItsClusterMayBeLikeAnother) {
  const Plan paper = parse_plan(plan_text("paper"), "p");
  const Plan plan = parse_plan(changed(plan_text("paper"), "camera: \\{kind: camera, (.*), measurement: scheduled",
                                       "camera: {like: laser, kind: camera, $1"),
                               "p");
  EXPECT_EQ(dump(plan.cluster), dump(paper.cluster));
  EXPECT_TRUE(plan.sensors[1].at.instant);
  EXPECT_EQ(plan.sensors[1].at.repetition, paper.sensors[1].at.repetition);
}

// A list of one frame stands in its sender's key slot: a further sensor's host needs another one.
TEST(PlanLoader, AFurtherSensorsKeySlotIsFreeOfLists) {
  const std::string one_frame =
      changed(changed(plan_text("paper"), "  - \\{slot: 2, sender: camera_pre\\}\n", ""),
              "(camera_objects:\n +sensor: camera\n +fragment_bytes: 56\n +max_elements:) 25", "$1 4");
  const Plan plan =
      parse_plan(changed(one_frame, "  objective:", "  sensors: {rear: {like: laser}}\n  objective:"), "p");
  const auto list = std::find_if(plan.lists.begin(), plan.lists.end(), [](const auto& one) { return !one.at.instant; });
  ASSERT_NE(list, plan.lists.end());
  EXPECT_EQ(list->slot, 2);
  const auto host = plan.cluster.find_node("rear_pre");
  ASSERT_TRUE(host);
  EXPECT_EQ(plan.cluster.node(*host).flexray->pKeySlotId, 6);
}

TEST(PlanLoader, AListWithChannelsIsNotOnOneThatThePlanChooses) {
  const std::string text = changed(changed(plan_text("paper"), "plan:\n", "plan:\n  one_channel: [image]\n"),
                                   "sender: fusion, pdu: image", "sender: fusion, pdu: image, channels: AB");
  const auto findings = plan_findings(text);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].key, "plan.one_channel");
  EXPECT_NE(findings[0].expected.find("whose channels are left out"), std::string::npos);
}

TEST(PlanLoader, OneChannelLeadsFromTheSenderToAllReaders) {
  std::string text = changed(plan_text("paper"), "plan:\n", "plan:\n  one_channel: [image]\n");
  text = changed(text, "pKeySlotId: 4", "pKeySlotId: 4, pChannels: A");
  text = changed(text, "pKeySlotId: 5", "pKeySlotId: 5, pChannels: B");
  const auto findings = plan_findings(text);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NE(findings[0].expected.find("share a channel; those of image do not"), std::string::npos);
}

}  // namespace
}  // namespace ttf::schedules::synthesis::plan
