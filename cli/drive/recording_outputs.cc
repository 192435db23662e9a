#include "cli/drive/recording_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/counted.h"
#include "core/decimal.h"

namespace ttf::cli::drive {
namespace {

std::string seconds(Duration duration) { return scaled_text(duration.ns, 1'000'000'000) + " s"; }

bool most(std::uint64_t part, std::uint64_t whole) { return 2 * part > whole; }

// Returns how a track is confirmed, and when it ends.
std::string needs_of_a_track(const fusion::config::TrackerConfig& tracker) {
  const std::string confirmed =
      tracker.birth == fusion::config::Birth::kExistence
          ? fmt::format("the probability {:g} to exist (confirm_existence)", tracker.confirm_existence)
          : fmt::format("{} hits in {} lists (confirm_hits, confirm_window)", tracker.confirm_hits,
                        tracker.confirm_window);
  return fmt::format("a track needs {}, and ends {} after its last observation (delete_after)", confirmed,
                     seconds(tracker.delete_after));
}

}  // namespace

std::string recordings_text(const std::vector<StrategyResult>& results) {
  std::vector<std::pair<std::string, std::string>> texts;  // names of strategies, and their sentences
  for (const StrategyResult& result : results) {
    if (!result.recording) continue;
    std::string text = sim::drives::recording_text(*result.recording);
    const auto same = std::find_if(texts.begin(), texts.end(), [&](const auto& other) { return other.second == text; });
    if (same != texts.end())
      same->first += fmt::format(", {}", name_of(result.strategy));
    else
      texts.emplace_back(name_of(result.strategy), std::move(text));
  }
  std::string all;
  for (const auto& [names, text] : texts) all += fmt::format("recording with {}\n{}\n", names, text);
  return all;
}

std::vector<std::string> recording_reasons(const StrategyResult& result, const fusion::config::TrackerConfig& tracker) {
  std::vector<std::string> reasons;
  if (!result.recording) return reasons;
  const sim::drives::RecordingUse& use = *result.recording;
  std::uint64_t rows = 0, beyond = 0, lists = 0;
  for (const sim::drives::RecordingUse::OfSensor& of : use.sensors) {
    rows += of.rows.rows;
    beyond += of.rows.beyond;
    lists += of.rows.lists;
  }
  if (most(beyond, rows))
    reasons.push_back(
        fmt::format("{} of {} are beyond the drive's end at {}", beyond, counted(rows, "row"), seconds(use.duration)));
  const std::uint64_t received = result.summary.received - result.summary.duplicates;
  if (most(result.summary.dropped, received))
    reasons.push_back(
        fmt::format("{} of {} were dropped as too old: a list is taken in up to {} lists back "
                    "(history_scans)",
                    result.summary.dropped, counted(received, "list"), tracker.history_scans));
  if (!result.made_track)
    reasons.push_back(fmt::format("no track came of {} played within {}, {} of them fused: {}", counted(lists, "list"),
                                  seconds(std::min(use.ends_after, use.duration)),
                                  result.summary.fused + result.summary.fused_late, needs_of_a_track(tracker)));
  return reasons;
}

}  // namespace ttf::cli::drive
