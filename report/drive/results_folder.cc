#include "report/drive/results_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "recording/merge/stored_log.h"
#include "schedules/model/ports.h"

namespace ttf::report::drive {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string word_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::uint64_t count_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

std::optional<Duration> seconds_at(const Json& object, const char* key) {
  constexpr double kMost = 1e9;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const double seconds = found->get<double>();
  return seconds >= 0 && seconds <= kMost ? std::optional(Duration{std::llround(seconds * 1e9)}) : std::nullopt;
}

// Looks for a log beside its summary, because the folder may have been moved.
void find_logs(ResultsFolder& folder) {
  std::error_code none;
  for (Drive& drive : folder.drives) {
    drive.folder = folder.path;
    const std::string log = folder.path + "/" + drive.log_name;
    if (drive.log_name.empty())
      folder.remarks.push_back(fmt::format("{} kept no log: everything drawn from one is missing.", drive.strategy));
    else if (!fs::exists(log, none))
      folder.remarks.push_back(
          fmt::format("The log of {}, {}, is missing, and everything drawn from it.", drive.strategy, drive.log_name));
    else
      drive.log = std::make_shared<const recording::merge::MergedLogs>(std::vector<std::string>{log});
  }
}

}  // namespace

bool has_libraries(const Drive& drive) {
  return drive.log != nullptr && std::ranges::any_of(drive.log->manifest().hashes, [](const auto& hash) {
           return schedules::model::names_library(hash.first);
         });
}

Json parse_json(std::string_view text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::string_view before = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
    const auto line = 1 + static_cast<int>(std::ranges::count(before, '\n'));
    throw InputError({file, line, "", "", "must be JSON: it is damaged here, or cut off"});
  } catch (const Json::exception&) {  // for a number such as 1e999
    throw InputError({file, 0, "", "", "must be JSON: it has an invalid number"});
  }
}

ResultsFolder parse_summary(std::string_view text, const std::string& file) {
  ResultsFolder folder;
  folder.summary = parse_json(text, file);
  const auto bad = [&](const std::string& key, const std::string& expected) {
    throw InputError({file, 0, key, "", expected});
  };
  if (!folder.summary.is_object()) bad("", "must be the summary of a run: a mapping");
  const auto strategies = folder.summary.find("strategies");
  if (strategies == folder.summary.end() || !strategies->is_array() || strategies->empty())
    bad("strategies", "must be the run's strategies, at least one");
  for (const Json& one : *strategies) {
    if (!one.is_object() || word_at(one, "strategy").empty()) bad("strategies", "must each name a strategy");
    Drive drive;
    drive.scenario = word_at(folder.summary, "scenario");
    drive.strategy = word_at(one, "strategy");
    drive.log_name = fs::path(word_at(one, "log")).filename().string();
    drive.seed = count_at(folder.summary, "seed");
    drive.duration = seconds_at(folder.summary, "duration_s");
    drive.summary = one;
    folder.drives.push_back(std::move(drive));
  }
  return folder;
}

FolderKind kind_of_folder(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) throw InputError({path, 0, "", "", "must be a folder of results"});
  if (fs::exists(path + "/answer.json", none)) return FolderKind::kExperiment;
  if (fs::exists(path + "/summary.json", none) || !recording::merge::logs_in(path).empty()) return FolderKind::kRun;
  throw InputError(
      {path, 0, "", "", "is neither a run (no summary.json, no *.mcap) nor an experiment (no answer.json)"});
}

ResultsFolder read_results_folder(const std::string& path) {
  ResultsFolder folder;
  std::error_code none;
  if (const std::string summary = path + "/summary.json"; fs::exists(summary, none)) {
    folder = parse_summary(read_file(summary), summary);
    folder.path = path;
    find_logs(folder);
  } else {
    folder.path = path;
    std::vector<recording::merge::StoredLog> logs;
    for (const std::string& log : recording::merge::logs_in(path)) logs.emplace_back(log);
    for (recording::merge::MergedLogs& merged : recording::merge::merge_by_drive(std::move(logs))) {
      const recording::log::LogManifest manifest = merged.manifest();
      Drive drive;
      drive.folder = path;
      drive.scenario = manifest.scenario_name;
      drive.strategy = manifest.strategy;
      drive.seed = manifest.seed;
      drive.log = std::make_shared<const recording::merge::MergedLogs>(std::move(merged));
      folder.drives.push_back(std::move(drive));
    }
    folder.remarks.push_back("There is no summary.json: the numbers come from the log, over the whole drive.");
  }
  for (const Drive& drive : folder.drives)
    if (drive.log)
      for (const std::string& warning : drive.log->warnings()) folder.remarks.push_back(warning);
  return folder;
}

}  // namespace ttf::report::drive
