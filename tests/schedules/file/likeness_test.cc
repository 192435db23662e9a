// Sensors and PDUs that are like others.
#include "schedules/file/likeness/inherit_alike.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

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
  for (const model::Sensor& sensor : cluster.sensors)
    for (const model::Sensor& other : cluster.sensors) {
      if (sensor.name == other.name || (other.phase && !sensor.phase)) continue;
      const support::Match own = entry_of(text, sensor.name);
      std::map<std::string, std::string> keys = keys_of(own[1]), others = keys_of(entry_of(text, other.name)[1]);
      std::string differs = "like: " + other.name;
      for (const auto& [key, value] : keys)
        if (others[key] != value) differs += ", " + key + ": " + value;
      ASSERT_LT(differs.size(), own[1].size() + 20);
      const std::string alike =
          std::string(text).replace(own.at, own.size, "\n  " + sensor.name + ": {" + differs + "}\n");
      EXPECT_EQ(dump(parse_cluster(alike, "like.yaml")), dumped) << differs;
    }
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
            "sensors.rear.like needs a task forward_rear, a name that is taken");
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
      {"rear: {like: lidar}", "rear.like", "must be another sensor of this file: laser, camera, odometry"},
      {"rear: {like: [laser]}", "rear.like", "must be a text"},
      {"rear: {like: ''}", "rear.like", "must be a text"},
      {"rear: {like: rear}", "rear.like", "must be another sensor of this file: laser, camera, odometry"},
      {"rear: {like: left}\n  left: {like: laser, raw: 9, device: laser}", "left.raw",
       "device and host must be left out"},
      {"rear: {like: odometry}", "rear.like", "must be a sensor of objects"},
      {"rear: {like: laser, kind: odometry}", "rear.kind", "must be one of laser, camera, radar"},
      {"rear: {like: laser, kind: mono_camera}", "rear.kind", "must be one of laser, camera, radar"},
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

// Each sensor of the circle has the sentence, and none beside it.
TEST(Likeness, ACircleIsRefused) {
  const auto findings =
      findings_of(with_sensor(shipped_text("paper_planned"),
                              "a: {like: b}\n  b: {like: c}\n  c: {like: b}\n  d: {like: laser, device: a, host: a}"));
  std::set<std::string> keys;
  for (const Finding& finding : findings)
    if (finding.expected.starts_with("must not lead back to ")) keys.insert(finding.key);
  EXPECT_EQ(keys, (std::set<std::string>{"sensors.b.like", "sensors.c.like"})) << sentences(findings);
}

// An inherited mistake stands where the value does.
TEST(Likeness, AFindingHasTheLineOfItsValue) {
  const std::string text = with_sensor(shipped_text("paper_planned"), "rear: {like: laser}");
  const auto findings =
      findings_of(support::replaced(text, "repetition: 4, offset: 6495", "repetition: 3, offset: 6495"));
  ASSERT_EQ(findings.size(), 2U) << sentences(findings);
  EXPECT_EQ(findings[0].key, "sensors.rear.repetition");
  EXPECT_EQ(findings[1].key, "sensors.laser.repetition");
  EXPECT_EQ(findings[0].line, findings[1].line);
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
