// The options of `ttfusion experiment`, and its functions: one file per kind of experiment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/drive/step_options.h"
#include "core/strict_yaml.h"
#include "experiments/mpi/ranks.h"
#include "experiments/results/shard.h"
#include "experiments/sweep/drives.h"

namespace ttf::cli::experiment {

struct ExperimentOptions {
  std::string file;
  std::string out;
  std::string shard;
  std::vector<std::string> merge;
  std::optional<std::string> replay;
  std::string truth;  // refused
  drive::StepOptions steps;
  unsigned jobs = 0;
  std::uint32_t replications = 0;     // 0: as many as in the file
  std::optional<std::uint64_t> seed;  // none: the file's
  bool resume = false;
  bool json = false;
};

// Returns the whole experiment for empty text. Throws InputError.
experiments::results::Shard shard_of(const std::string& text);

enum class ExperimentKind : std::uint8_t { kSweep, kFaultCampaign };
// Throws InputError.
ExperimentKind kind_of(const ExperimentOptions& options);

// Reads an experiment's file as if it had another seed. Results with that seed belong to another experiment. Throws InputError.
StrictYaml file_with_seed(const std::string& path, std::optional<std::uint64_t> seed);

// Decides the number of replications: the option's, else that of the existing or merged folders, else the
// file's. Then sets it in `options` only if it differs from the file's. Throws InputError.
void settle_replications(ExperimentOptions& options, experiments::sweep::SweepFile& sweep);

int run_fault_campaign(const ExperimentOptions& options);
int run_sweep_experiment(const ExperimentOptions& given, experiments::mpi::Ranks& alone);
// Drives a sweep on more than one rank: every rank reads it, and only one reports errors.
int run_on_ranks(const ExperimentOptions& given, experiments::mpi::Ranks& ranks);
// Drives all rows missing from the store, then writes and prints the answer. With several ranks, it runs on rank 0.
int drive_and_answer(const ExperimentOptions& options, const experiments::sweep::SweepDrives& drives,
                     experiments::mpi::Ranks& ranks);

}  // namespace ttf::cli::experiment
