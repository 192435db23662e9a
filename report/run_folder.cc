#include "report/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/errors.h"
#include "core/file_bytes.h"

namespace ttf::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<std::string> logs_in(const std::string& folder) {
  std::vector<std::string> logs;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".mcap") logs.push_back(entry.path().string());
  std::ranges::sort(logs);
  return logs;
}

std::string word_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::uint64_t count_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

void read_summary(const std::string& path, RunFolder& folder) {
  folder.summary = read_json(path);
  const auto bad = [&](const std::string& key, const std::string& expected) {
    throw InputError({path, 0, key, "", expected});
  };
  if (!folder.summary.is_object()) bad("", "must be the summary of a run: a mapping");
  const auto strategies = folder.summary.find("strategies");
  if (strategies == folder.summary.end() || !strategies->is_array() || strategies->empty())
    bad("strategies", "must be the run's strategies, at least one");
  std::error_code none;
  for (const Json& one : *strategies) {
    if (!one.is_object() || word_at(one, "strategy").empty()) bad("strategies", "must name a strategy each");
    Drive drive{folder.path, word_at(folder.summary, "scenario"), word_at(one, "strategy"), {},
                count_at(folder.summary, "seed"), one, nullptr};
    // The folder may have been moved since.
    const std::string name = fs::path(word_at(one, "log")).filename().string(), log = folder.path + "/" + name;
    if (name.empty())
      folder.remarks.push_back(fmt::format("{} kept no log: what is drawn from one is not here.", drive.strategy));
    else if (!fs::exists(log, none))
      folder.remarks.push_back(fmt::format("The log of {}, {}, is not there: what is drawn from it is not here.",
                                           drive.strategy, name));
    else
      drive.log = std::make_shared<const recording::MergedLogs>(std::vector<std::string>{log});
    folder.drives.push_back(std::move(drive));
  }
}

}  // namespace

Json read_json(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::string_view before = std::string_view(text).substr(0, error.byte > 0 ? error.byte - 1 : 0);
    const auto line = 1 + static_cast<int>(std::ranges::count(before, '\n'));
    throw InputError({path, line, "", "", "must be JSON: it is damaged here, or cut off"});
  } catch (const Json::exception&) {   // 1e999
    throw InputError({path, 0, "", "", "must be JSON: a number in it is none"});
  }
}

FolderKind kind_of_folder(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) throw InputError({path, 0, "", "", "must be a folder of results"});
  if (fs::exists(path + "/answer.json", none)) return FolderKind::kExperiment;
  if (fs::exists(path + "/summary.json", none) || !logs_in(path).empty()) return FolderKind::kRun;
  throw InputError(
      {path, 0, "", "", "is neither a run (no summary.json, no *.mcap) nor an experiment (no answer.json)"});
}

RunFolder read_run_folder(const std::string& path) {
  RunFolder folder{path, {}, {}, {}};
  std::error_code none;
  if (fs::exists(path + "/summary.json", none)) {
    read_summary(path + "/summary.json", folder);
  } else {
    std::vector<recording::StoredLog> logs;
    for (const std::string& log : logs_in(path)) logs.emplace_back(log);
    for (recording::MergedLogs& run : recording::merge_by_run(std::move(logs))) {
      const recording::LogManifest manifest = run.manifest();
      folder.drives.push_back({path, manifest.scenario_name, manifest.strategy, {}, manifest.seed, {},
                               std::make_shared<const recording::MergedLogs>(std::move(run))});
    }
    folder.remarks.push_back("There is no summary.json: figures are the log's, over the whole drive.");
  }
  for (const Drive& drive : folder.drives)
    if (drive.log)
      for (const std::string& warning : drive.log->warnings()) folder.remarks.push_back(warning);
  return folder;
}

}  // namespace ttf::report
