// A drive's capture as Wireshark's own dissectors see it: every frame must be what the log says. Skipped without
// tshark.
#include <fstream>

#include "tests/recording/tshark.h"

namespace ttf::recording {
namespace {

void compare(std::size_t flip_every) {
  const testing_support::Drive drive("scenarios/paper_scenario1.yaml", fusion::StrategyKind::kTt);
  const std::string path = drive_log(drive);
  records::Sink nobody;
  const LogInfo info = read_log(path, nobody);
  std::vector<SensorId> sensors;
  for (const schedules::PduLayout& pdu : drive.cluster.pdus) sensors.push_back(pdu.sensor);
  FrameCollector collector;
  Expectation expected(collector, info.manifest, sensors, flip_every);
  read_log(path, expected);
  if (flip_every > 0) {
    EXPECT_GT(expected.flipped(), 512u) << "every bit of a frame";
  }
  ASSERT_GT(expected.lines.size(), 20'000u);

  const std::string file = scratch("drive.pcapng");
  {
    std::ofstream out(file, std::ios::binary);
    out << export_pcapng(collector, collector.in_order(), LogNames(info.manifest));
  }
  std::vector<CapturedLine>& lines = expected.lines;
  std::stable_sort(lines.begin(), lines.end(), [](const CapturedLine& a, const CapturedLine& b) { return a.time_ns < b.time_ns; });
  const std::vector<std::string> seen = tshark(file);
  ASSERT_EQ(seen.size(), lines.size());
  int differing = 0;
  for (std::size_t i = 0; i < lines.size() && differing < 5; ++i) {
    const std::string line = seconds(lines[i].time_ns) + "\t" + lines[i].text;
    EXPECT_EQ(seen[i], line) << "packet " << i + 1;
    differing += seen[i] != line ? 1 : 0;
  }
}

TEST(CaptureTshark, EveryFrameOfADriveIsWhatTheLogSays) {
  if (!has_tshark()) GTEST_SKIP() << "tshark is not installed (tools/install_deps.sh)";
  compare(0);
}

TEST(CaptureTshark, EveryFrameWithAFlippedBitCarriesTheFlagsOfTheChecksItFails) {
  if (!has_tshark()) GTEST_SKIP() << "tshark is not installed (tools/install_deps.sh)";
  compare(50);
}

}  // namespace
}  // namespace ttf::recording
