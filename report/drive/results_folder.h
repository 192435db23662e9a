// The kind of a folder and its drives: from `ttfusion run` or `ttfusion launch`, or logs without a summary.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "recording/merge/merge.h"
#include "recording/scene/viewed.h"
#include "report/drive/stages.h"

namespace ttf::report::drive {

enum class FolderKind : std::uint8_t { kRun, kExperiment };
// Throws InputError if the folder is of neither kind.
FolderKind kind_of_folder(const std::string& path);

// One strategy's drive.
struct Drive {
  std::string folder, scenario, strategy;
  std::string log_name;  // the log's name in the folder; "" without a log
  std::string label;     // distinguishes it from other drives on the page
  std::uint64_t seed = 0;
  nlohmann::ordered_json summary;                           // its part of summary.json; null without one
  std::shared_ptr<const recording::merge::MergedLogs> log;  // null if no log was kept
  std::optional<Duration> duration{};                       // by the folder's summary
  std::vector<recording::scene::ViewedSensor> sensors{};    // by SensorId; empty: only the log's names are known
  std::vector<ReportedStages> stages{};                     // latency by stage; empty if no bounds are known
};

struct ResultsFolder {
  std::string path;
  nlohmann::ordered_json summary;    // the folder's; null if it has only logs
  std::vector<Drive> drives;         // at least one
  std::vector<std::string> remarks;  // sentences about missing or damaged files
};
// Returns whether libraries took part as steps: then the log's manifest has their hashes.
bool has_libraries(const Drive& drive);

// Throws InputError for an invalid summary or an unreadable log.
ResultsFolder read_results_folder(const std::string& path);

// Reads summary.json alone, into drives without logs. `file` is for messages. Throws InputError.
ResultsFolder parse_summary(std::string_view text, const std::string& file);
// Throws InputError with the file and the error.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& file);

}  // namespace ttf::report::drive
