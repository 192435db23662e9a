// Writes a log with every kind of record for other programs' readers, and prints the expected result:
//   sample_log OUT.mcap     {"counts":{"/can_frame":177,...},"hash":"0123456789abcdef"}
#include <fmt/format.h>

#include <array>
#include <map>

#include "recording/log/reader.h"
#include "tests/recording/log/log_fixture.h"

int main(int argc, char** argv) {
  using namespace ttf;
  using namespace ttf::recording;
  using namespace ttf::recording::log;
  if (argc != 2) return 2;
  LogWriter writer(argv[1], sample_manifest());
  writer.attach("cluster.yaml", "application/yaml", "name: paper\n");
  // The first record of each topic with known values, before everything else in time.
  records::ClockCorrected corrected;
  corrected.cycle = 41;
  corrected.offset_microticks = -7;
  corrected.rate_limited = true;
  writer.on(corrected);
  const std::array<double, 6> state{1.5, -2.25, 1e-300, 0, 3, -0.125};
  const std::array<double, 36> covariance{1};
  writer.on(records::TrackState{{}, 9, TrackId{65535}, GlobalTime{-5}, state, covariance, true});
  emit_drive(writer, 3000);
  writer.close();

  records::Sink nothing;
  const LogInfo info = read_log(argv[1], nothing);
  if (!info.warning.empty()) return 1;
  std::map<std::string_view, std::uint64_t> counts;
  for (std::size_t i = 0; i < records::kKindCount; ++i) counts[records::kTopics[i]] = info.counts[i];
  std::string text;
  for (const auto& [topic, count] : counts) text += fmt::format("{}\"{}\":{}", text.empty() ? "" : ",", topic, count);
  fmt::print("{{\"counts\":{{{}}},\"hash\":\"{}\"}}\n", text, writer.content_hash_text());
  return 0;
}
