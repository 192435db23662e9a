// The verdict on a drive in real time. It says whether late and lost frames matter to the feature service.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "cli/drive/launch_findings.h"
#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/service_account.h"
#include "evaluation/lateness/lateness_account.h"
#include "fusion/strategies/strategy.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch {

// Returns the largest age of each sensor's newest measurement in a used image. The schedule's analysis bounds it. The
// arrival window's `late` comes on top: it is real time, and ages are the drive's.
std::map<SensorId, Duration> promised_ages(const schedules::model::Cluster& cluster,
                                           fusion::strategies::StrategyKind strategy, std::int64_t time_scale_ppm);

struct DriveFacts {
  const schedules::model::Cluster* cluster = nullptr;
  const evaluation::lateness::RealTimeFindings* real_time = nullptr;
  evaluation::accuracy::ServiceFindings service;
  std::uint64_t restarts = 0;
  std::string absent;         // DriveEnd::sentence()
  std::string external = {};  // external::wrongs_text()
};

using drive::Verdict;
// The counts matter if the service was not served as promised. They matter, too, if a node was out of operation at the
// end.
Verdict verdict_of(const DriveFacts& facts);

}  // namespace ttf::cli::launch
