// The cluster that the schedule commands read: a cluster file, or the FlexRay cluster of a FIBEX file.
#pragma once

#include <string>
#include <vector>

#include "schedules/exchange/fibex/import.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::schedule {

struct ScheduleInput {
  schedules::model::Cluster cluster;
  std::vector<std::string> notes;  // assumed values of a FIBEX file, and its parts left out
};

// A file that begins with `<` is FIBEX. The cluster has passed the checks; those that need tasks are skipped where it
// describes none (schedules/check/rules.h). A value that a FIBEX file does not state may break a rule: that is a note.
// Throws InputError.
ScheduleInput checked_input(const std::string& path);

// Returns whether the file is a cluster file; false for one that cannot be read.
bool is_cluster_file(const std::string& path);

// Reads a FIBEX file. Throws InputError, with one finding for a file of another kind.
schedules::exchange::fibex::FibexImport fibex_input(const std::string& path);

// Returns the note for a result that needs tasks; empty for a cluster that describes them.
std::string without_tasks(const schedules::model::Cluster& cluster, const std::string& left_out);

}  // namespace ttf::cli::schedule
