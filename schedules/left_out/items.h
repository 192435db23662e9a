// The places of a schedule, each with its period: those that the file says, and those that it leaves out.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "schedules/left_out/parts.h"
#include "schedules/left_out/sources.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::left_out {

struct Item {
  SchedulePlace place;
  std::string path;  // in the file's words; empty for a list that stands
  int line = 0;
  Ticks period = 0, duration = 0;
  std::optional<Ticks> fixed;       // within the period, where the file says it
  std::optional<std::size_t> list;  // its number in Parts::lists
  std::optional<Ticks> at;          // once it is put: counted on from the beginning of the round
};

struct Items {
  std::vector<Item> all;                        // sensors, tasks, lists, in the order of the file
  std::map<SchedulePlace, std::size_t> places;  // a list's first slots
};

// Returns the scheduled measurements, the tasks that time activates, and the lists in static slots. Repetitions are known.
Items items_of(const model::Cluster& cluster, const Parts& parts);

}  // namespace ttf::schedules::left_out
