#include "cli/launch/launch_result.h"

#include <fmt/format.h>

#include <utility>

#include "cli/drive/drive_setup.h"
#include "cli/output.h"
#include "core/errors.h"
#include "evaluation/lateness/lateness_account.h"
#include "drives/step_catalog.h"
#include "recording/log/content_hash.h"
#include "recording/merge/merge.h"
#include "recording/records/tee.h"
#include "recording/merge/stored_log.h"

namespace ttf::cli {

std::vector<std::string> readable_logs(const std::vector<std::string>& paths) {
  std::vector<std::string> readable;
  for (const std::string& path : paths) {
    try {
      const recording::StoredLog log(path);
      readable.push_back(path);
    } catch (const InputError& error) {
      for (const Finding& finding : error.findings()) print_warnings(finding.sentence());
    }
  }
  return readable;
}

StrategyResult merged_result(const NodeSet& set, const std::vector<std::string>& logs,
                             const std::vector<records::Sink*>& others) {
  StrategyResult result;
  result.strategy = set.strategy;
  result.cluster = set.cluster;
  const recording::MergedLogs merged(logs);
  print_warnings(merged.warnings());
  result.log_path = fmt::format("{}/{}", set.folder, merged_log(nodes::name_of(set.strategy)));
  recording::write_merged(merged, result.log_path);
  result.content_hash = recording::ContentHash::text(merged.content_hash().value());
  DriveJudge judge(set.scenario, set.cluster);
  experiments::LatenessAccount lateness(set.cluster, experiments::real_time_run(merged));
  std::vector<records::Sink*> sinks = judge.sinks();
  sinks.push_back(&lateness);
  sinks.insert(sinks.end(), others.begin(), others.end());
  records::Tee tee(std::move(sinks));
  merged.read(tee);
  judge.finish(result);
  result.real_time = lateness.finish();
  return result;
}

}  // namespace ttf::cli
