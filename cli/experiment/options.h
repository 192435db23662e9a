// What `ttfusion experiment` is asked for, and who does it: one file a kind of experiment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/mpi/ranks.h"
#include "experiments/results/shard.h"
#include "experiments/sweep/run.h"

namespace ttf::cli::experiment {

struct ExperimentOptions {
  std::string file;
  std::string out;
  std::string shard;
  std::vector<std::string> merge;
  std::optional<std::string> replay;
  unsigned jobs = 0;
  std::uint32_t replications = 0;  // none: as many as the file says
  bool resume = false;
  bool json = false;
};

// All of it where nothing is asked for. Throws InputError.
experiments::results::Shard shard_of(const std::string& text);

enum class ExperimentKind : std::uint8_t { kSweep, kFaultCampaign };
// Throws InputError.
ExperimentKind kind_of(const ExperimentOptions& options);

// How many replications are asked for: as many as the option says; without it as many as the folders have been made for
// that are gone on with or put together, or else as many as the file says. Then `options` says so only where the file
// does not. Throws InputError.
void settle_replications(ExperimentOptions& options, experiments::sweep::SweepFile& sweep);

int run_fault_campaign(const ExperimentOptions& options);
int run_sweep_experiment(const ExperimentOptions& given, experiments::mpi::Ranks& alone);
// A sweep, on more ranks than one: every rank reads it, and what is wrong is told once.
int run_on_ranks(const ExperimentOptions& given, experiments::mpi::Ranks& ranks);
// Drives what the store does not have yet, and writes and prints the answer. Of more ranks than one: on rank 0.
int drive_and_answer(const ExperimentOptions& options, const experiments::sweep::SweepDrives& drives,
                     experiments::mpi::Ranks& ranks);

}  // namespace ttf::cli::experiment
