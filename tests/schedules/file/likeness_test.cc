// Sensors and PDUs that are like others.
#include "schedules/file/likeness/inherit_alike.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "schedules/exchange/cluster_yaml.h"
#include "schedules/file/loader.h"
#include "schedules/file/vary.h"
#include "schedules/model/limits.h"
#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

std::string whole_text(const std::string& name) { return exchange::cluster_yaml(load_cluster(shipped_path(name)), ""); }

// The place of a sensor's keys in a whole text.
support::Match entry_of(const std::string& text, const std::string& sensor) {
  const auto found = support::first_match(text, "\n  " + sensor + ":\n    \\{(kind: .*)\\}\n");
  EXPECT_TRUE(found) << sensor;
  return found.value();
}

std::map<std::string, std::string> keys_of(const std::string& entry) {
  std::map<std::string, std::string> keys;
  static const support::Pattern kKey("(\\w+): ([^,]+)");
  for (const support::Match& key : support::matches(entry, kKey)) keys[key[1]] = key[2];
  return keys;
}

class Alike : public testing::TestWithParam<std::string> {};

// The keys of the other sensor stand there, and its own keys replace them: whatever the two kinds, whichever is first.
TEST_P(Alike, ASensorHasWhatItLacks) {
  const std::string text = whole_text(GetParam());
  const model::Cluster cluster = parse_cluster(text, "whole.yaml");
  const auto dumped = dump(cluster);
  int judged = 0;
  for (const model::Sensor& sensor : cluster.sensors)
    for (const model::Sensor& other : cluster.sensors) {
      if (sensor.name == other.name || (other.phase && !sensor.phase)) continue;
      const support::Match own = entry_of(text, sensor.name);
      std::map<std::string, std::string> keys = keys_of(own[1]), others = keys_of(entry_of(text, other.name)[1]);
      std::string differs = "like: " + other.name;
      bool alike_in_some = false;
      for (const auto& [key, value] : keys)
        if (others[key] != value)
          differs += ", " + key + ": " + value;
        else
          alike_in_some = true;
      if (!alike_in_some) continue;  // `like` would have no effect
      ++judged;
      ASSERT_LT(differs.size(), own[1].size() + 20);
      const std::string alike =
          std::string(text).replace(own.at, own.size, "\n  " + sensor.name + ": {" + differs + "}\n");
      EXPECT_EQ(dump(parse_cluster(alike, "like.yaml")), dumped) << differs;
    }
  EXPECT_EQ(judged == 0, cluster.sensors.size() < 2);
}
INSTANTIATE_TEST_SUITE_P(Clusters, Alike, testing::ValuesIn(shipped_clusters()),
                         [](const auto& parameter) { return parameter.param; });

struct Copied {
  const char *cluster, *like, *host;
};
class Copies : public testing::TestWithParam<Copied> {};

std::string with_sensor(const std::string& text, const std::string& entry) {
  return support::replaced(text, "\nsensors:\n", "\nsensors:\n  " + entry + "\n");
}
// Static slots in place of minislots.
std::string with_room(std::string text) {
  text = support::replaced(text, " +gdNIT: .*\n", "");
  text = support::replaced(text, "gNumberOfMinislots: \\d+", "gNumberOfMinislots: 100");
  return support::replaced(text, "gNumberOfStaticSlots: \\d+", "gNumberOfStaticSlots: 50");
}

// A sensor without device and host gets all that leads to the fusion.
TEST_P(Copies, ASecondSensorPassesTheCheck) {
  const auto& [name, like, host] = GetParam();
  const std::string text = with_sensor(shipped_text(name), std::string("rear: {like: ") + like + "}");
  const model::Cluster before = load_cluster(shipped_path(name)), cluster = parse_cluster(text, "copy.yaml");
  EXPECT_EQ(sentences(check::check(cluster)), "");
  const model::Sensor &one = before.sensor(*before.find_sensor(like)),
                      &rear = cluster.sensor(*cluster.find_sensor("rear"));
  EXPECT_EQ(cluster.node(rear.host).name, host);
  EXPECT_EQ(rear.kind, one.kind);
  EXPECT_EQ(dump(rear.at), dump(one.at));
  EXPECT_EQ(rear.period, one.period);
  EXPECT_EQ(cluster.nodes.size(), before.nodes.size() + 2);
  EXPECT_EQ(cluster.pdus.size(), before.pdus.size() + 2);
  const std::string whole = exchange::cluster_yaml(cluster, "");
  EXPECT_EQ(dump(parse_cluster(whole, "whole.yaml")), dump(cluster));
}
INSTANTIATE_TEST_SUITE_P(Kinds, Copies,
                         testing::Values(Copied{"paper_planned", "laser", "rear_pre"},
                                         Copied{"paper_earliest", "laser", "rear_pre"},
                                         Copied{"closed_loop_planned", "camera", "rear_pre"},
                                         Copied{"four_kinds_synchronised", "mono_camera", "rear_mono_pre"},
                                         Copied{"four_kinds_unsynchronised", "mono_camera", "rear_mono_pre"},
                                         Copied{"four_kinds_synchronised", "stereo_camera", "rear_stereo_pre"},
                                         Copied{"laser_and_radar_synchronised", "radar", "rear_pre"},
                                         Copied{"laser_and_radar_unsynchronised", "corner_radar", "rear_corner_pre"},
                                         Copied{"laser_radar_synchronised", "radar", "rear_pre"},
                                         Copied{"paper_event_triggered", "laser", "rear_pre"}),
                         [](const auto& parameter) {
                           return std::string(parameter.param.cluster) + "_" + parameter.param.like;
                         });

// A list on a CAN with others goes there, and so does the gateway's copy of its task.
TEST(SensorCopy, SharesACanAndAGateway) {
  const model::Cluster cluster =
      parse_cluster(with_sensor(with_room(shipped_text("paper_synchronised")), "rear: {like: camera}"), "copy.yaml");
  const model::CanBus& shared = cluster.can_buses[2];
  ASSERT_EQ(shared.messages.size(), 3U);
  EXPECT_EQ(shared.messages[2].identifier, shared.messages[1].identifier + 1);
  EXPECT_EQ(cluster.node(shared.messages[2].sender).name, "rear_pre");
  const std::vector<model::Task>& gateway = cluster.node(*cluster.find_node("gateway")).tasks;
  ASSERT_EQ(gateway.size(), 3U);
  EXPECT_EQ(gateway[2].name, "forward_rear");
  EXPECT_EQ(gateway[2].reads[0].port, "in");
  EXPECT_EQ(cluster.pdu(gateway[2].writes[0].pdu).name, "rear_objects");
}

// The refusal comes before anything is made.
TEST(SensorCopy, WithoutRoomIsRefused) {
  const std::string shipped = with_room(shipped_text("paper_synchronised"));
  const auto refused = [](const std::string& text) {
    const auto findings = findings_of(with_sensor(text, "rear: {like: camera}"));
    return findings.empty() ? std::string() : findings[0].key + " " + findings[0].expected;
  };
  EXPECT_EQ(refused(support::replaced(shipped, "forward_laser", "forward_rear")),
            "sensors.rear.like needs a task forward_rear, a name that is taken; a file has all parts of a sensor, with "
            "its device and host, or none of them");
  const std::size_t before = parse_cluster(shipped, "shipped.yaml").pdus.size();
  const auto with_pdus = [&](std::size_t count) {
    std::string more = "\npdus:\n";
    for (std::size_t n = before; n < count; ++n) more += "  more_" + std::to_string(n) + ": {like: image}\n";
    return support::replaced_first(shipped, "\npdus:\n", more);
  };
  const std::string no_room = "sensors.rear.like needs room for its copies: a cluster has at most 200 nodes";
  const std::size_t lists =
      parse_cluster(with_sensor(shipped, "rear: {like: camera}"), "copy.yaml").pdus.size() - before;
  EXPECT_TRUE(refused(with_pdus(model::kMostNamed - lists + 1)).starts_with(no_room));
  EXPECT_FALSE(refused(with_pdus(model::kMostNamed - lists)).starts_with(no_room));

  const std::size_t tasks = 2;  // the gateway's
  std::string more_tasks;
  for (std::size_t n = tasks; n < model::kMostTasks; ++n)
    more_tasks += "\n      more_" + std::to_string(n) +
                  ": {step: own, activation: {kind: completion, after: forward_laser}, best_case: 1 us, "
                  "worst_case: 1 us, draw: worst, deadline: 1 s}";
  const std::string full =
      support::replaced_first(shipped, "\n      forward_laser:", more_tasks + "\n      forward_laser:");
  EXPECT_EQ(refused(full), "sensors.rear.like needs 1 more task of gateway, which has 16 of at most 16");

  const model::Cluster cluster = parse_cluster(shipped, "shipped.yaml");
  const model::CanBus& bus = cluster.can_buses[2];  // with both sensors' lists
  std::string messages;
  for (std::size_t n = bus.messages.size(); n < 2048; ++n)
    messages += "\n      - {pdu: image, identifier: 7, sender: fusion, shortest_period: 10 ms}";
  const std::string head = "(\n  " + bus.name + ":\n(    .*\n)*?    messages:)";
  EXPECT_EQ(refused(support::replaced_first(shipped, head, "$1" + messages)),
            "sensors.rear.like needs free identifiers on " + bus.name + ", which has 2048 messages");
}

TEST(SensorCopy, HasTheDifferencesThatItSays) {
  const model::Cluster cluster = parse_cluster(
      with_sensor(
          shipped_text("paper_planned"),
          "left: {like: right}\n  right: {like: laser, kind: radar, raw: 30, objects: 11, preprocessing: 14 ms}"),
      "copy.yaml");
  for (const char* name : {"left", "right"}) {
    const model::Sensor& sensor = cluster.sensor(*cluster.find_sensor(name));
    EXPECT_EQ(sensor.kind, model::SensorKind::kRadar);
    EXPECT_EQ(cluster.node(sensor.device).tasks[0].step, "radar_emulator");
    EXPECT_EQ(cluster.node(sensor.host).tasks[0].step, "radar_preprocessing");
    EXPECT_EQ(cluster.node(sensor.host).tasks[0].worst_case, Duration::milliseconds(14));
    EXPECT_EQ(cluster.pdu(*cluster.find_pdu(std::string(name) + "_scan")).max_elements, 30);
    EXPECT_EQ(cluster.pdu(*cluster.find_pdu(std::string(name) + "_objects")).max_elements, 11);
  }
}

TEST(Likeness, EachMistakeIsOneSentence) {
  struct Mistake {
    const char *entries, *key, *words;
  };
  const Mistake mistakes[] = {
      {"rear: {like: rear}", "rear.like", "must be another sensor of this file: laser, camera"},
      {"rear: {like: left}\n  left: {like: laser, raw: 9, device: laser}", "left.raw",
       "device and host must be left out"},
      {"rear: {like: laser, device: laser, host: laser_pre, objects: 9}", "rear.objects",
       "= 9: needs a device and a host that are copies: device and host must be left out"},
      {"rear: {like: laser, host: laser_pre, preprocessing: 9 ms}", "rear.preprocessing",
       "= 9 ms: needs a device and a host that are copies: device and host must be left out"},
      {"rear: {lik: laser}", "rear.lik", "= laser: is not a known key here; did you mean like?"},
      {"rear: {like: odometry}", "rear.like",
       "= odometry: must be a sensor of objects (laser or camera): no task would take"},
      {"rear: {like: laser, kind: odometry}", "rear.kind", "must be one of laser, camera, radar, mono_camera:"},
      {"rear: {like: camera, kind: mono_camera}", "rear.kind",
       "must be a kind whose frames fit camera_can: they have 64 bytes, and it takes at most 8"},
      {"rear: {like: camera, raw: 64}", "rear.raw", "must be at most 63"},
      {"rear: {like: laser, objects: 256}", "rear.objects", "1..255"},
      {"fusion: {like: laser}", "fusion.like", "needs a node fusion, a name that is taken"},
      {"las: {like: laser, device: laser, host: laser_pre}\n  rear: {like: las}", "rear.like",
       "must be a sensor whose device and host have no tasks of other sensors; las is none"},
      {"rear: {like: laser, mounting: 1}", "rear.mounting", "is not a known key"},
      {"rear: {like: laser, measurement: free}", "rear.period", "is missing"},
      {"rear: {like: laser, offset: 90000}", "rear.offset", "must be"},
      {"las: {like: laser}\n  laser_pre: {like: las, device: laser, host: laser_pre}", "laser_pre.device",
       "exactly one task"},
  };
  for (const auto& [entries, key, words] : mistakes) {
    const auto findings = findings_of(with_sensor(shipped_text("closed_loop_planned"), entries));
    ASSERT_FALSE(findings.empty()) << entries;
    EXPECT_EQ(findings[0].key, std::string("sensors.") + key) << findings[0].sentence();
    EXPECT_NE(findings[0].sentence().find(words), std::string::npos) << findings[0].sentence();
    EXPECT_EQ(findings[0].file, "cluster.yaml");
    EXPECT_GT(findings[0].line, 0);
    EXPECT_TRUE(findings.size() == 1 || !std::string_view(words).starts_with("must")) << sentences(findings);
  }
}

// Returns the only finding, with its key and value; else all of them.
std::string only_finding(const std::string& text) {
  const auto findings = findings_of(text);
  if (findings.size() != 1) return std::to_string(findings.size()) + " findings:" + sentences(findings);
  const std::string sentence = findings[0].sentence();
  return sentence.substr(sentence.find(' ') + 1);
}

// The sentence has the value, and the names that it may be. A copy of odometry would be refused: it is not among them.
TEST(Likeness, AWrongNameIsShownBesideTheOthers) {
  const std::string copies = ": must be another sensor of this file: laser, camera";
  const std::pair<const char*, std::string> rows[] = {
      {"like: lidar", "lidar" + copies},
      {"like: [laser]", "[laser]" + copies},
      {"like: ''", "\"\"" + copies},
      {"like: ", "~" + copies},
      {"like: {a: 1}", "{a: 1}" + copies},
      {"like: lidar, device: laser, host: laser_pre", "lidar" + copies + ", odometry"},
  };
  for (const auto& [entry, words] : rows)
    EXPECT_EQ(only_finding(with_sensor(shipped_text("closed_loop_planned"), std::string("rear: {") + entry + "}")),
              "sensors.rear.like = " + words);
  EXPECT_EQ(
      only_finding(support::replaced_first(shipped_text("paper_planned"), "\npdus:\n", "\npdus:\n  a: {lik: image}\n")),
      "pdus.a.lik = image: is not a known key here; did you mean like?");
}

// One sentence names the whole circle. Entries that lead there have none.
TEST(Likeness, ACircleIsRefused) {
  EXPECT_EQ(only_finding(with_sensor(shipped_text("paper_planned"),
                                     "a: {like: b}\n  b: {like: c}\n  c: {like: d}\n  d: {like: b}")),
            "sensors.b.like = c: must not lead back to b: b is like c, which is like d, which is like b");
  EXPECT_EQ(only_finding(support::replaced_first(shipped_text("paper_planned"), "\npdus:\n",
                                                 "\npdus:\n  a: {like: b}\n  b: {like: a, sensor: laser}\n")),
            "pdus.a.like = b: must not lead back to a: a is like b, which is like a");
}

// All keys are the entry's own, as where a file changes a whole sensor of the file that it extends.
TEST(Likeness, WithoutEffectIsRefused) {
  const std::string text = whole_text("paper_planned");
  const std::string words = " has each of its keys itself, here or in a file that this one extends";
  EXPECT_EQ(
      only_finding(support::replaced_first(text, "\n  laser:\n    \\{kind", "\n  laser:\n    {like: camera, kind")),
      "sensors.laser.like = camera: has no effect: laser" + words);
  EXPECT_EQ(only_finding(support::replaced_first(shipped_text("paper_planned"), "\n  laser_scan:\n",
                                                 "\n  laser_scan:\n    like: image\n")),
            "pdus.laser_scan.like = image: has no effect: laser_scan" + words);
}

// An inherited mistake is said of the entry that has the value; else it stands where `like` does, without a value.
TEST(Likeness, AFindingQuotesWrittenValuesAlone) {
  const std::string text = with_sensor(shipped_text("paper_planned"), "rear: {like: laser}");
  const auto repeated =
      findings_of(support::replaced(text, "repetition: 4, offset: 6495", "repetition: 3, offset: 6495"));
  ASSERT_EQ(repeated.size(), 1U) << sentences(repeated);
  EXPECT_EQ(repeated[0].key, "sensors.laser.repetition");
  const auto findings = findings_of(support::replaced_first(text, "like: laser", "like: laser, device: gateway"));
  ASSERT_EQ(findings.size(), 2U) << sentences(findings);
  EXPECT_EQ(findings[0].value, "gateway");
  EXPECT_EQ(findings[1].key + " = " + findings[1].value, "sensors.rear.host = ");
  EXPECT_TRUE(findings[1].expected.ends_with("; sensors.laser has the value laser_pre")) << findings[1].expected;
  EXPECT_EQ(findings[1].line, findings[0].line);
}

// The copy says its needs: no file can give the slots, instants and parts of a copy.
TEST(SensorCopy, SaysHowManySlotsItNeeds) {
  const std::string text = with_sensor(shipped_text("paper_synchronised"), "rear: {like: laser}");
  EXPECT_EQ(only_finding(text),
            "sensors.rear.like = laser: needs 9 free static slots for rear_objects among the 40 of a cycle "
            "(flexray.gNumberOfStaticSlots): its list finds no free static slots one behind the other");
  EXPECT_EQ(only_finding(support::replaced(text, "gNumberOfStaticSlots: \\d+", "gNumberOfStaticSlots: 34")),
            "sensors.rear.like = laser: needs 10 free static slots, one of them the key slot of rear_pre: all 34 of a "
            "cycle are taken (flexray.gNumberOfStaticSlots)");
}

TEST(SensorCopy, SaysWhichTaskHasNoTime) {
  const std::string text = with_sensor(shipped_text("paper_earliest"), "rear: {like: laser}");
  EXPECT_EQ(
      only_finding(
          support::replaced_first(text, "(\n      fuse_laser:\n( {8}.*\n)*? {8}worst_case:) [^\n]*", "$1 16 ms")),
      "sensors.rear.like = laser: needs an instant for nodes.fusion.tasks.fuse_rear.activation: the other tasks of "
      "the node leave no time for it");
}

TEST(SensorCopy, NoFileChangesItsParts) {
  const std::string shipped =
      with_sensor(shipped_text("closed_loop_planned"), "rear: {like: left}\n  left: {like: laser}");
  const std::string words =
      ": is a name of rear's copied parts, which cannot be changed; a file has all parts of a sensor, with its device "
      "and host, or none of them";
  const std::pair<const char*, const char*> parts[] = {{"nodes", "rear_pre: {drift_ppm: 10}"},
                                                       {"nodes", "rear: {tasks: {}}"},
                                                       {"pdus", "rear_objects: {max_elements: 9}"},
                                                       {"can", "rear_can: {other_load: 0.1}"}};
  for (const auto& [section, part] : parts) {
    const std::string head = std::string("\n") + section + ":\n", entry = part;
    EXPECT_EQ(only_finding(support::replaced_first(shipped, head, head + "  " + entry + "\n")),
              std::string(section) + "." + entry.substr(0, entry.find(':')) + words);
  }
}

TEST(Likeness, AnExperimentVariesWhatIsInherited) {
  const ClusterText text{with_sensor(shipped_text("paper_planned"), "rear: {like: laser}"), "cluster.yaml", {}};
  EXPECT_TRUE(leaves_out(text, "sensors.rear.offset"));
  EXPECT_FALSE(leaves_out(text, "sensors.laser.offset"));
  const model::Cluster later = parse_cluster(with_key(text, "sensors.rear.offset", "700"));
  EXPECT_EQ(later.sensor(*later.find_sensor("rear")).at.offset.value, 700);
}

TEST(Likeness, APduMayBeLikeOneThatIsLikeAThird) {
  const std::string text = support::replaced(shipped_text("paper_planned"), "\npdus:\n",
                                             "\npdus:\n  a: {like: b, max_elements: 2}\n  b: {like: image}\n");
  const auto findings = findings_of(text);
  for (const Finding& finding : findings) EXPECT_FALSE(finding.key.ends_with(".like")) << finding.sentence();
  const model::Cluster cluster = parse_cluster(text, "like.yaml");
  const model::PduLayout &a = cluster.pdu(*cluster.find_pdu("a")), &image = cluster.pdu(*cluster.find_pdu("image"));
  EXPECT_EQ(a.max_elements, 2);
  EXPECT_EQ(dump("", a.element), dump("", image.element));
}

}  // namespace
}  // namespace ttf::schedules::file
