// What a folder of results is, and the runs in it: as `ttfusion run` and `ttfusion launch` leave them, or logs alone.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "recording/merge/merge.h"

namespace ttf::report::run {

enum class FolderKind : std::uint8_t { kRun, kExperiment };
// Throws InputError where the folder is neither.
FolderKind kind_of_folder(const std::string& path);

// One strategy's drive.
struct Drive {
  std::string folder, scenario, strategy;
  std::string log_name;  // the log's in the folder; "" where none was kept
  std::string label;     // tells it from the others of the page
  std::uint64_t seed = 0;
  nlohmann::ordered_json summary;                           // its part of summary.json; null without one
  std::shared_ptr<const recording::merge::MergedLogs> log;  // none: the run kept none
};

struct ResultsFolder {
  std::string path;
  nlohmann::ordered_json summary;    // of all; null where there are logs alone
  std::vector<Drive> drives;         // at least one
  std::vector<std::string> remarks;  // sentences: what is missing or damaged
};
// Throws InputError: a summary that is none, a log that cannot be read.
ResultsFolder read_results_folder(const std::string& path);

// What summary.json says by itself, drives without their logs. `file` is for messages. Throws InputError.
ResultsFolder parse_run_summary(std::string_view text, const std::string& file);
// Throws InputError with the file and what is wrong.
nlohmann::ordered_json parse_json(std::string_view text, const std::string& file);

}  // namespace ttf::report::run
