// The modes of a task in a cluster file: one sentence for each mistake, with its line and key.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "schedules/modes/stated.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules::file {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kModes = "adaptive_loop_modes";
const std::string kPath = "nodes.detector.tasks.detect.";

struct Change {
  std::string from, to;  // its first match becomes this
};
std::string changed(const std::vector<Change>& changes, const std::string& file = kModes) {
  std::string text = shipped_text(file);
  for (const Change& change : changes) {
    const std::size_t at = text.find(change.from);
    if (at == std::string::npos) return "no " + change.from;
    text.replace(at, change.from.size(), change.to);
  }
  return text;
}

// Returns the only sentence, or all of them.
std::string sentence_after(const std::vector<Change>& changes) {
  const std::vector<Finding> findings = findings_of(changed(changes));
  return findings.size() == 1 ? findings[0].sentence() : std::to_string(findings.size()) + ":" + sentences(findings);
}
// The number of the line that has these words.
std::string line_of_words(const std::string& text, const std::string& words) {
  return std::to_string(1 +
                        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(words)), '\n'));
}

const std::string kFirst = "{cycle: 0, camera: camera_a, look: primary, lasts: 59 ms}";
const std::string kSecond = "{cycle: 12, camera: camera_b, look: primary, lasts: 59 ms}";

TEST(LoadModes, OfTheShippedCluster) {
  const model::Cluster cluster = load_cluster(shipped_path(kModes));
  const model::Task& task = cluster.node(*cluster.find_node("detector")).tasks.at(0);
  EXPECT_EQ(task.activation.kind, model::ActivationKind::kModes);
  ASSERT_EQ(task.modes.size(), 2u);
  EXPECT_EQ(task.modes[1].name, "AaBaCa");
  EXPECT_EQ(task.modes[1].cycles, 60);
  ASSERT_EQ(task.modes[1].instants.size(), 6u);
  EXPECT_EQ(task.modes[1].instants[3].cycle, 32);
  EXPECT_EQ(task.modes[1].instants[3].camera, 0u);
  EXPECT_TRUE(task.modes[1].instants[3].secondary);
  EXPECT_EQ(task.modes[1].instants[3].lasts, Duration::milliseconds(39));
}

TEST(LoadModes, AMistakeIsNamedWithItsLine) {
  const std::string at = line_of_words(shipped_text(kModes), kSecond);
  const std::string key = "cluster.yaml:" + at + ": " + kPath + "modes.ABC.detections[1].";
  EXPECT_EQ(sentence_after({{kSecond, "{cycle: 36, camera: camera_b, look: primary, lasts: 59 ms}"}}).substr(0, 200),
            key + "cycle = 36: must be below the frame of 36 cycles");
  EXPECT_EQ(sentence_after({{kSecond, "{cycle: 0, camera: camera_b, look: primary, lasts: 59 ms}"}}),
            key + "cycle = 0: must be above 0, the cycle of the detection before");
  EXPECT_EQ(sentence_after({{kSecond, "{cycle: 13, camera: camera_b, look: primary, lasts: 59 ms}"}}),
            key + "cycle = 13: must be a multiple of 2, the repetition of the activation");
  EXPECT_THAT(sentence_after({{kSecond, "{cycle: 12, camera: camera_d, look: primary, lasts: 59 ms}"}}),
              StartsWith(key + "camera = camera_d: must be a camera of the task: camera_a, camera_b or camera_c"));
  EXPECT_THAT(sentence_after({{kSecond, "{cycle: 12, camera: regions, look: primary, lasts: 59 ms}"}}),
              HasSubstr("camera = regions: must be a camera of the task"));
  EXPECT_THAT(sentence_after({{kSecond, "{cycle: 12, camera: camera_b, look: twice, lasts: 59 ms}"}}),
              HasSubstr(key + "look = twice: must be"));
  EXPECT_THAT(sentence_after({{kSecond, "{cycle: 12, camera: camera_b, look: primary, lasts: 60 ms}"}}),
              HasSubstr(key + "lasts = 60 ms: must be"));
  EXPECT_THAT(sentence_after({{kFirst, "{cycle: 2, camera: camera_a, look: primary, lasts: 59 ms}"}}),
              HasSubstr("detections[0].cycle = 2: must be 0: a frame begins with its first detection"));
  EXPECT_THAT(sentence_after({{"frame: 36", "frame: 37"}}),
              HasSubstr("modes.ABC.frame = 37: must be a multiple of 2, the repetition of the activation"));
  EXPECT_THAT(sentence_after({{kSecond, "{cycle: 12, camera: camera_b, look: secondary, lasts: 39 ms}"}}),
              HasSubstr("modes.ABC.detections: must have a primary detection of camera_b"));
}

TEST(LoadModes, AFrameHasDetectionsAndATaskHasModes) {
  const std::string text = shipped_text(kModes);
  const std::size_t from = text.find("        modes:\n"), abc = text.find("          ABC:\n"),
                    other = text.find("          AaBaCa:\n"), reads = text.find("        reads:", other);
  const auto words = [](const std::string& changed_text) { return sentences(findings_of(changed_text)); };
  EXPECT_THAT(words(text.substr(0, abc) + "          ABC: {frame: 36, detections: []}\n" + text.substr(other)),
              HasSubstr("modes.ABC.detections: must have at least one detection"));
  EXPECT_THAT(words(text.substr(0, from) + "        modes: {}\n" + text.substr(reads)),
              HasSubstr(kPath + "modes: must have at least one mode"));
  EXPECT_THAT(words(text.substr(0, from) + text.substr(reads)),
              HasSubstr(kPath + "activation = modes: needs the key modes, with at least one mode"));
  EXPECT_THAT(sentence_after({{"kind: modes\n", "kind: time\n"}}),
              HasSubstr(kPath + "modes: must be absent: the task's activation is of another kind"));
}

TEST(LoadModes, ModesMustBeSound) {
  // The detection of 59 ms would run into the next one.
  const std::string early = "{cycle: 10, camera: camera_b, look: primary, lasts: 59 ms}";
  const std::string text = changed({{kSecond, early}});
  EXPECT_THAT(sentence_after({{kSecond, early}}),
              HasSubstr("cluster.yaml:" + line_of_words(text, kFirst) + ": " + kPath +
                        "modes.ABC.detections[0].lasts = 59 ms: must end "));
  EXPECT_THAT(sentence_after({{kSecond, early}}), HasSubstr("before the next detection begins, 50 ms behind this one"));
  EXPECT_THAT(sentence_after({{"draw: worst\n        deadline: 59 ms", "draw: uniform\n        deadline: 59 ms"}}),
              HasSubstr(kPath + "draw = uniform: must be worst"));
  EXPECT_THAT(sentence_after({{"deadline: 59 ms", "deadline: 59 ms\n        holds: 90 ms"}}),
              HasSubstr(kPath + "holds = 90 ms: must be absent"));
  // Lists in every 16th cycle, 80 ms apart, are too slow for detections 40 ms apart.
  EXPECT_THAT(sentence_after({{"base_cycle: 0, repetition: 1, pdu: camera_b_objects",
                               "base_cycle: 0, repetition: 16, pdu: camera_b_objects"}}),
              HasSubstr("must have slots of camera_b_objects between the lists of any two detections"));
  // A second task would delay detections.
  EXPECT_THAT(
      sentences(findings_of(changed({{"  radar_pre:\n    flexray",
                                      "      idle:\n        {step: gateway, activation: {kind: time, base_cycle: 0, "
                                      "repetition: 1, offset: 0}, best_case: 1 us, worst_case: 1 us, draw: worst, "
                                      "deadline: 1 ms}\n  radar_pre:\n    flexray"}}))),
      HasSubstr(kPath + "activation = modes: must be that of the only task of detector"));
}

TEST(StatedModes, AreThoseThatWerePrinted) {
  const model::Cluster cluster = load_cluster(shipped_path("adaptive_loop_synchronised"));
  const NodeId node = *cluster.find_node("detector");
  const modes::Detector detector{node, &cluster.node(node).tasks[0]};
  const modes::Grid grid{Duration::milliseconds(10), Macroticks{3500}};
  const sequence::DetectionTimes times(3, Duration::milliseconds(59), Duration::milliseconds(39));
  std::vector<modes::Mode> placed;
  for (const sequence::Sequence& one :
       {sequence::Sequence{{0, false}, {1, false}, {2, false}},
        sequence::Sequence{{0, false}, {0, true}, {1, false}, {0, true}, {2, false}, {0, true}}}) {
    placed.push_back(modes::placed(cluster, one, times, grid));
    placed.back().name = sequence::letters(one);
  }
  const std::string yaml = modes::yaml_text(cluster, detector, placed, grid);
  EXPECT_THAT(read_file(shipped_path(kModes)), HasSubstr(yaml));
  const model::Cluster pasted = load_cluster(shipped_path(kModes));
  const std::vector<modes::StatedModes> stated = modes::stated_modes(pasted);
  ASSERT_EQ(stated.size(), 1u);
  ASSERT_EQ(stated[0].modes.size(), 2u);
  EXPECT_EQ(stated[0].grid.step, grid.step);
  for (std::size_t m = 0; m < placed.size(); ++m) {
    const modes::Mode &printed = placed[m], &read = stated[0].modes[m];
    EXPECT_EQ(printed.sequence, read.sequence);
    EXPECT_EQ(printed.frame, read.frame);
    for (std::size_t i = 0; i < printed.detections.size(); ++i) {
      EXPECT_EQ(printed.detections[i].begins, read.detections[i].begins);
      EXPECT_EQ(printed.detections[i].worst_case, read.detections[i].worst_case);
      EXPECT_EQ(printed.detections[i].occupied, read.detections[i].occupied);
    }
    // The bounds do not depend on who says the modes.
    for (std::size_t chain = 0; chain < 3; ++chain) {
      const auto before = modes::bounds(cluster, detector, printed, grid, chain);
      const auto after = modes::bounds(pasted, stated[0].detector, read, stated[0].grid, chain);
      ASSERT_EQ(before.size(), 1u) << "a chain leads from one camera";
      ASSERT_EQ(after.size(), 1u);
      EXPECT_EQ(before[0].sensor, static_cast<int>(chain));
      EXPECT_EQ(before[0].most, after[0].most);
      EXPECT_EQ(before[0].reaction, after[0].reaction);
    }
  }
}

// A picture is 1.5 ms old when its detection begins, and a list that just missed is seen by the picture after next.
TEST(StatedModes, BoundsCountFromThePicture) {
  const model::Cluster cluster = load_cluster(shipped_path(kModes));
  const std::vector<modes::StatedModes> stated = modes::stated_modes(cluster);
  ASSERT_EQ(stated.size(), 1u);
  const modes::StatedModes& one = stated[0];
  const auto of_primaries = modes::bounds(cluster, one.detector, one.modes[0], one.grid, 0).at(0),
             of_more = modes::bounds(cluster, one.detector, one.modes[1], one.grid, 0).at(0);
  // The command is read at a known phase: behind 1.5 ms and 59 ms of the detection come 13.7 ms to the fusion, and so on.
  EXPECT_LT(of_primaries.most - of_primaries.least, Duration::milliseconds(1));
  EXPECT_NEAR(in_ms(of_primaries.reaction - of_primaries.most), 180.0 + 0.1, 0.2);
  EXPECT_NEAR(in_ms(of_more.reaction - of_more.most), 300.0 + 0.1, 0.2);
  // Its longest interval is 100 ms, from the region behind B to the one behind C.
  EXPECT_LE(in_ms(of_more.reaction_in_region), in_ms(of_more.most) + 100.2);
  EXPECT_GE(in_ms(of_more.reaction_in_region), in_ms(of_more.least) + 99.8 - 20.0);
}

}  // namespace
}  // namespace ttf::schedules::file
