// The constraints on FlexRay's parameters (2.1A, annex B.4), as one table. docs/schedules/flexray_constraints.md shows it, and
// says which constraints are not checked. Some are bounds here where the specification has an equation: its other terms
// are no keys of a cluster file.
//
// The bounds: schedules/analysis/parameter_bounds.h. Terms (schedules/model/wire_times.h): gAssumedPrecision, adActionPointDifference, cClockDeviationMax = 0.0015.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "schedules/analysis/parameter_bounds.h"
#include "schedules/check/checker.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::check {

// A cluster's parameters and those of one controller.
struct Constrained {
  const model::Cluster& cluster;
  const model::NodeParameters& p;     // defaults where a constraint is on the cluster
  std::int64_t drift_ppb = 0;         // the largest of this node's clock
  std::int64_t others_drift_ppb = 0;  // and of any controller's
  const model::GlobalParameters& g = cluster.flexray;

  operator analysis::Terms() const {
    return {g, p, drift_ppb, others_drift_ppb};
  }  // NOLINT(google-explicit-constructor)
};

struct Constraint {
  enum class On : std::uint8_t {
    kCluster,
    kDynamicSegment,  // the cluster, if its dynamic segment is used
    kController,
  };
  const char* name;
  const char* parameter;   // the finding is about it
  const char* derivation;  // in the specification's terms
  On on;
  bool (*holds)(const Constrained&);
  std::string (*value)(const Constrained&);
  std::string (*sentence)(const Constrained&);  // "must be ..."
};

std::span<const Constraint> constraints();

// Adds a finding for each constraint of that kind that does not hold. `path`: in front of the parameter's name.
void check_constraints(Constraint::On on, const Constrained& subject, const std::string& path,
                       ClusterFindings& findings);

}  // namespace ttf::schedules::check
