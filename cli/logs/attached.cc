#include "cli/logs/attached.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "schedules/file/loader.h"

namespace ttf::cli::logs {

Attached attached_to(const recording::merge::MergedLogs& drive, const std::string& without,
                     std::vector<std::string>& warnings) {
  Attached found;
  for (const recording::log::Attachment& one : drive.attachments()) {
    if (one.media_type != "application/yaml") continue;
    try {
      const std::optional<FileKind> kind = kind_of(StrictYaml::parse(one.bytes, one.name));
      if (kind == FileKind::kScenario) found.scenario = sim::drives::parse_scenario(one.bytes, one.name);
      if (kind == FileKind::kCluster) found.cluster = schedules::file::parse_cluster(one.bytes, one.name);
    } catch (const InputError& error) {
      // An older version's scenario, or a damaged one.
      warnings.push_back(fmt::format("{}: {}", without, error.findings().front().sentence()));
    }
  }
  return found;
}

}  // namespace ttf::cli::logs
