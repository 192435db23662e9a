// Drives an experiment's rows again, each with a log.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "experiments/results/store.h"
#include "experiments/sweep/drives.h"
#include "report/experiment/folder.h"
#include "report/experiment/report.h"

namespace ttf::cli::experiment {

// Leaves the drive's log in the folder, under its paradigm's name. Throws InputError if the drive is
// impossible, and std::runtime_error if the log cannot be written.
experiments::results::Row drive_again(const experiments::sweep::SweepDrives& drives,
                                      const experiments::results::RowKey& key, const std::string& folder);

// Drives each paradigm of the folder's experiment again, at one point (by default the first), with the first
// replication that all paradigms have done. The results must equal the store's rows: a changed
// experiment or program is not shown as the original.
//
// `file` is the experiment's file, if it has moved. Throws InputError if the file or the point does not fit
// the folder. Progress goes to standard error.
report::experiment::ExperimentDrives drives_of(const report::experiment::ExperimentFolder& folder,
                                               const std::optional<std::string>& file,
                                               std::optional<std::uint32_t> point,
                                               const nodes::foreign::StepFolder* steps);

}  // namespace ttf::cli::experiment
