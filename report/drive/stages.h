// The latency of measurements by stage, as the page shows it: what the schedule's analysis bounds, beside what was. The
// program hands it over (cli/logs/report_command.cc), since the bounds are the cluster's, and this module reads logs alone.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "report/page/page.h"

namespace ttf::report::drive {

struct ReportedDrive;

// In ms.
struct ReportedDurations {
  double least = 0.0, mean = 0.0, p99 = 0.0, most = 0.0;
};

struct ReportedStage {
  std::string name;
  std::optional<double> best, worst;  // shares of the least and the largest age [ms]
  ReportedDurations had;
  double age_best = 0.0;            // bounds of the age at the stage's end [ms]
  std::optional<double> age_worst;  // absent: the schedule bounds none there
  ReportedDurations age;
  std::uint64_t beyond = 0;  // measurements whose age was outside its bounds
};

struct ReportedStages {
  std::string sensor;
  std::vector<ReportedStage> stages;
  std::uint64_t measured = 0, seen = 0;  // seen: all the way
  bool to_use = false;                   // else to the fusion
};

// Adds the section, unless no drive has stages. Drives stand below each other in each stage.
void stages_section(page::Page& page, const std::vector<ReportedDrive>& drives);
// Returns a sentence on ages outside their bounds; empty if all were within.
std::string beyond_words(const std::string& label, const std::vector<ReportedStages>& sensors);

}  // namespace ttf::report::drive
