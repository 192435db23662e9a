// Any records as a Perfetto trace. Laws: every log gives a sound trace
// (tests/recording/exports/perfetto_trace.h). In it, tracks are described once and before their use, times
// never go back, slices end, flows have two ends. It contains everything that it reports as written. The same
// log gives the same bytes.
//
// Input: messages: kind (1 byte), length (2 bytes), payload.
#include "core/check.h"
#include "recording/exports/perfetto.h"
#include "recording/merge/merge.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/mcap_around.h"
#include "tests/recording/exports/perfetto_trace.h"

namespace {

using namespace ttf;

struct Exported {
  std::string bytes;
  recording::exports::TraceCounts counts;
};

Exported exported(const recording::merge::MergedLogs& log) {
  recording::log::LogManifest names;
  names.node_names = {"laser", "fusion"};
  names.task_names = {{"scan"}, {"fuse", "image"}};
  names.sensor_names = {"laser"};
  Exported result;
  recording::exports::PerfettoExport trace(recording::exports::LogNames(names),
                                           [&](std::string_view more) { result.bytes += more; });
  log.read(trace);
  result.counts = trace.finish();
  return result;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr char kFile[] = "drive.mcap";
  fuzz::Source source(data, size);
  fuzz::Messages messages;
  while (!source.empty()) {
    const auto kind = source.take<std::uint8_t>();
    const auto payload = source.bytes(source.take<std::uint16_t>());
    messages.emplace_back(kind, std::string_view(reinterpret_cast<const char*>(payload.data()), payload.size()));
  }
  std::vector<recording::merge::StoredLog> logs;
  if (!fuzz::accepted(kFile, [&] { logs.emplace_back(fuzz::mcap_around(messages), kFile); })) return 0;
  const recording::merge::MergedLogs log(std::move(logs));
  const Exported one = exported(log);
  const recording::exports::PerfettoTrace trace(one.bytes);
  TTF_CHECK(trace.problems.empty(), "{}", trace.problems.front());
  TTF_CHECK(trace.slices.size() == one.counts.slices + one.counts.instants, "{} slices of {}", trace.slices.size(),
            one.counts.slices + one.counts.instants);
  TTF_CHECK(trace.flows.size() == one.counts.flows, "{} flows of {}", trace.flows.size(), one.counts.flows);
  TTF_CHECK(exported(log).bytes == one.bytes, "another trace of the same log");
  return 0;
}
