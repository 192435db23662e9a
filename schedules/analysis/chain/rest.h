// The rest of the chains to an actuator, behind a task that begins at known instants.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/analysis/age_stages.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis::chain {

class RestOfChain {
 public:
  // The cluster outlives this.
  RestOfChain(const model::Cluster& cluster, std::string name, Path path, std::size_t first);

  const std::string& name() const { return name_; }
  SensorId sensor() const { return path_.sensor; }
  // Returns how old a picture is when the task begins with it, if time activates the task and it takes the newest one.
  struct PictureAge {
    Duration best{}, worst{};
  };
  PictureAge picture_at_start() const;
  // Returns the time from the task's beginning, at `start` of global time, until the actuator reads the first command
  // resting on it: at least and at most, with the clocks' difference. The task executes for `lasts`.
  Duration earliest(GlobalTime start, Duration lasts) const { return behind(start, lasts, false); }
  Duration latest(GlobalTime start, Duration lasts) const { return behind(start, lasts, true); }

 private:
  Duration behind(GlobalTime start, Duration lasts, bool latest) const;

  const model::Cluster& cluster_;
  std::string name_;
  Path path_;
  std::size_t first_;  // the stage of the task's execution
};

// Returns the chains that lead through the task's lists of a sensor. The cluster must have passed check().
std::vector<RestOfChain> rests_behind(const model::Cluster& cluster, NodeId node, const model::Task& task);

}  // namespace ttf::schedules::analysis::chain
