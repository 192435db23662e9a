#include "cli/launch/launch_result.h"

#include <fmt/format.h>

#include <utility>

#include "cli/drive/drive_setup.h"
#include "cli/drive_progress.h"
#include "cli/launch/verdict.h"
#include "cli/output.h"
#include "core/errors.h"
#include "evaluation/accuracy/service_account.h"
#include "evaluation/lateness/lateness_account.h"
#include "recording/log/content_hash.h"
#include "recording/merge/merge.h"
#include "recording/merge/stored_log.h"
#include "recording/records/tee.h"
#include "sim/drives/drive.h"

namespace ttf::cli::launch {

std::vector<std::string> readable_logs(const std::vector<std::string>& paths) {
  std::vector<std::string> readable;
  for (const std::string& path : paths) {
    try {
      const recording::merge::StoredLog log(path);
      readable.push_back(path);
    } catch (const InputError& error) {
      for (const Finding& finding : error.findings()) print_warnings(finding.sentence());
    }
  }
  return readable;
}

drive::StrategyResult merged_result(const node_set::NodeSet& set, const std::vector<std::string>& logs,
                                    const std::vector<recording::records::Sink*>& others) {
  drive::StrategyResult result;
  result.strategy = set.strategy;
  result.cluster = set.cluster;
  const recording::merge::MergedLogs merged(logs);
  print_warnings(merged.warnings());
  result.log_path = fmt::format("{}/{}", set.folder, merged_log(name_of(set.strategy)));
  recording::merge::write_merged(merged, result.log_path);
  result.content_hash = recording::log::ContentHash::text(merged.content_hash().value());
  drive::DriveJudge judge(set.scenario, set.cluster, set.strategy);
  evaluation::lateness::LatenessAccount lateness(set.cluster, evaluation::lateness::real_time_drive(merged));
  evaluation::accuracy::ServiceAccount service(sim::drives::evaluation_start(set.scenario),
                                               promised_ages(set.cluster, set.strategy, set.time_scale_ppm));
  std::vector<recording::records::Sink*> sinks = judge.sinks();
  sinks.push_back(&lateness);
  sinks.push_back(&service);
  sinks.insert(sinks.end(), others.begin(), others.end());
  recording::records::Tee tee(std::move(sinks));
  read_shown(merged, tee);
  judge.finish(result);
  result.real_time = lateness.finish();
  result.service = service.finish(sim::drives::drive_end(set.scenario));
  return result;
}

}  // namespace ttf::cli::launch
