#include "schedules/left_out/items.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "schedules/analysis/responses.h"

namespace ttf::schedules::left_out {
namespace {

class Collector {
 public:
  Collector(const model::Cluster& cluster, const Parts& parts)
      : cluster_(cluster), parts_(parts), g_(cluster.flexray) {}

  Items collect() {
    add_sensors();
    add_tasks();
    add_lists();
    add_standing_lists();
    return std::move(found_);
  }

 private:
  Ticks at(const model::CycleInstant& instant) const {
    return instant.base_cycle * Ticks{g_.gMacroPerCycle} + instant.offset.value;
  }
  Ticks at_slot(int base_cycle, int slot) const {
    return base_cycle * Ticks{g_.gMacroPerCycle} + (slot - 1) * Ticks{g_.gdStaticSlot};
  }

  void add(SchedulePlace place, std::string path, int line, int repetition, Ticks duration, std::optional<Ticks> fixed,
           std::optional<std::size_t> list = std::nullopt) {
    found_.places.try_emplace(place, found_.all.size());
    found_.all.push_back(
        {place, std::move(path), line, repetition * Ticks{g_.gMacroPerCycle}, duration, fixed, list, std::nullopt});
  }

  void add_sensors() {
    for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
      const model::Sensor& sensor = cluster_.sensors[s];
      if (!sensor.scheduled) continue;
      add({SchedulePlace::Kind::kMeasurement, static_cast<SensorId>(s), {}, kNoPdu}, "sensors." + sensor.name,
          sensor.line, sensor.at.repetition, 0,
          parts_.sensors[s].instant ? std::nullopt : std::optional(at(sensor.at)));
    }
  }

  void add_tasks() {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const model::Node& node = cluster_.nodes[n];
      for (std::size_t t = 0; t < node.tasks.size(); ++t) {
        const model::Task& task = node.tasks[t];
        if (!by_time(task)) continue;
        const TaskParts& left = parts_.tasks[n][t];
        const TaskId id{static_cast<NodeId>(n), t};
        Duration executions = task.worst_case;  // with all that follow it
        for (const TaskId& follower : followers(cluster_, id)) executions += task_at(cluster_, follower).worst_case;
        add({SchedulePlace::Kind::kTask, kNoSensor, id, kNoPdu},
            fmt::format("nodes.{}.tasks.{}.activation", node.name, task.name), left.line, task.activation.at.repetition,
            ticks(g_, analysis::least_apart(cluster_, node, executions).ns),
            left.at.instant ? std::nullopt : std::optional(at(task.activation.at)));
      }
    }
  }

  void add_lists() {
    for (std::size_t l = 0; l < parts_.lists.size(); ++l) {
      const List& list = parts_.lists[l];
      add({SchedulePlace::Kind::kSlots, kNoSensor, {}, list.pdu}, path_of(cluster_, list), list.line, list.repetition,
          cluster_.pdu(list.pdu).max_fragments() * Ticks{g_.gdStaticSlot},
          list.at.instant ? std::nullopt : std::optional(at_slot(list.base_cycle, list.slot)), l);
    }
  }

  // The first slots of a list are where its data passes.
  void add_standing_lists() {
    for (const model::FrameSlot& frame : cluster_.frames) {
      const SchedulePlace place{SchedulePlace::Kind::kSlots, kNoSensor, {}, frame.pdu};
      if (frame.pdu == kNoPdu || frame.fragment != 0 || is_dynamic(g_, frame) || found_.places.contains(place))
        continue;
      int last = frame.slot;
      for (const model::FrameSlot& other : cluster_.frames)
        if (other.pdu == frame.pdu && other.base_cycle == frame.base_cycle && other.repetition == frame.repetition)
          last = std::max(last, other.slot);
      add(place, "", frame.line, frame.repetition, (last - frame.slot + 1) * Ticks{g_.gdStaticSlot},
          at_slot(frame.base_cycle, frame.slot));
    }
  }

  const model::Cluster& cluster_;
  const Parts& parts_;
  const model::GlobalParameters& g_;
  Items found_;
};

}  // namespace

std::string path_of(const model::Cluster& cluster, const List& list) {
  return list.entry ? fmt::format("frames[{}]", *list.entry) : fmt::format("frames ({})", cluster.pdu(list.pdu).name);
}

Items items_of(const model::Cluster& cluster, const Parts& parts) { return Collector(cluster, parts).collect(); }

}  // namespace ttf::schedules::left_out
