// One drive of an experiment: the base scenario and the paradigm's cluster, changed by the point, the paradigm
// and the replication, driven and measured.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/text_place.h"
#include "experiments/results/store.h"
#include "experiments/sweep/file.h"
#include "nodes/foreign/libraries.h"
#include "recording/records/records.h"
#include "schedules/file/inherit.h"
#include "schedules/model/cluster.h"
#include "sim/drives/scenario.h"

namespace ttf::experiments::sweep {

struct PreparedDrive {
  sim::drives::Scenario scenario;
  schedules::model::Cluster cluster;
  fusion::strategies::StrategyKind strategy{};
};

// The files behind an experiment, read once; const afterwards, for many workers.
class SweepDrives {
 public:
  // Prepares every point of a small grid; of a large one, every value of every axis, and both ends of drawn
  // values. Errors are thus known before any drive. Throws InputError, whose sentences name file, line and
  // point. `steps` must outlive this.
  explicit SweepDrives(const SweepFile& sweep, const nodes::foreign::StepFolder* steps = nullptr);

  // Throws InputError.
  PreparedDrive prepare(const results::RowKey& key) const;
  // Returns values by random axis, in the file's order: a function of seed, axis and replication alone. Rounded
  // to six digits.
  std::vector<double> drawn(std::uint32_t replication) const;
  // Returns drawn axes and measures. A failed drive has the reason as its status; std::bad_alloc is thrown
  // instead, since it does not depend on the drive.
  results::Row run(const results::RowKey& key) const;
  // Drives a prepared drive, with one more listener.
  results::Row run(const results::RowKey& key, const PreparedDrive& drive,
                   recording::records::Sink* listener = nullptr) const;

  // The store's columns: drawn axes by their names in the file, the file's measures, and kTrackLost unless it is one of them.
  std::vector<std::string> columns() const;
  // A hash of all files behind the drives, libraries included.
  const std::string& identity() const { return identity_; }
  const SweepFile& sweep() const { return sweep_; }
  const nodes::foreign::StepFolder* steps() const { return steps_; }
  // Returns the libraries that the drives name as steps, with the hashes of their contents.
  const std::map<std::string, std::string>& libraries() const { return libraries_; }

 private:
  PreparedDrive prepare(const results::RowKey& key, const std::vector<double>& drawn) const;
  void read_files();
  void prepare_at(const results::RowKey& key);
  std::vector<Edit> edits_of(const results::RowKey& key, const std::vector<double>& drawn) const;
  // Applies the edits of a cluster, or of a scenario, to the text of the file `name`.
  TextOrigins origins_of(const std::string& file) const;
  schedules::file::ClusterText edited(const std::vector<Edit>& edits, bool of_cluster, const std::string& name) const;
  void plan_faults(const std::string& file, sim::drives::Scenario& scenario) const;

  const SweepFile& sweep_;
  const nodes::foreign::StepFolder* steps_;
  std::map<std::string, std::string> texts_;      // scenarios, whole clusters and fault plans, by path
  std::map<std::string, TextOrigins> origins_;    // the clusters' lines
  std::map<std::string, std::string> libraries_;  // hashes by name
  std::string identity_;
};

}  // namespace ttf::experiments::sweep
