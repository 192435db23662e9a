// Any records as the pictures of a log. Laws: every log gives a picture; it is text without control
// characters; the same log gives the same picture.
//
// Input: start of the window (8 bytes, ns), its length and the cycle (4 bytes each, us), the set of known
// names (1 byte). Then messages: kind (1 byte), length (2 bytes), payload.
#include <algorithm>

#include "core/check.h"
#include "recording/exports/lateness_sums.h"
#include "recording/log/reader.h"
#include "report/plots/lateness_picture.h"
#include "report/plots/position_plot.h"
#include "report/startup/diagram.h"
#include "report/timing/diagram.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/mcap_around.h"

namespace {

using namespace ttf;

struct Pictures {
  report::drawing::Names names;
  TrueTime from, to;
  Duration cycle;

  std::vector<std::string> of(const std::string& log) const {
    report::timing::TimingDiagram timing(names, cycle, from, to);
    recording::log::read_log_bytes(log, "drive.mcap", timing);
    report::plots::PositionPlots position(names, {.title = "drive", .from = from, .to = to});
    recording::log::read_log_bytes(log, "drive.mcap", position);
    report::startup::StartupDiagram startup(names, cycle, from, to);
    recording::log::read_log_bytes(log, "drive.mcap", startup);
    recording::exports::LatenessSums lateness;
    recording::log::read_log_bytes(log, "drive.mcap", lateness);
    return {timing.svg(), position.over_time_svg(), position.plane_svg(), startup.svg(),
            report::plots::lateness_svg(lateness.nodes(), names)};
  }
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Source source(data, size);
  Pictures pictures;
  // The range that cli/time_window.h accepts.
  pictures.from = {static_cast<std::int64_t>(source.take<std::uint64_t>() % 1'000'000'000'000'000'000u)};
  pictures.to = pictures.from + Duration::microseconds(source.take<std::uint32_t>());
  pictures.cycle = Duration::microseconds(source.take<std::uint32_t>());
  if ((source.take<std::uint8_t>() & 1) != 0) {
    pictures.names.nodes = {"laser", "fusion"};
    pictures.names.tasks = {{"scan"}, {"fuse", "image <1>"}};
    pictures.names.pdus = {"laser_scan", "laser_objects", "image"};
    pictures.names.sensors = {"laser", "camera"};
    pictures.names.can_buses = {"can & co"};
  }
  fuzz::Messages messages;
  while (!source.empty()) {
    const auto kind = source.take<std::uint8_t>();
    const auto payload = source.bytes(source.take<std::uint16_t>());
    messages.emplace_back(kind, std::string_view(reinterpret_cast<const char*>(payload.data()), payload.size()));
  }
  const std::string log = fuzz::mcap_around(messages);
  const std::vector<std::string> svgs = pictures.of(log);
  for (const std::string& svg : svgs) {
    TTF_CHECK(svg.substr(0, 4) == "<?xm", "{}", svg.substr(0, 80));
    TTF_CHECK(svg.find("nan") == std::string::npos && svg.find("inf") == std::string::npos, "no number in a picture");
    TTF_CHECK(std::none_of(svg.begin(), svg.end(), [](char c) { return c >= 0 && c < ' ' && c != '\n'; }),
              "a control character");
  }
  TTF_CHECK(pictures.of(log) == svgs, "another picture of the same log");
  return 0;
}
