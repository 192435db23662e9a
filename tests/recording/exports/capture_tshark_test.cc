// A drive's capture as Wireshark's dissectors see it: every frame must match the log. Skipped without tshark.
#include <fstream>

#include "tests/recording/exports/tshark.h"

namespace ttf::recording::exports {
namespace {

sim::drives::Drive paper_drive() { return {"scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kTt}; }

struct SymbolCounts {
  int cas = 0, wakeup = 0;
};

SymbolCounts compare(const sim::drives::Drive& drive, std::size_t flip_every, std::size_t at_least) {
  const std::string path = drive_log(drive);
  records::Sink nobody;
  const log::LogInfo info = log::read_log(path, nobody);
  std::vector<SensorId> sensors;
  for (const schedules::model::PduLayout& pdu : drive.cluster.pdus) sensors.push_back(pdu.sensor);
  FrameCollector collector;
  Expectation expected(collector, info.manifest, sensors, flip_every);
  log::read_log(path, expected);
  if (flip_every > 0) {
    EXPECT_GT(expected.flipped(), 512u) << "every bit of a frame";
  }
  EXPECT_GT(expected.lines.size(), at_least);

  const std::string file = log::scratch("drive.pcapng");
  {
    std::ofstream out(file, std::ios::binary);
    out << export_pcapng(collector, collector.in_order(), LogNames(info.manifest));
  }
  std::vector<CapturedLine>& lines = expected.lines;
  std::stable_sort(lines.begin(), lines.end(),
                   [](const CapturedLine& a, const CapturedLine& b) { return a.time_ns < b.time_ns; });
  const std::vector<std::string> seen = tshark(file);
  EXPECT_EQ(seen.size(), lines.size());
  int differing = 0;
  for (std::size_t i = 0; i < std::min(seen.size(), lines.size()) && differing < 5; ++i) {
    const std::string line = seconds(lines[i].time_ns) + "\t" + lines[i].text;
    EXPECT_EQ(seen[i], line) << "packet " << i + 1;
    differing += seen[i] != line ? 1 : 0;
  }
  return {expected.cas(), expected.wakeup()};
}

TEST(CaptureTshark, EveryFrameOfADriveIsWhatTheLogSays) {
  if (!has_tshark()) GTEST_SKIP() << "tshark is not installed (tools/install_deps.sh)";
  compare(paper_drive(), 0, 20'000);
}

TEST(CaptureTshark, EveryFrameWithAFlippedBitCarriesTheFlagsOfTheChecksItFails) {
  if (!has_tshark()) GTEST_SKIP() << "tshark is not installed (tools/install_deps.sh)";
  compare(paper_drive(), 50, 20'000);
}

TEST(CaptureTshark, TheSymbolsOfAStartUpArePacketsOfTheirOwn) {
  if (!has_tshark()) GTEST_SKIP() << "tshark is not installed (tools/install_deps.sh)";
  sim::drives::Drive drive("scenarios/cold_start.yaml", fusion::strategies::StrategyKind::kTt);
  drive.scenario.startup.wake_up = "fusion";
  const SymbolCounts symbols = compare(drive, 0, 1'000);
  EXPECT_EQ(symbols.cas, 2) << "on both channels";
  EXPECT_EQ(symbols.wakeup, 1) << "on its wake-up channel";
}

}  // namespace
}  // namespace ttf::recording::exports
