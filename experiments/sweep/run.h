// One run of an experiment: the base scenario and the paradigm's cluster with what the point, the paradigm and the
// replication change in them, driven and measured.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "drives/scenario.h"
#include "experiments/results/store.h"
#include "experiments/sweep/file.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::sweep {

struct PreparedDrive {
  drives::Scenario scenario;
  schedules::model::Cluster cluster;
  fusion::strategies::StrategyKind strategy{};
};

// The files an experiment follows from, read once; const afterwards, for many workers.
class SweepDrives {
 public:
  // Prepares every point of small grids, of large ones every value of every axis, with the ends of what is drawn, so
  // that what cannot be driven is known before anything is. Throws InputError, whose sentences name file, line and
  // point.
  explicit SweepDrives(const SweepFile& sweep);

  // Throws InputError.
  PreparedDrive prepare(const results::RunKey& key) const;
  // By random axis, in the file's order: a function of seed, axis and replication alone. Rounded to six digits.
  std::vector<double> drawn(std::uint32_t replication) const;
  // Measures and drawn axes; a run that fails says why, but for std::bad_alloc, which says nothing of the run.
  results::Run run(const results::RunKey& key) const;
  // The same of a drive that is prepared, with a listener more.
  results::Run run(const results::RunKey& key, const PreparedDrive& drive,
                   recording::records::Sink* listener = nullptr) const;

  // The store's columns: a drawn axis is called as in the file.
  std::vector<std::string> columns() const;
  // A hash of all files that the runs follow from.
  const std::string& identity() const { return identity_; }
  const SweepFile& sweep() const { return sweep_; }

 private:
  PreparedDrive prepare(const results::RunKey& key, const std::vector<double>& drawn) const;
  void read_files();
  void prepare_at(const results::RunKey& key) const;
  std::vector<Edit> edits_of(const results::RunKey& key, const std::vector<double>& drawn) const;
  // Those of a cluster, or of a scenario, in what stands in the file `name`.
  std::string edited(const std::vector<Edit>& edits, bool of_cluster, const std::string& name) const;
  void plan_faults(const std::string& file, drives::Scenario& scenario) const;

  const SweepFile& sweep_;
  std::map<std::string, std::string> texts_;  // of scenarios, clusters and plans of faults, by path
  std::string identity_;
};

}  // namespace ttf::experiments::sweep
