#include "schedules/left_out/earliest.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/left_out/periods.h"
#include "schedules/left_out/sources.h"

namespace ttf::schedules::left_out {
namespace {

constexpr Ticks rest(Ticks a, Ticks b) { return (a % b + b) % b; }

// Something that begins once a period: what the file says, or what it leaves out.
struct Item {
  Place place;
  std::string path;  // in the file's words
  int line = 0;
  Ticks period = 0, duration = 0;
  std::optional<Ticks> fixed;       // where the file says it
  std::optional<Ticks> at;          // counted on from the beginning of the round
  std::optional<std::size_t> list;  // of Parts::lists
};

class Putting {
 public:
  Putting(model::Cluster& cluster, Parts& parts, Findings& findings)
      : cluster_(cluster), parts_(parts), findings_(findings), g_(cluster.flexray),
        apart_ns_(analysis::clock_bounds(cluster).apart_ns), sources_(cluster) {}

  void put() {
    add_sensors();
    add_tasks();
    add_lists();
    add_standing_lists();
    while (put_next() || put_fixed()) {
    }
    report_ring();
  }

 private:
  Ticks cycle() const { return g_.gMacroPerCycle; }
  Ticks at(int base_cycle, Ticks offset) const { return base_cycle * cycle() + offset; }
  static Ticks at_start(const std::optional<Ticks>& fixed) { return fixed.value_or(0); }

  void add(Item item) {
    places_.try_emplace(item.place, items_.size());  // of a list's slots the first
    items_.push_back(std::move(item));
  }

  void add_sensors() {
    for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
      const model::Sensor& sensor = cluster_.sensors[s];
      if (!sensor.scheduled) continue;
      Item item{{Place::Kind::kMeasurement, static_cast<SensorId>(s), {}, kNoPdu},
                "sensors." + sensor.name,
                sensor.line,
                sensor.at.repetition * cycle(),
                0,
                {},
                {},
                {}};
      if (!parts_.sensors[s].instant) item.fixed = at(sensor.at.base_cycle, sensor.at.offset.value);
      add(std::move(item));
    }
  }

  void add_tasks() {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const model::Node& node = cluster_.nodes[n];
      for (std::size_t t = 0; t < node.tasks.size(); ++t) {
        const model::Task& task = node.tasks[t];
        if (!by_time(task)) continue;
        Item item{{Place::Kind::kTask, kNoSensor, {static_cast<NodeId>(n), t}, kNoPdu},
                  fmt::format("nodes.{}.tasks.{}.activation", node.name, task.name),
                  parts_.tasks[n][t].line,
                  task.activation.at.repetition * cycle(),
                  ticks(g_, analysis::least_apart(cluster_, node, task.worst_case).ns),
                  {},
                  {},
                  {}};
        if (!parts_.tasks[n][t].at.instant)
          item.fixed = at(task.activation.at.base_cycle, task.activation.at.offset.value);
        add(std::move(item));
      }
    }
  }

  void add_lists() {
    for (std::size_t l = 0; l < parts_.lists.size(); ++l) {
      const List& list = parts_.lists[l];
      Item item{{Place::Kind::kSlots, kNoSensor, {}, list.pdu},
                fmt::format("frames[{}]", list.entry.value_or(0)),
                list.line,
                list.repetition * cycle(),
                cluster_.pdu(list.pdu).max_fragments() * Ticks{g_.gdStaticSlot},
                {},
                {},
                l};
      if (!list.at.instant) item.fixed = at(list.base_cycle, (list.slot - 1) * Ticks{g_.gdStaticSlot});
      add(std::move(item));
      if (!list.at.instant) add_frames(list);
    }
  }

  // Lists that have their slots: the first ones of each are where its data passes.
  void add_standing_lists() {
    const std::vector<model::FrameSlot> frames = cluster_.frames;
    for (const model::FrameSlot& frame : frames) {
      const Place place{Place::Kind::kSlots, kNoSensor, {}, frame.pdu};
      if (frame.pdu == kNoPdu || frame.fragment != 0 || is_dynamic(g_, frame) || places_.contains(place)) continue;
      int last = frame.slot;
      for (const model::FrameSlot& other : frames)
        if (other.pdu == frame.pdu && other.base_cycle == frame.base_cycle && other.repetition == frame.repetition)
          last = std::max(last, other.slot);
      add({place,
           "",
           frame.line,
           frame.repetition * cycle(),
           (last - frame.slot + 1) * Ticks{g_.gdStaticSlot},
           at(frame.base_cycle, (frame.slot - 1) * Ticks{g_.gdStaticSlot}),
           {},
           {}});
    }
  }

  // What the item waits for, and how long from the beginning of that.
  struct Wait {
    std::size_t item = 0;
    Ticks gap = 0;
  };
  std::vector<Wait> waits(const Item& item) const {
    std::vector<Wait> found;
    const auto add_sources = [&](const std::vector<Source>& sources) {
      for (const Source& source : sources) {
        const auto known = places_.find(source.place);
        if (known == places_.end()) continue;
        const bool slots = source.place.kind == Place::Kind::kSlots;
        const std::int64_t sent_ps = slots ? items_[known->second].duration * g_.gdMacrotick_ps : 0;
        found.push_back({known->second, ticks(g_, source.ns + (sent_ps + 999) / 1'000 + apart_ns_)});
      }
    };
    if (item.place.kind == Place::Kind::kSlots) {
      if (const auto writer = writer_of(cluster_, item.place.list, model::kFlexRay))
        add_sources(sources_.ready(*writer));
    } else if (item.place.kind == Place::Kind::kTask) {
      const TaskId task = item.place.task;
      for (const model::PortBinding& in : task_at(cluster_, task).reads)
        add_sources(sources_.arrival(in.pdu, in.medium));
      for (std::size_t t = 0; writes_image(cluster_, task) && t < cluster_.node(task.node).tasks.size(); ++t) {
        const auto fusing = places_.find({Place::Kind::kTask, kNoSensor, {task.node, t}, kNoPdu});
        if (t != task.task && fusing != places_.end() && fuses(cluster_, {task.node, t}))
          found.push_back({fusing->second, items_[fusing->second].duration});
      }
    }
    return found;
  }

  // Returns when all that the item waits for is there; none while something of it has no place.
  std::optional<Ticks> earliest(const std::vector<Wait>& waits) const {
    Ticks found = 0;
    for (const Wait& wait : waits) {
      if (!items_[wait.item].at) return std::nullopt;
      found = std::max(found, *items_[wait.item].at + wait.gap);
    }
    return found;
  }

  // Puts the item that can begin first. Returns false if none can.
  bool put_next() {
    std::size_t best = items_.size();
    Ticks first = 0;
    for (std::size_t i = 0; i < items_.size(); ++i) {
      if (items_[i].at) continue;
      const std::vector<Wait> waiting = waits(items_[i]);
      if (!items_[i].fixed && waiting.empty() && items_[i].place.kind != Place::Kind::kMeasurement) {
        refuse(items_[i], "must be in the file: nothing that the schedule begins leads to it");
        items_[i].at = 0;
        return true;
      }
      const auto from = earliest(waiting);
      if (!from) continue;
      const auto start = fitted(items_[i], waiting.empty() ? at_start(items_[i].fixed) : *from);
      if (!start) {
        refuse(items_[i], items_[i].list
                              ? "must be in the file: no free static slots for the whole list, one behind the other"
                              : "must be in the file: other tasks leave the processor no time for it");
        items_[i].at = *from;
        return true;
      }
      if (best == items_.size() || *start < first) best = i, first = *start;
    }
    if (best == items_.size()) return false;
    place(items_[best], first);
    return true;
  }

  // A ring ends where the file says an instant: what it hands on has another round's data.
  bool put_fixed() {
    for (Item& item : items_)
      if (!item.at && item.fixed) {
        item.at = item.fixed;
        return true;
      }
    return false;
  }

  void refuse(const Item& item, std::string expected) {
    findings_.add(cluster_.finding(item.line, item.path + (item.list ? ".slot" : ".offset"), "", std::move(expected)));
  }

  // Returns the first beginning at or after `from` that the item's resource allows.
  std::optional<Ticks> fitted(const Item& item, Ticks from) const {
    if (item.fixed)
      return *item.fixed +
             (from > *item.fixed ? (from - *item.fixed + item.period - 1) / item.period * item.period : 0);
    if (item.place.kind == Place::Kind::kTask) return free_processor(item, from);
    if (item.list) return free_slots(item, from);
    return from;
  }

  std::optional<Ticks> free_processor(const Item& item, const Ticks from) const {
    Ticks start = from;
    for (bool moved = true; moved && start - from < item.period;) {
      moved = false;
      for (const Item& other : items_) {
        if (&other == &item || other.place.kind != Place::Kind::kTask || other.place.task.node != item.place.task.node)
          continue;
        if (!other.fixed && !other.at) continue;
        const Ticks common = std::gcd(item.period, other.period);
        const Ticks behind = rest(start - other.fixed.value_or(other.at.value_or(0)), common);
        if (behind < other.duration)
          start += other.duration - behind;
        else if (behind + item.duration > common)
          start += common - behind + other.duration;
        else
          continue;
        moved = true;
      }
    }
    return start - from < item.period ? std::optional(start) : std::nullopt;
  }

  std::optional<Ticks> free_slots(const Item& item, Ticks from) const {
    const List& list = parts_.lists[*item.list];
    const Ticks slots = item.duration / g_.gdStaticSlot;
    for (Ticks c = from / cycle(); c <= from / cycle() + list.repetition; ++c) {
      const Ticks begin = std::max<Ticks>(from - c * cycle(), 0);
      for (Ticks slot = (begin + g_.gdStaticSlot - 1) / g_.gdStaticSlot + 1; slot + slots - 1 <= last_slot(cluster_);) {
        const auto taken =
            last_taken(list, static_cast<int>(slot), static_cast<int>(slots), static_cast<int>(c % list.repetition));
        if (!taken) return c * cycle() + (slot - 1) * g_.gdStaticSlot;
        slot = *taken + 1;
      }
    }
    return std::nullopt;
  }

  // Returns the last of the slots that is not free for the list.
  std::optional<int> last_taken(const List& list, int slot, int slots, int base_cycle) const {
    model::FrameSlot wanted;
    wanted.base_cycle = base_cycle;
    wanted.repetition = list.repetition;
    std::optional<int> last;
    for (const model::FrameSlot& frame : cluster_.frames) {
      if (frame.slot < slot || frame.slot >= slot + slots || !share_a_channel(frame.channels, list.channels)) continue;
      if (frame.sender != list.sender || share_a_cycle(frame, wanted)) last = std::max(last.value_or(0), frame.slot);
    }
    return last;
  }

  void place(Item& item, Ticks start) {
    item.at = start;
    if (item.fixed) return;
    const Ticks within = rest(start, item.period);
    const int base_cycle = static_cast<int>(within / cycle());
    const Ticks offset = within % cycle();
    if (item.list) {
      List& list = parts_.lists[*item.list];
      list.base_cycle = base_cycle;
      list.slot = static_cast<int>(offset / g_.gdStaticSlot) + 1;
      add_frames(list);
      return;
    }
    model::CycleInstant& instant =
        item.place.kind == Place::Kind::kMeasurement
            ? cluster_.sensors[index_of(item.place.sensor)].at
            : cluster_.nodes[index_of(item.place.task.node)].tasks[item.place.task.task].activation.at;
    instant.base_cycle = base_cycle;
    instant.offset = Macroticks{offset};
  }

  void add_frames(const List& list) {
    for (int f = 0; f < cluster_.pdu(list.pdu).max_fragments(); ++f) {
      model::FrameSlot frame{list.slot + f, list.channels, list.base_cycle, list.repetition, list.sender, list.pdu, f,
                             list.line};
      frame.entry = list.entry;
      cluster_.frames.push_back(frame);
    }
    std::stable_sort(cluster_.frames.begin(), cluster_.frames.end(), [](const auto& a, const auto& b) {
      return std::pair{a.slot, a.base_cycle} < std::pair{b.slot, b.base_cycle};
    });
  }

  // What is left waits for itself.
  void report_ring() {
    const auto open = std::find_if(items_.begin(), items_.end(), [](const Item& item) { return !item.at; });
    if (open == items_.end()) return;
    std::vector<std::size_t> way{static_cast<std::size_t>(open - items_.begin())};
    auto begin = way.end();
    while (true) {
      const std::vector<Wait> waiting = waits(items_[way.back()]);
      const auto next =
          std::find_if(waiting.begin(), waiting.end(), [&](const Wait& wait) { return !items_[wait.item].at; });
      begin = std::find(way.begin(), way.end(), next->item);
      if (begin != way.end()) break;
      way.push_back(next->item);
    }
    std::string ring = items_[*begin].path;
    for (auto it = begin + 1; it != way.end(); ++it) ring += fmt::format(" waits for {}, which", items_[*it].path);
    refuse(items_[*begin], fmt::format("must be in the file: {} waits for the first", ring));
  }

  model::Cluster& cluster_;
  Parts& parts_;
  Findings& findings_;
  const model::GlobalParameters& g_;
  std::int64_t apart_ns_;
  Sources sources_;
  std::vector<Item> items_;
  std::map<Place, std::size_t> places_;
};

}  // namespace

void put_earliest(model::Cluster& cluster, Parts& parts, Findings& findings) {
  Periods periods(cluster, parts.tasks);
  periods.set(parts.lists);
  set_shortest_periods(cluster, parts.shortest_periods, periods);
  Putting(cluster, parts, findings).put();
}

void set_deadlines(model::Cluster& cluster, const std::vector<std::vector<Task>>& tasks) {
  constexpr std::int64_t kGrain = 10'000;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (std::none_of(tasks[n].begin(), tasks[n].end(), [](const Task& task) { return task.deadline; })) continue;
    const auto responses = analysis::worst_responses(cluster, static_cast<NodeId>(n));
    for (std::size_t t = 0; t < tasks[n].size(); ++t) {
      model::Task& task = cluster.nodes[n].tasks[t];
      if (!tasks[n][t].deadline) continue;
      const Duration worst = responses ? (*responses)[t].worst : task.worst_case;
      task.deadline = {(worst.ns + kGrain - 1) / kGrain * kGrain};
    }
  }
}

}  // namespace ttf::schedules::left_out
