#include "cli/schedule/schedule_input.h"

#include <fmt/format.h>

#include <utility>

#include "core/counted.h"
#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "schedules/check/checker.h"

namespace ttf::cli::schedule {
namespace {

bool is_xml(const std::string& path) {
  std::string head = read_file(path, 64);
  if (head.starts_with("\xef\xbb\xbf")) head.erase(0, 3);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string::npos && head[first] == '<';
}

}  // namespace

ScheduleInput checked_input(const std::string& path) {
  if (!is_xml(path)) return {schedules::check::load_checked_cluster(path), {}};
  schedules::exchange::fibex::FibexImport import = schedules::exchange::fibex::import_fibex(path);
  ScheduleInput input{std::move(import.cluster), {}};
  if (!import.assumed.empty() || !import.left_out.empty())
    input.notes.push_back(
        fmt::format("{}: {} assumed, {} left out or changed (schedule export --format yaml names them)", path,
                    counted(import.assumed.size(), "value"), counted(import.left_out.size(), "part")));
  Findings stated;
  for (Finding& finding : schedules::check::check(input.cluster)) {
    if (import.assumed.contains(finding.key))
      input.notes.push_back(finding.sentence() + " (assumed: the file does not state it)");
    else
      stated.add(std::move(finding));
  }
  stated.throw_if_any();
  return input;
}

bool is_cluster_file(const std::string& path) {
  try {
    return !is_xml(path) && kind_of_file(path) == FileKind::kCluster;
  } catch (const InputError&) {
    return false;
  }
}

schedules::exchange::fibex::FibexImport fibex_input(const std::string& path) {
  if (!is_xml(path)) refuse_any_kind(path, "a FIBEX file");
  return schedules::exchange::fibex::import_fibex(path);
}

std::string without_tasks(const schedules::model::Cluster& cluster, const std::string& left_out) {
  if (cluster.describes_tasks()) return "";
  return fmt::format("{} describes no tasks, so {}", cluster.name, left_out);
}

}  // namespace ttf::cli::schedule
