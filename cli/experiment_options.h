// What `ttfusion experiment` is asked for, and who does it: one file a kind of experiment.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/shard.h"

namespace ttf::cli {

struct ExperimentOptions {
  std::string file;
  std::string out;
  std::string shard;
  std::vector<std::string> merge;
  std::optional<std::string> replay;
  unsigned jobs = 0;
  bool resume = false;
  bool json = false;
};

// All of it where nothing is asked for. Throws InputError.
experiments::Shard shard_of(const std::string& text);

int run_fault_campaign(const ExperimentOptions& options);
int run_sweep_experiment(const ExperimentOptions& options);

}  // namespace ttf::cli
