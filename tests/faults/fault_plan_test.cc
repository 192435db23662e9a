// The allowed keys of a list of faults, kind by kind; each mistake gives one sentence.
#include "faults/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "schedules/file/loader.h"

namespace ttf::faults {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr Duration kLatest = Duration::milliseconds(3'000);

struct Read {
  FaultPlan plan;
  std::vector<std::string> sentences;
};

Read read(const std::string& entries) {
  const StrictYaml yaml = StrictYaml::parse("faults:\n" + entries, "drive.yaml");
  Findings findings;
  YamlMap root = yaml.root(findings);
  Read result;
  result.plan = load_fault_plan(root, kLatest);
  root.finish();
  for (const Finding& finding : findings.list()) result.sentences.push_back(finding.sentence());
  return result;
}

// Every key of a kind, with a non-default value.
const std::map<std::string, std::vector<std::string>> kFullEntries = {
    {"crash", {"node: a", "from: 1 ms", "duration: 2 ms"}},
    {"omission",
     {"node: a", "direction: both", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5", "every: 3"}},
    {"babbling_idiot",
     {"node: a", "signal: noise", "length: 5 us", "interval: 10 us", "jitter: 1 us", "channels: B", "from: 1 ms",
      "duration: 2 ms"}},
    {"masquerading",
     {"node: a", "mode: own_slot", "slot: 2", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5",
      "every: 3"}},
    {"sos_timing",
     {"node: a", "shift: -3 us", "receivers: [b, c]", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5",
      "every: 3"}},
    {"sos_value",
     {"node: a", "receivers: [b]", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5", "every: 3"}},
    {"bit_flip_header",
     {"node: a", "bits: [0, 39]", "receivers: [b]", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5",
      "every: 3"}},
    {"bit_flip_payload",
     {"node: a", "flips: 6", "receivers: [b]", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5",
      "every: 3"}},
    {"bit_flip_trailer",
     {"node: a", "flips: 24", "receivers: [b]", "channels: A", "from: 1 ms", "duration: 2 ms", "probability: 0.5",
      "every: 3"}},
    {"channel_swap", {"node: a", "from: 1 ms", "duration: 2 ms", "probability: 0.5", "every: 3"}},
    {"byzantine_clock", {"node: a", "shift: 5 us", "pattern: pull_rates", "from: 1 ms", "duration: 2 ms"}},
    {"drift", {"node: a", "drift: -4000.001", "from: 1 ms"}},
    {"lone_coldstart", {"node: a", "others: all", "from: 1 ms", "duration: 2 ms"}},
    {"duplicate_coldstart",
     {"node: a", "mode: cas", "interval: 7 ms", "jitter: 1 ms", "channels: A", "from: 1 ms", "duration: 2 ms"}},
    {"wrong_schedule", {"node: a", "mode: static_slot", "by: 2"}},
    {"noise", {"length: 5 us", "interval: 10 us", "jitter: 1 us", "channels: B", "from: 1 ms", "duration: 2 ms"}},
    {"transient", {"channels: A", "from: 1 ms", "duration: 2 ms"}},
    {"can_omission",
     {"node: a", "can: x", "direction: both", "from: 1 ms", "duration: 2 ms", "probability: 0.5", "every: 3"}},
    {"can_corruption",
     {"node: a", "can: x", "bit: 25", "receivers: [b]", "from: 1 ms", "duration: 2 ms", "probability: 0.5",
      "every: 3"}},
    {"can_babbling",
     {"node: a", "can: x", "identifier: 7", "interval: 10 us", "jitter: 1 us", "from: 1 ms", "duration: 2 ms"}},
    {"can_bus_off", {"node: a", "can: x", "from: 1 ms", "duration: 2 ms"}},
    {"can_stuck_dominant", {"node: a", "can: x", "from: 1 ms", "duration: 2 ms"}},
    {"can_no_acknowledgement", {"node: a", "can: x", "from: 1 ms", "duration: 2 ms"}},
};

std::string entry(const std::string& kind, const std::vector<std::string>& keys) {
  std::string text = "  - kind: " + kind + "\n";
  for (const std::string& key : keys) text += "    " + key + "\n";
  return text;
}

TEST(FaultPlan, EveryKindHasANameOfItsOwnAndAnEntryHere) {
  std::set<std::string> names;
  for (const FaultKind kind : kAllFaultKinds) {
    EXPECT_TRUE(names.insert(std::string(name_of(kind))).second) << name_of(kind);
    EXPECT_TRUE(kFullEntries.contains(std::string(name_of(kind)))) << name_of(kind);
  }
  EXPECT_EQ(names.size(), 23U);
}

// The compile-time requirements of the tables of kinds.
struct OfAKind {
  FaultKind kind{};
};
constexpr std::array<OfAKind, kFaultKinds> of_every_kind() {
  std::array<OfAKind, kFaultKinds> rows{};
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].kind = kAllFaultKinds[k];
  return rows;
}
static_assert(is_one_row_a_kind(of_every_kind()));

TEST(FaultPlan, ATableThatLacksAKindIsNone) {
  auto lacking = of_every_kind();
  lacking.back() = {};  // as where a row was not written
  EXPECT_FALSE(is_one_row_a_kind(lacking));
  auto in_disorder = of_every_kind();
  std::swap(in_disorder[1], in_disorder[2]);
  EXPECT_FALSE(is_one_row_a_kind(in_disorder));
  EXPECT_FALSE(is_one_row_a_kind(std::array<OfAKind, 1>{}));
}

TEST(FaultPlan, EveryKindAndItsKeysAreDocumented) {
  std::ifstream file(TTF_SOURCE_DIR "/docs/reference/faults.md");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  for (const auto& [kind, keys] : kFullEntries) {
    const auto row = text.find("\n| `" + kind + "` |");
    ASSERT_NE(row, std::string::npos) << kind;
    const std::string line = text.substr(row + 1, text.find('\n', row + 1) - row);
    for (const std::string& entry : keys) {
      const std::string key = entry.substr(0, entry.find(':'));
      const bool common = text.find("\n| `" + key + "` |") != std::string::npos;
      EXPECT_TRUE(common || line.find('`' + key) != std::string::npos) << kind << " has " << key;
    }
  }
}

TEST(FaultPlan, EveryKeyOfEveryKindIsReadAndNoOtherIsTaken) {
  for (const auto& [kind, keys] : kFullEntries) {
    SCOPED_TRACE(kind);
    const Read full = read(entry(kind, keys));
    EXPECT_THAT(full.sentences, ElementsAre());
    ASSERT_EQ(full.plan.faults.size(), 1U);
    EXPECT_EQ(name_of(full.plan.faults[0].kind), kind);
    EXPECT_EQ(full.plan.faults[0].line, 2);
    for (std::size_t left_out = 0; left_out < keys.size(); ++left_out) {
      // Without the key, something is another, or the key is missed.
      std::vector<std::string> fewer = keys;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(left_out));
      const Read less = read(entry(kind, fewer));
      const std::string& key = keys[left_out];
      if (key == "signal: noise" || key == "mode: cas") continue;  // the default, so that the other keys are there
      EXPECT_TRUE(!less.sentences.empty() || !(less.plan.faults[0] == full.plan.faults[0])) << key;
    }
    std::vector<std::string> more = keys;
    more.push_back("weather: rain");
    const Read unknown = read(entry(kind, more));
    ASSERT_EQ(unknown.sentences.size(), 1U);
    EXPECT_THAT(unknown.sentences[0], HasSubstr("drive.yaml:" + std::to_string(keys.size() + 3) +
                                                ": faults[0].weather: is not a known key here"));
  }
}

TEST(FaultPlan, AKindTakesNoKeyOfAnother) {
  std::set<std::string> all;
  for (const auto& [kind, keys] : kFullEntries) all.insert(keys.begin(), keys.end());
  for (const auto& [kind, keys] : kFullEntries) {
    std::set<std::string> own;
    for (const std::string& key : keys) own.insert(key.substr(0, key.find(':')));
    if (kind.starts_with("bit_flip")) own.insert({"bits", "flips"});
    if (kind == "duplicate_coldstart" || kind == "wrong_schedule") own.insert("slot");  // for other modes
    for (const std::string& foreign : all) {
      if (own.contains(foreign.substr(0, foreign.find(':')))) continue;
      std::vector<std::string> keys_and_it = keys;
      keys_and_it.push_back(foreign);
      EXPECT_EQ(read(entry(kind, keys_and_it)).sentences.size(), 1U) << kind << " with " << foreign;
    }
  }
}

TEST(FaultPlan, ModesHaveKeysOfTheirOwn) {
  EXPECT_EQ(read("  - {kind: babbling_idiot, node: a, signal: frame, length: 5 us}\n").sentences.size(), 1U);
  EXPECT_TRUE(read("  - {kind: duplicate_coldstart, node: a, mode: same_key_slot, slot: 3}\n").sentences.empty());
  EXPECT_EQ(read("  - {kind: duplicate_coldstart, node: a, mode: same_key_slot, from: 1 ms}\n").sentences.size(), 1U);
  EXPECT_EQ(read("  - {kind: duplicate_coldstart, node: a, mode: startup_frames, interval: 1 ms}\n").sentences.size(),
            1U);
  EXPECT_TRUE(read("  - {kind: wrong_schedule, node: a, mode: key_slot, slot: 3}\n").sentences.empty());
  EXPECT_EQ(read("  - {kind: wrong_schedule, node: a, mode: key_slot, slot: 3, by: 1}\n").sentences.size(), 1U);
  EXPECT_EQ(read("  - {kind: wrong_schedule, node: a, by: 1}\n").sentences.size(), 1U);
}

struct Mutation {
  std::string text, says;
};

TEST(FaultPlan, MistakesAreSaidInOneSentence) {
  const std::vector<Mutation> mutations = {
      {"{kind: crsh, node: a}", "faults[0].kind = crsh: must be one of crash, omission"},
      {"{node: a}", "faults[0].kind: is missing"},
      {"{kind: crash}", "faults[0].node: is missing"},
      {"{kind: crash, node: a, from: 3001 ms}",
       "faults[0].from = 3001 ms: must be a time with its unit (ns, us, ms or s), 0 ms..3000 ms"},
      {"{kind: crash, node: a, from: 5}", "faults[0].from = 5: must be a time with its unit"},
      {"{kind: crash, node: a, duration: 0 ms}", "faults[0].duration = 0 ms: must be a time"},
      {"{kind: omission, node: a, probability: 1.01}", "faults[0].probability = 1.01: must be a number 0..1"},
      {"{kind: omission, node: a, probability: nan}", "faults[0].probability = nan: must be a number 0..1"},
      {"{kind: omission, node: a, every: 0}", "faults[0].every = 0: must be a whole number 1..1000000 frames"},
      {"{kind: omission, node: a, direction: up}", "faults[0].direction = up: must be one of send, receive, both"},
      {"{kind: omission, node: a, channels: C}", "faults[0].channels = C: must be one of A, B, AB"},
      {"{kind: omission, node: a, node: b}", "faults[0].node: is given twice in one mapping"},
      {"{kind: masquerading, node: a}", "faults[0].slot: is missing: must be a whole number 1..1023"},
      {"{kind: masquerading, node: a, slot: 1024}", "faults[0].slot = 1024: must be a whole number 1..1023"},
      {"{kind: sos_timing, node: a}", "faults[0].shift: is missing"},
      {"{kind: sos_timing, node: a, shift: -10 us}", "faults[0].shift = -10 us: must be a time"},
      {"{kind: sos_timing, node: a, shift: 0 us}", "faults[0].shift = 0 us: must not be 0"},
      {"{kind: sos_timing, node: a, shift: 1 us, receivers: [b, c, b]}",
       "faults[0].receivers: must be different nodes"},
      {"{kind: sos_timing, node: a, shift: 1 us, receivers: b}", "faults[0].receivers = b: must be a list"},
      {"{kind: sos_timing, node: a, shift: 1 us, receivers: []}",
       "faults[0].receivers: must be a list with at least one entry"},
      {"{kind: sos_timing, node: a, shift: 1 us, receivers: [[b]]}", "faults[0].receivers[0]: must be a plain value"},
      {"{kind: bit_flip_header, node: a, bits: [40]}", "faults[0].bits[0] = 40: must be a whole number 0..39"},
      {"{kind: bit_flip_trailer, node: a, bits: [1, 24]}", "faults[0].bits[1] = 24: must be a whole number 0..23"},
      {"{kind: bit_flip_payload, node: a, bits: [2032]}", "faults[0].bits[0] = 2032: must be a whole number 0..2031"},
      {"{kind: bit_flip_payload, node: a, bits: [7, 3, 7]}", "faults[0].bits: must be different bits"},
      {"{kind: bit_flip_payload, node: a, bits: [7], flips: 2}", "faults[0].flips = 2: must not be given with bits"},
      {"{kind: bit_flip_payload, node: a, flips: 25}", "faults[0].flips = 25: must be a whole number 1..24"},
      {"{kind: byzantine_clock, node: a, shift: 9001 ns}", "faults[0].shift = 9001 ns: must be a time"},
      {"{kind: drift, node: a}", "faults[0].drift: is missing"},
      {"{kind: drift, node: a, drift: 50000.001}",
       "faults[0].drift = 50000.001: must be a decimal number -50000..50000 ppm"},
      {"{kind: wrong_schedule, node: a, mode: cycle_length, by: 0}",
       "faults[0].by = 0: must be a whole number 1..1000 macroticks"},
      {"{kind: noise, node: a}", "faults[0].node: is not a known key here"},
      {"{kind: noise, length: 101 ms}", "faults[0].length = 101 ms: must be a time"},
      {"{kind: transient}", "faults[0].duration: is missing"},
      {"{kind: can_bus_off, node: a}", "faults[0].can: is missing"},
      {"{kind: can_corruption, node: a, can: x, bit: 0}", "faults[0].bit = 0: must be a whole number 1..707"},
      {"{kind: can_babbling, node: a, can: x, identifier: 2048}",
       "faults[0].identifier = 2048: must be a whole number 0..2047"},
      {"crash", "faults[0]: must be a mapping"},
  };
  for (const Mutation& mutation : mutations) {
    const Read result = read("  - " + mutation.text + "\n");
    ASSERT_EQ(result.sentences.size(), 1U) << mutation.text;
    EXPECT_THAT(result.sentences[0], HasSubstr("drive.yaml:2: " + mutation.says)) << mutation.text;
  }
  const Read none = read("  {}\n");
  EXPECT_THAT(none.sentences, ElementsAre("drive.yaml:2: faults: must be a list of mappings"));
}

schedules::model::Cluster paper() {
  return schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml");
}

std::vector<std::string> refused(const std::string& entries, const schedules::model::Cluster& cluster) {
  const Read result = read(entries);
  EXPECT_THAT(result.sentences, ElementsAre());
  std::vector<std::string> sentences;
  try {
    resolve(result.plan, cluster);
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings()) sentences.push_back(finding.sentence());
  }
  return sentences;
}

TEST(FaultPlan, NamesAreLookedUpInTheCluster) {
  const schedules::model::Cluster cluster = paper();
  std::vector<NodeId> on_bus;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    if (cluster.nodes[n].flexray) on_bus.push_back(static_cast<NodeId>(n));
  ASSERT_GE(on_bus.size(), 3U);
  const auto name = [&](std::size_t i) { return cluster.node(on_bus[i]).name; };
  const Read result = read("  - {kind: sos_timing, node: " + name(2) + ", shift: 2 us, receivers: [" + name(0) + ", " +
                           name(1) + "]}\n  - {kind: noise}\n");
  const FaultPlan plan = resolve(result.plan, cluster);
  ASSERT_EQ(plan.faults.size(), 2U);
  EXPECT_EQ(plan.faults[0].node, on_bus[2]);
  EXPECT_THAT(plan.faults[0].receivers, ElementsAre(on_bus[0], on_bus[1]));
  EXPECT_EQ(plan.faults[1].node, kNoNode);
  EXPECT_THAT(refused("  - {kind: sos_value, node: " + name(0) + ", receivers: [" + name(0) + "]}\n", cluster),
              ElementsAre(HasSubstr("faults[0].receivers = " + name(0) + ": must be another node")));
  // Resolving again changes nothing.
  EXPECT_EQ(resolve(plan, cluster).faults, plan.faults);
}

TEST(FaultPlan, NodesSlotsAndBitsThatTheClusterHasNotAreRefused) {
  schedules::model::Cluster cluster = paper();
  for (auto node = cluster.nodes.rbegin(); node != cluster.nodes.rend(); ++node)
    if (node->flexray) {
      node->flexray->pKeySlotUsedForStartup = false;
      break;
    }
  std::string off_bus, not_coldstart, on_bus;
  for (const schedules::model::Node& node : cluster.nodes) {
    if (!node.flexray)
      off_bus = node.name;
    else if (!node.flexray->pKeySlotUsedForStartup)
      not_coldstart = node.name;
    else
      on_bus = node.name;
  }
  ASSERT_FALSE(off_bus.empty() || not_coldstart.empty() || on_bus.empty());
  const auto sentences = refused(
      "  - {kind: crash, node: nobody}\n  - {kind: crash, node: " + off_bus + "}\n" + "  - {kind: sos_value, node: " +
          on_bus + ", receivers: [nobody]}\n" + "  - {kind: masquerading, node: " + on_bus + ", slot: 1023}\n" +
          "  - {kind: lone_coldstart, node: " + not_coldstart + "}\n" + "  - {kind: bit_flip_payload, node: " + on_bus +
          ", bits: [2031]}\n" + "  - {kind: wrong_schedule, mode: shifted_slots, by: 1022, node: " + on_bus + "}\n",
      cluster);
  ASSERT_EQ(sentences.size(), 7U);
  EXPECT_THAT(sentences[0], HasSubstr("drive.yaml:2: faults[0].node = nobody: must be a node of "));
  std::string names;
  for (const schedules::model::Node& node : cluster.nodes)
    if (node.flexray) names += (names.empty() ? ": " : ", ") + node.name;
  EXPECT_THAT(sentences[0], testing::EndsWith(cluster.name + names));
  EXPECT_THAT(sentences[1], HasSubstr("drive.yaml:3: faults[1].node = " + off_bus + ": must be on FlexRay of "));
  EXPECT_THAT(sentences[2], HasSubstr("drive.yaml:4: faults[2].receivers = nobody: must be a node of "));
  EXPECT_THAT(sentences[3], HasSubstr("drive.yaml:5: faults[3].slot = 1023: must be 1.."));
  EXPECT_THAT(sentences[4],
              HasSubstr("drive.yaml:6: faults[4].node = " + not_coldstart + ": must be a coldstart node of "));
  EXPECT_THAT(sentences[5], HasSubstr("drive.yaml:7: faults[5].bits = 2031: must be 0.."));
  EXPECT_THAT(sentences[6], HasSubstr("drive.yaml:8: faults[6].by = 1022: must be 1.."));
}

// A fault of a CAN names it, and its node is on it, on FlexRay or not.
TEST(FaultPlan, FaultsOfACanAreThere) {
  const schedules::model::Cluster cluster = paper();
  const Read result = read(
      "  - {kind: can_bus_off, node: laser, can: laser_can}\n"
      "  - {kind: can_corruption, node: laser, can: laser_can, receivers: [laser_pre]}\n");
  const FaultPlan plan = resolve(result.plan, cluster);
  EXPECT_EQ(plan.faults[0].node, *cluster.find_node("laser"));
  EXPECT_EQ(cluster.can_buses[plan.faults[0].can].name, "laser_can");
  EXPECT_EQ(entry_of(plan.faults[0], cluster), "{kind: can_bus_off, node: laser, can: laser_can, from: 0 ms}");
  EXPECT_THAT(plan.faults[1].receivers, ElementsAre(*cluster.find_node("laser_pre")));
  const Read babbling = read(
      "  - {kind: can_babbling, node: laser, can: laser_can, identifier: 1, interval: 20000 ns, from: 1500001 ns}\n");
  EXPECT_THAT(entry_of(resolve(babbling.plan, cluster).faults[0], cluster),
              HasSubstr("identifier: 1, interval: 20 us, jitter: 0 ms, from: 1500001 ns}"));
  const auto sentences = refused(
      "  - {kind: can_bus_off, node: laser, can: wire}\n"
      "  - {kind: can_bus_off, node: camera, can: laser_can}\n"
      "  - {kind: can_babbling, node: laser, can: laser_can, identifier: 256}\n",
      cluster);
  ASSERT_EQ(sentences.size(), 3U);
  EXPECT_THAT(sentences[0], HasSubstr("drive.yaml:2: faults[0].can = wire: must be a CAN of paper_synchronised: "));
  EXPECT_THAT(sentences[1], HasSubstr("drive.yaml:3: faults[1].node = camera: must be on laser_can of "));
  EXPECT_THAT(sentences[2], HasSubstr("drive.yaml:4: faults[2].identifier = 256: must be of no message of "));
}

}  // namespace
}  // namespace ttf::faults
