#include "cli/logs/log_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "cli/output.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "recording/merge/stored_log.h"
#include "report/drive/results_folder.h"

namespace ttf::cli::logs {
namespace {

namespace fs = std::filesystem;
using recording::merge::MergedLogs;
using recording::merge::StoredLog;

bool is_folder(const std::string& path) {
  std::error_code none;
  return fs::is_directory(path, none);
}

// A launch's folder has the merged log beside its parts: the summary names the merged one.
std::vector<std::string> logs_of_folder(const std::string& folder) {
  std::error_code none;
  std::vector<std::string> files;
  if (const std::string summary = folder + "/summary.json"; fs::exists(summary, none))
    for (const report::drive::Drive& drive : report::drive::parse_summary(read_file(summary), summary).drives)
      if (const std::string log = folder + "/" + drive.log_name; !drive.log_name.empty() && fs::exists(log, none))
        files.push_back(log);
  if (files.empty()) files = recording::merge::logs_in(folder);
  if (files.empty()) throw InputError({folder, 0, "", "", "holds no logs (.mcap)"});
  return files;
}

std::vector<StoredLog> stored(const std::vector<std::string>& files) {
  std::vector<StoredLog> logs;
  for (const std::string& file : files) logs.emplace_back(file);
  return logs;
}

}  // namespace

std::vector<std::string> log_files(const std::vector<std::string>& inputs) {
  std::vector<std::string> files;
  for (const std::string& input : inputs) {
    if (is_folder(input)) {
      const std::vector<std::string> found = logs_of_folder(input);
      files.insert(files.end(), found.begin(), found.end());
      continue;
    }
    expect_log(input);
    files.push_back(input);
  }
  return files;
}

std::vector<MergedLogs> drives_in(const std::vector<std::string>& inputs) {
  std::vector<MergedLogs> drives = recording::merge::merge_by_drive(stored(log_files(inputs)));
  for (const MergedLogs& drive : drives) print_warnings(drive.warnings());
  return drives;
}

MergedLogs drive_in(const std::vector<std::string>& inputs) {
  const std::vector<std::string> files = log_files(inputs);
  const auto folder = std::find_if(inputs.begin(), inputs.end(), is_folder);
  if (folder == inputs.end()) {
    MergedLogs drive(files);
    print_warnings(drive.warnings());
    return drive;
  }
  std::vector<MergedLogs> drives = recording::merge::merge_by_drive(stored(files));
  if (drives.size() > 1)
    throw InputError({*folder, 0, "", "",
                      fmt::format("must be the folder of one drive, and there are {}: name a log of one, as in {}",
                                  drives.size(), files.front())});
  print_warnings(drives.front().warnings());
  return std::move(drives.front());
}

}  // namespace ttf::cli::logs
