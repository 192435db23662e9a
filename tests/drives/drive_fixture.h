// Drives for tests: shipped files, run into any sink.
#pragma once

#include <memory>
#include <string>

#include "evaluation/accuracy/drive_measures.h"
#include "drives/step_catalog.h"
#include "drives/scenario.h"
#include "recording/records/tee.h"
#include "schedules/file/loader.h"
#include "drives/drive.h"

namespace ttf::testing_support {

inline std::string shipped(const std::string& path) { return TTF_SOURCE_DIR "/" + path; }

struct Drive {
  nodes::Scenario scenario;
  schedules::Cluster cluster;
  fusion::StrategyKind strategy;

  Drive(const std::string& scenario_file, fusion::StrategyKind kind)
      : scenario(nodes::load_scenario(shipped(scenario_file))),
        cluster(schedules::load_cluster(scenario.cluster_files[static_cast<std::size_t>(kind)])), strategy(kind) {}

  sim::DriveOutcome run(records::Sink& sink, std::uint64_t seed = 1, bool compares_clocks = true) const {
    return sim::run_drive({&scenario, &cluster, strategy, seed, 0, nullptr, nullptr, compares_clocks}, sink);
  }
};

inline constexpr fusion::StrategyKind kStrategies[] = {fusion::StrategyKind::kBuff, fusion::StrategyKind::kAdva,
                                                       fusion::StrategyKind::kTt};

}  // namespace ttf::testing_support
