// The periods that follow from others.
//
//   A task has the shortest repetition of the lists that it reads; without lists, that of the tasks of its node that fuse.
//   A list has its writer's, or else the largest repetition of a frame that divides it. A writer that a sensor activates has
//   the sensor's.
#pragma once

#include <vector>

#include "schedules/left_out/parts.h"
#include "schedules/left_out/tasks.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::left_out {

class Periods {
 public:
  // `tasks` by node and task. Both must outlive the object.
  Periods(model::Cluster& cluster, const std::vector<std::vector<TaskParts>>& tasks);

  // Sets the repetitions that the tasks and lists leave out.
  void set(std::vector<List>& lists);

  // Return a repetition in cycles: the longest one, where nothing says how often.
  int of(TaskId id);
  int of_list(PduId pdu, model::MediumId medium);

 private:
  int derived(TaskId id);

  model::Cluster& cluster_;
  const std::vector<std::vector<TaskParts>>& tasks_;
  const int seldom_;                     // where nothing says how often
  std::vector<std::vector<int>> state_;  // by node and task
};

// Sets the shortest periods of CAN messages that are left out, by CAN and message, to a bound from below: the writer's period
// less what its execution, the drifts and the difference of clocks may take. No instant is needed.
void set_shortest_periods(model::Cluster& cluster, const std::vector<std::vector<bool>>& absent, Periods& periods);

}  // namespace ttf::schedules::left_out
