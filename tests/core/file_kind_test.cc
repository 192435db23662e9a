// A file of another kind is one sentence; a file that may be of the wanted kind is left to its loader.
#include "core/file_kind.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "core/errors.h"
#include "tests/support/refusals.h"

namespace ttf {
namespace {

std::optional<FileKind> kind(const std::string& text) { return kind_of(StrictYaml::parse(text, "a.yaml")); }

std::string refusal(const std::string& text, FileKind wanted) {
  return support::refusal_of([&] { expect_kind(StrictYaml::parse(text, "a.yaml"), wanted); }, "left to the loader");
}

TEST(FileKind, IsRecognisedByKeysThatNoOtherKindHas) {
  EXPECT_EQ(kind("name: a\nclusters: {tt: b}\nfaults: []\n"), FileKind::kScenario);
  EXPECT_EQ(kind("world: {}\n"), FileKind::kScenario);
  EXPECT_EQ(kind("name: a\nnodes: {}\nsensors: {}\n"), FileKind::kCluster);
  EXPECT_EQ(kind("name: a\nkind: sweep\n"), FileKind::kExperiment);
  EXPECT_EQ(kind("name: a\nvariants: {}\nfaults: 3\n"), FileKind::kExperiment);
  EXPECT_EQ(kind("strategy: tt\nother: 1\n"), FileKind::kTrack);
}

TEST(FileKind, IsRecognisedByHavingNoOtherKeys) {
  EXPECT_EQ(kind("tracker: {}\n"), FileKind::kTrack);
  EXPECT_EQ(kind("sensors: {}\ntracker: {}\n"), FileKind::kTrack);
  EXPECT_EQ(kind("faults: []\n"), FileKind::kFaults);
  EXPECT_EQ(kind("name: a\ntracker: {}\n"), std::nullopt);
  EXPECT_EQ(kind("name: a\nfaults: []\n"), std::nullopt);
  EXPECT_EQ(kind("anything: 1\n"), std::nullopt);
}

TEST(FileKind, AnotherKindIsOneSentence) {
  EXPECT_EQ(refusal("nodes: {}\n", FileKind::kScenario),
            "a.yaml: this is a cluster, not a scenario; `ttfusion schedule check` takes it");
  EXPECT_EQ(refusal("clusters: {}\n", FileKind::kCluster),
            "a.yaml: this is a scenario, not a cluster; `ttfusion run` takes it");
  EXPECT_EQ(refusal("faults: []\n", FileKind::kExperiment),
            "a.yaml: this is a fault list, not an experiment; an experiment takes it by the key faults");
  EXPECT_EQ(refusal("kind: sweep\n", FileKind::kTrack),
            "a.yaml: this is an experiment, not a track configuration; `ttfusion experiment` takes it");
  EXPECT_EQ(refusal("tracker: {}\n", FileKind::kFaults),
            "a.yaml: this is a track configuration, not a fault list; `ttfusion track --config` takes it");
}

// Writes a file and returns its path.
std::string written(const char* name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string refusal_of_file(const std::string& path, FileKind wanted) {
  return support::refusal_of([&] { (void)load_of_kind(path, wanted); }, "left to the loader");
}

TEST(FileKind, FormatsOfExchangeAreRecognised) {
  const std::string fibex = written("bus.xml",
                                    "\xef\xbb\xbf<?xml version=\"1.0\"?>\n<!-- ours -->\n"
                                    "<F:FIBEX xmlns:F=\"http://www.asam.net/xml/fbx\"/>\n");
  EXPECT_EQ(kind_of_file(fibex), FileKind::kFibex);
  EXPECT_EQ(kind_of_file("schedules/paper_synchronised.dbc"), FileKind::kDbc);
  EXPECT_EQ(kind_of_file("schedules/paper_synchronised.yaml"), FileKind::kCluster);
  EXPECT_EQ(refusal_of_file(fibex, FileKind::kScenario),
            fibex + ": this is a FIBEX file, not a scenario; `ttfusion schedule export --format yaml` takes it");
  EXPECT_EQ(
      refusal_of_file("schedules/paper_synchronised.dbc", FileKind::kCluster),
      "schedules/paper_synchronised.dbc: this is a DBC file, not a cluster; `ttfusion schedule export` writes such "
      "files, and no command reads them");
  EXPECT_EQ(refusal_of_file("schedules/paper_synchronised.yaml", FileKind::kCluster), "left to the loader");
  EXPECT_THROW(kind_of_file(written("page.xml", "<html/>")), InputError) << "no YAML";
  EXPECT_EQ(kind_of_file(written("words.yaml", "note: |\n  BS_:\n  BU_:\n")), std::nullopt) << "not at a line's begin";
}

TEST(FileKind, LogsAndCapturesBeginWithBytesOfTheirOwn) {
  const std::string log = written("a.mcap", "\x89MCAP0\r\nnothing else");
  EXPECT_EQ(kind_of_file(log), FileKind::kLog);
  EXPECT_EQ(kind_of_file(written("a.pcapng", "\x0a\x0d\x0d\x0a and more")), FileKind::kCapture);
  EXPECT_EQ(kind_of_file(written("a.pcap", "\xd4\xc3\xb2\xa1 and more")), FileKind::kCapture);
  EXPECT_EQ(refusal_of_file(log, FileKind::kScenario),
            log + ": this is a log, not a scenario; `ttfusion diagram` and `ttfusion export` take it");
  EXPECT_NO_THROW(expect_log(log));
  EXPECT_NO_THROW(expect_log(written("cut.mcap", "\x89MC"))) << "the reader tells what is wrong with it";
  EXPECT_NO_THROW(refuse_any_kind(log, "a log"));
  EXPECT_THROW(expect_log("scenarios/dynamics.yaml"), InputError);
}

TEST(FileKind, TheLoaderHasTheRest) {
  EXPECT_EQ(refusal("clusters: {}\n", FileKind::kScenario), "left to the loader");
  EXPECT_EQ(refusal("anything: 1\n", FileKind::kScenario), "left to the loader");
  EXPECT_EQ(refusal("kind: sweep\nclusters: {}\n", FileKind::kScenario), "left to the loader") << "a stray key";
}

TEST(FileKind, ARecordingIsOfNoKind) {
  const auto refusal_of = [](const char* path) -> std::string {
    return support::refusal_of([&] { refuse_any_kind(path, "a recording"); }, "left to the reader");
  };
  EXPECT_EQ(refusal_of("scenarios/dynamics.yaml"),
            "scenarios/dynamics.yaml: this is a scenario, not a recording; `ttfusion run` takes it");
  EXPECT_EQ(refusal_of("README.md"), "left to the reader");
  EXPECT_EQ(refusal_of("absent.csv"), "left to the reader");
}

}  // namespace
}  // namespace ttf
