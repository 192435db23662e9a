// Drives for tests: shipped files, run into any sink.
#pragma once

#include <memory>
#include <string>

#include "evaluation/accuracy/drive_measures.h"
#include "recording/records/tee.h"
#include "schedules/file/loader.h"
#include "sim/drives/drive.h"
#include "sim/drives/scenario.h"
#include "sim/drives/step_catalog.h"

namespace ttf::sim::drives {

inline std::string shipped(const std::string& path) { return TTF_SOURCE_DIR "/" + path; }

struct Drive {
  Scenario scenario;
  schedules::model::Cluster cluster;
  fusion::strategies::StrategyKind strategy;

  Drive(const std::string& scenario_file, fusion::strategies::StrategyKind kind)
      : scenario(load_scenario(shipped(scenario_file))),
        cluster(schedules::file::load_cluster(scenario.cluster_files[static_cast<std::size_t>(kind)])), strategy(kind) {
  }

  DriveOutcome run(recording::records::Sink& sink, std::uint64_t seed = 1, bool compares_clocks = true) const {
    return run_drive({&scenario, &cluster, strategy, seed, 0, nullptr, nullptr, compares_clocks}, sink);
  }
};

inline evaluation::accuracy::DriveSummary summary_of(const Drive& drive) {
  evaluation::accuracy::DriveMeasures measures(evaluation_start(drive.scenario));
  drive.run(measures);
  return measures.finish();
}

}  // namespace ttf::sim::drives
