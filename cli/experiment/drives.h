// Runs of an experiment driven again, each with a log.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "experiments/results/store.h"
#include "experiments/sweep/run.h"
#include "report/experiment/folder.h"
#include "report/experiment/report.h"

namespace ttf::cli::experiment {

// Leaves the run's log, called as its paradigm, in the folder. Throws InputError where it cannot be driven, and
// std::runtime_error where the log cannot be written.
experiments::results::Run drive_again(const experiments::sweep::SweepDrives& drives,
                                      const experiments::results::RunKey& key, const std::string& folder);

// One run of every paradigm of the experiment that the folder is of, at one point (the folder's first unless told) and
// with the first replication that all of them have done. They are compared with the store's rows: what is another
// experiment by now, or another program, is not shown as if it were the one that was driven.
//
// `file`: the experiment's, if not where it was then. Throws InputError where it or the point is not the folder's.
// Progress goes to standard error.
report::experiment::ExperimentDrives drives_of(const report::experiment::ExperimentFolder& folder,
                                               const std::optional<std::string>& file,
                                               std::optional<std::uint32_t> point);

}  // namespace ttf::cli::experiment
