#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/argument_checks.h"
#include "cli/output.h"
#include "cli/schedule/checks.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "recording/capture/check.h"

namespace ttf::cli::schedule {
namespace {

using recording::capture::CaptureFinding;
using recording::capture::CaptureVerdict;

schedules::model::Channels channels_of(const std::string& text) {
  return text == "A"   ? schedules::model::Channels::kA
         : text == "B" ? schedules::model::Channels::kB
                       : schedules::model::Channels::kAB;
}

std::string_view name_of(recording::capture::Contradiction kind) {
  return recording::capture::kContradictionNames[static_cast<std::size_t>(kind)];
}

void print_json(const schedules::model::Cluster& cluster, const CaptureArguments& arguments,
                const CaptureVerdict& verdict) {
  nlohmann::ordered_json json{{"cluster", cluster.name},
                              {"capture", arguments.file},
                              {"channels", arguments.channels},
                              {"frames", verdict.frames},
                              {"cycles", verdict.cycles},
                              {"symbols", verdict.symbols},
                              {"consistent", verdict.contradictions() == 0}};
  for (std::size_t kind = 0; kind < recording::capture::kContradictions; ++kind)
    json["contradictions"][std::string(recording::capture::kContradictionNames[kind])] = verdict.counts[kind];
  json["findings"] = nlohmann::ordered_json::array();
  for (const CaptureFinding& finding : verdict.findings)
    json["findings"].push_back({{"packet", finding.packet}, {"kind", name_of(finding.kind)}, {"text", finding.text}});
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_text(const schedules::model::Cluster& cluster, const CaptureArguments& arguments,
                const CaptureVerdict& verdict) {
  for (const CaptureFinding& finding : verdict.findings)
    fmt::print("{}: {} packet {}: {}: {}\n", arguments.file,
               finding.kind == recording::capture::Contradiction::kMissing ? "after" : "at", finding.packet,
               name_of(finding.kind), finding.text);
  if (verdict.findings.size() == recording::capture::kMostFindings)
    fmt::print("...: the first {} are listed\n", recording::capture::kMostFindings);
  fmt::print("{} against {}: {} on {} in {}: ", arguments.file, cluster.name, counted(verdict.frames, "frame"),
             arguments.channels, counted(static_cast<std::uint64_t>(verdict.cycles), "cycle"));
  if (verdict.contradictions() == 0) {
    fmt::print("as scheduled\n");
    return;
  }
  fmt::print("{}\n", counted(verdict.contradictions(), "contradiction"));
  for (std::size_t kind = 0; kind < recording::capture::kContradictions; ++kind)
    if (verdict.counts[kind] > 0)
      fmt::print("  {:24} {}\n", recording::capture::kContradictionNames[kind], verdict.counts[kind]);
}

recording::capture::Capture read_capture(const std::string& path) {
  try {
    return recording::capture::read_capture(path);
  } catch (const InputError&) {
    refuse_any_kind(path, "a capture");
    throw;
  }
}

}  // namespace

void add_capture_arguments(CLI::App& command, CaptureArguments& arguments) {
  CLI::Option* against = command.add_option(
      "--against", arguments.file, "Capture (pcap or pcapng with FlexRay frames) to compare with the schedule");
  command.add_option("--channels", arguments.channels, "Captured channels: A, B or AB")
      ->check(one_of({"A", "B", "AB"}))
      ->capture_default_str()
      ->needs(against);
  const auto [from, to] = add_time_window(command, arguments.window,
                                          "Begin this many seconds after the first FlexRay packet (after a start-up)",
                                          "End this many seconds after the first FlexRay packet");
  from->needs(against);
  to->needs(against);
}

int check_against_capture(const schedules::model::Cluster& cluster, const CaptureArguments& arguments, bool json) {
  const TimeWindow window = time_window(arguments.window);
  recording::capture::CaptureCheckOptions options;
  options.channels = channels_of(arguments.channels);
  options.from_ns = window.begin().ns;
  if (window.to) options.to_ns = window.to->ns;
  const recording::capture::Capture capture = read_capture(arguments.file);
  print_warnings(capture.warning);
  const CaptureVerdict verdict = recording::capture::check_capture(capture, arguments.file, cluster, options);
  if (json)
    print_json(cluster, arguments, verdict);
  else
    print_text(cluster, arguments, verdict);
  return verdict.contradictions() == 0 ? 0 : 1;
}

}  // namespace ttf::cli::schedule
