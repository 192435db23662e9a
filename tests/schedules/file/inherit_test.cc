#include "schedules/file/inherit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/schedules/cluster_dump.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

namespace fs = std::filesystem;

// A folder of cluster files that ends with the test.
class Inherit : public testing::Test {
 protected:
  Inherit()
      : folder_(fs::path(testing::TempDir()) /
                ("inherit_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "base");
    write("base/paper.yaml", shipped_text("paper_synchronised"));
  }
  ~Inherit() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // The mistakes of a file, with the folder left out.
  std::string mistakes(const std::string& file) const {
    std::vector<Finding> findings;
    try {
      findings = check::check(load_cluster(file));
    } catch (const InputError& error) {
      findings = error.findings();
    }
    std::string text = sentences(findings);
    const std::string folder = folder_.string() + "/";
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
    return text;
  }

  // The line of the first match in the shipped file that is the base here.
  static std::string base_line(const std::string& words) {
    const std::string text = shipped_text("paper_synchronised");
    return std::to_string(1 +
                          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(words)), '\n'));
  }

  fs::path folder_;
};

TEST_F(Inherit, AFileThatChangesNothingIsItsBase) {
  const model::Cluster own = load_cluster(write("own.yaml", "extends: base/paper.yaml\nname: own\n"));
  EXPECT_EQ(own.name, "own");
  EXPECT_EQ(own.file, path("own.yaml"));
  EXPECT_EQ(dump(own), dump(load_cluster(path("base/paper.yaml"))));
  EXPECT_TRUE(check::check(own).empty());
}

TEST_F(Inherit, TheTextOfALogNeedsNoSecondFile) {
  const model::Cluster own =
      load_cluster(write("own.yaml", "extends: base/paper.yaml\nname: own\nflexray: {gListenNoise: 3}\n"));
  const model::Cluster again = parse_cluster(own.text, "log");
  EXPECT_EQ(again.name, "own");
  EXPECT_EQ(again.flexray.gListenNoise, 3);
  EXPECT_EQ(dump(again), dump(own));
}

TEST_F(Inherit, AFileWithoutABaseKeepsItsText) {
  EXPECT_EQ(load_cluster(path("base/paper.yaml")).text, shipped_text("paper_synchronised"));
}

TEST_F(Inherit, KeysAreChangedAddedAndRemoved) {
  const model::Cluster own = load_cluster(write("own.yaml",
                                                "extends: base/paper.yaml\n"
                                                "name: own\n"
                                                "real_time: ~\n"
                                                "nodes:\n"
                                                "  gateway: {drift_ppm: 3}\n"
                                                "  spare: {microtick: 50, max_drift_ppm: 1, tasks: {}}\n"
                                                "  fusion: {tasks: {fuse: {worst_case: 3 ms}}}\n"));
  EXPECT_FALSE(own.arrival_window.has_value());
  std::vector<std::string> names;
  for (const model::Node& node : own.nodes) names.push_back(node.name);
  EXPECT_EQ(names, (std::vector<std::string>{"laser", "camera", "laser_pre", "camera_pre", "gateway", "spare", "fusion",
                                             "feature"}));
  EXPECT_EQ(own.node(*own.find_node("gateway")).drift_ppb, 3000);
  const model::Task& fuse = own.node(*own.find_node("fusion")).tasks[0];
  EXPECT_EQ(fuse.worst_case, Duration::milliseconds(3));
  EXPECT_EQ(fuse.best_case, Duration::milliseconds(1));
}

TEST_F(Inherit, ABaseMayExtendAThirdFile) {
  write("base/middle.yaml", "extends: paper.yaml\nname: middle\nflexray: {gListenNoise: 3, gColdStartAttempts: 9}\n");
  const model::Cluster own =
      load_cluster(write("own.yaml", "extends: base/middle.yaml\nname: own\nflexray: {gListenNoise: 4}\n"));
  EXPECT_EQ(own.flexray.gListenNoise, 4);
  EXPECT_EQ(own.flexray.gColdStartAttempts, 9);
  EXPECT_EQ(own.flexray.gSyncNodeMax, 5);
}

TEST_F(Inherit, FindingsNameTheFileThatHasTheValue) {
  write("own.yaml",
        "extends: base/paper.yaml\n"
        "name: own\n"
        "flexray:\n"
        "  gListenNoise: 99\n");
  EXPECT_EQ(mistakes(path("own.yaml")), "\n  own.yaml:4: flexray.gListenNoise = 99: must be a whole number 2..16");
  // The checker's: one value of each file is wrong.
  write("own.yaml",
        "extends: base/paper.yaml\n"
        "name: own\n"
        "nodes:\n"
        "  laser_pre: {flexray: {pMicroPerCycle: 200001}}\n"
        "flexray: {gMacroPerCycle: 4999}\n");
  const std::string all = mistakes(path("own.yaml"));
  EXPECT_NE(all.find("own.yaml:5: flexray.gMacroPerCycle = 4999"), std::string::npos) << all;
  EXPECT_NE(all.find("base/paper.yaml:" + base_line("gdCycle: ") + ": flexray.gdCycle = 5000 us"), std::string::npos)
      << all;
  EXPECT_NE(all.find("own.yaml:4: nodes.laser_pre.flexray.pMicroPerCycle = 200001"), std::string::npos) << all;
  EXPECT_NE(all.find("base/paper.yaml:" + base_line("pdListenTimeout: ") + ": nodes.laser_pre.flexray.pdListenTimeout"),
            std::string::npos)
      << all;
  write("own.yaml",
        "extends: base/paper.yaml\nname: own\nflexray: {gdTypo: 1}\nnodes: {laser: {tasks: {measure: {step: ~}}}}\n");
  const std::string keys = mistakes(path("own.yaml"));
  EXPECT_NE(keys.find("own.yaml:3: flexray.gdTypo: is not a known key here"), std::string::npos) << keys;
  EXPECT_NE(keys.find("nodes.laser.tasks.measure.step: is missing: must be a text"), std::string::npos) << keys;
}

TEST_F(Inherit, ASecondPlaceInASentenceNamesItsFileToo) {
  write("own.yaml", "extends: base/paper.yaml\nname: own\nnodes: {gateway: {flexray: {pKeySlotOnlyEnabled: true}}}\n");
  EXPECT_EQ(mistakes(path("own.yaml")),
            "\n  own.yaml:3: nodes.gateway.flexray.pKeySlotOnlyEnabled = true: must be false: gateway also has slot 6 "
            "(base/paper.yaml:" +
                base_line("- {slot: 6") + "), but would send in its key slot only until a host commands ALL_SLOTS");
}

TEST_F(Inherit, BasesThatAreNoneAreRefused) {
  write("a.yaml", "extends: b.yaml\nname: a\n");
  write("b.yaml", "extends: base/../a.yaml\nname: b\n");
  EXPECT_EQ(mistakes(path("a.yaml")),
            "\n  b.yaml:1: extends = base/../a.yaml: must not lead back to a file that extends it; a.yaml:1 leads to "
            "this file");
  write("self.yaml", "name: self\nextends: self.yaml\n");
  EXPECT_EQ(mistakes(path("self.yaml")),
            "\n  self.yaml:2: extends = self.yaml: must not lead back to a file that extends it");
  write("lost.yaml", "extends: nowhere.yaml\n");
  EXPECT_NE(mistakes(path("lost.yaml")).find("lost.yaml:1: extends = nowhere.yaml: must be a cluster file, but it"),
            std::string::npos)
      << mistakes(path("lost.yaml"));
  write("drive.yaml", "name: drive\nworld: {}\n");
  write("wrong.yaml", "extends: drive.yaml\n");
  EXPECT_NE(mistakes(path("wrong.yaml")).find("drive.yaml: this is a scenario, not a cluster"), std::string::npos);
  write("list.yaml", "extends: [a]\n");
  EXPECT_EQ(mistakes(path("list.yaml")), "\n  list.yaml:1: extends: must be a text");
  write("0.yaml", "name: end\nnodes: {}\n");
  for (int i = 1; i <= 16; ++i)
    write(std::to_string(i) + ".yaml", "extends: " + std::to_string(i - 1) + ".yaml\nname: n\n");
  EXPECT_EQ(mistakes(path("16.yaml")),
            "\n  1.yaml:1: extends = 0.yaml: must end after 16 files; 16.yaml:1 leads to this file");
}

// A reader of the sentence finds the own file, whatever is wrong below it.
TEST_F(Inherit, AFindingAboutABaseNamesTheLineThatExtendsIt) {
  const std::string own = "; own.yaml:2 leads to this file";
  const auto said = [&](const std::string& base) {
    write("middle.yaml", "extends: " + base + "\nname: middle\n");
    return mistakes(write("own.yaml", "name: own\nextends: middle.yaml\n"));
  };
  write("broken.yaml", "name: [\n");
  write("drive.yaml", "name: drive\nworld: {}\n");
  write("null.yaml", "extends: base/paper.yaml\nname: null\nsensors: {rear: {like: }}\n");
  write("wrong.yaml", support::replaced(shipped_text("paper_synchronised"), "gListenNoise: \\d+", "gListenNoise: 99"));
  write("unlike.yaml", "extends: base/paper.yaml\nname: unlike\nsensors: {rear: {like: lidar}}\n");
  for (const char* base : {"broken.yaml", "drive.yaml", "null.yaml", "wrong.yaml", "unlike.yaml", "nowhere.yaml"}) {
    const std::string text = said(base);
    EXPECT_TRUE(text.ends_with(own)) << base << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << base << text;
  }
}

// The entry that is like another has the finding, and the sentence says whose value it is.
TEST_F(Inherit, AnEntryLikeOneOfTheBaseHasTheFinding) {
  write("own.yaml",
        "extends: base/paper.yaml\nname: own\nsensors:\n  rear: {like: laser, device: laser, measurement: free, "
        "period: 50 ms}\n");
  EXPECT_EQ(
      mistakes(path("own.yaml")),
      "\n  own.yaml:4: sensors.rear.device = laser: must have exactly one task that rear activates; it has 0"
      "\n  own.yaml:4: sensors.rear.host: must read a PDU of the sensor rear; sensors.laser has the value laser_pre");
}

TEST_F(Inherit, ATextAloneExtendsNothing) {
  const auto findings = findings_of("extends: base/paper.yaml\n" + shipped_text("paper_synchronised"));
  ASSERT_EQ(findings.size(), 1u) << sentences(findings);
  EXPECT_EQ(
      findings[0].sentence(),
      "cluster.yaml:1: extends = base/paper.yaml: must be in a file: a text alone has no folder in which the other "
      "file is");
}

}  // namespace
}  // namespace ttf::schedules::file
