#include "schedules/left_out/earliest.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "schedules/analysis/can_load.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/left_out/items.h"
#include "schedules/left_out/periods.h"

namespace ttf::schedules::left_out {
namespace {

constexpr Ticks modulo(Ticks a, Ticks b) { return (a % b + b) % b; }

// Returns the last of the slots that is taken.
std::optional<int> last_taken(const model::Cluster& cluster, const List& list, int base_cycle, int slot, int slots) {
  model::FrameSlot wanted;
  wanted.base_cycle = base_cycle;
  wanted.repetition = list.repetition;
  std::optional<int> last;
  for (const model::FrameSlot& frame : cluster.frames) {
    if (frame.slot < slot || frame.slot >= slot + slots || !share_a_channel(frame.channels, list.channels)) continue;
    if (share_a_cycle(frame, wanted)) last = std::max(last.value_or(0), frame.slot);
  }
  return last;
}

// Return the first beginning at or after `from`, within one period, that no other item forbids; none if there is none. A task keeps
// off the tasks of its node that have an instant. A list has slots behind one another, which other frames have in other cycles.
std::optional<Ticks> free_on_processor(const Items& items, const Item& task, Ticks from) {
  Ticks start = from;
  for (bool moved = true; moved && start - from < task.period;) {
    moved = false;
    for (const Item& other : items.all) {
      if (&other == &task || other.place.kind != SchedulePlace::Kind::kTask ||
          other.place.task.node != task.place.task.node)
        continue;
      const std::optional<Ticks> begins = other.fixed ? other.fixed : other.at;
      if (!begins) continue;
      const Ticks common = std::gcd(task.period, other.period);
      const Ticks behind = modulo(start - *begins, common);
      if (behind < other.duration)
        start += other.duration - behind;
      else if (behind + task.duration > common)
        start += common - behind + other.duration;
      else
        continue;
      moved = true;
    }
  }
  return start - from < task.period ? std::optional(start) : std::nullopt;
}

std::optional<Ticks> free_slots(const model::Cluster& cluster, const List& list, Ticks slots, Ticks from) {
  const model::GlobalParameters& g = cluster.flexray;
  const Ticks last = last_slot(cluster) - slots + 1;
  const Ticks first_cycle = from / g.gMacroPerCycle;
  for (Ticks cycle = first_cycle; cycle <= first_cycle + list.repetition; ++cycle) {
    const Ticks begin = std::max<Ticks>(from - cycle * g.gMacroPerCycle, 0);
    Ticks slot = (begin + g.gdStaticSlot - 1) / g.gdStaticSlot + 1;
    while (slot <= last) {
      const auto taken = last_taken(cluster, list, static_cast<int>(cycle % list.repetition), static_cast<int>(slot),
                                    static_cast<int>(slots));
      if (!taken) return cycle * g.gMacroPerCycle + (slot - 1) * g.gdStaticSlot;
      slot = *taken + 1;
    }
  }
  return std::nullopt;
}

// An item before another one, and the time from its beginning to the earliest of the other.
struct Wait {
  std::size_t item = 0;
  Ticks gap = 0;
};

class Putting {
 public:
  Putting(model::Cluster& cluster, Parts& parts, Findings& findings)
      : cluster_(cluster), parts_(parts), findings_(findings), apart_ns_(analysis::clock_bounds(cluster).apart_ns),
        sources_(cluster), items_(items_of(cluster, parts)), earliest_(items_.all.size()) {
    for (const Item& item : items_.all) needs_.push_back(waits(item));
  }

  void put() {
    for (const List& list : parts_.lists)
      if (!list.at.instant) add_frames(cluster_, list);
    while (put_next() || put_fixed()) {
    }
    report_ring();
  }

 private:
  bool stands(std::size_t item) const { return items_.all[item].at.has_value(); }

  std::vector<Wait> waits(const Item& item) const {
    std::vector<Wait> found;
    switch (item.place.kind) {
      case SchedulePlace::Kind::kMeasurement: break;
      case SchedulePlace::Kind::kSlots:
        if (const auto writer = writer_of(cluster_, item.place.list, model::kFlexRay))
          add_waits(sources_.ready(*writer), found);
        break;
      case SchedulePlace::Kind::kTask:
        for (const TaskId& task : with_followers(item.place.task)) {
          for (const model::PortBinding& in : task_at(cluster_, task).reads)
            add_waits(sources_.arrival(in.pdu, in.medium), found);
          if (writes_image(cluster_, task)) wait_for_fusion(item.place.task, found);
        }
    }
    return found;
  }

  void add_waits(const std::vector<Source>& sources, std::vector<Wait>& found) const {
    for (const Source& source : sources) {
      const auto known = items_.places.find(source.place);
      if (known == items_.places.end()) continue;
      const bool slots = source.place.kind == SchedulePlace::Kind::kSlots;
      const std::int64_t sent_ps =
          slots ? items_.all[known->second].duration * cluster_.flexray.gdMacrotick_ps : std::int64_t{0};
      found.push_back({known->second, ticks(cluster_.flexray, source.ns + (sent_ps + 999) / 1'000 + apart_ns_)});
    }
  }

  std::vector<TaskId> with_followers(TaskId task) const {
    std::vector<TaskId> all = followers(cluster_, task);
    all.insert(all.begin(), task);
    return all;
  }

  void wait_for_fusion(TaskId image, std::vector<Wait>& found) const {
    for (std::size_t t = 0; t < cluster_.node(image.node).tasks.size(); ++t) {
      const TaskId other{image.node, t};
      const auto fusing = items_.places.find({SchedulePlace::Kind::kTask, kNoSensor, other, kNoPdu});
      if (other == image || fusing == items_.places.end()) continue;
      const std::vector<TaskId> all = with_followers(other);
      if (std::any_of(all.begin(), all.end(), [&](TaskId one) { return fuses(cluster_, one); }))
        found.push_back({fusing->second, items_.all[fusing->second].duration});
    }
  }

  // Returns when all that the item waits for is there; none while something of it does not stand. Gaps are counted once: when all
  // of it stands.
  std::optional<Ticks> earliest(std::size_t item) {
    const std::vector<Wait>& needs = needs_[item];
    if (!std::all_of(needs.begin(), needs.end(), [&](const Wait& wait) { return stands(wait.item); }))
      return std::nullopt;
    std::optional<Ticks>& from = earliest_[item];
    if (!from) {
      from = 0;
      for (const Wait& wait : waits(items_.all[item])) from = std::max(*from, *items_.all[wait.item].at + wait.gap);
    }
    return from;
  }

  // Returns the first beginning at or after `from` that the item may have.
  std::optional<Ticks> fitted(const Item& item, Ticks from) const {
    if (item.fixed) {
      const Ticks late = std::max<Ticks>(from - *item.fixed, 0);
      return *item.fixed + (late + item.period - 1) / item.period * item.period;
    }
    if (item.list)
      return free_slots(cluster_, parts_.lists[*item.list], item.duration / cluster_.flexray.gdStaticSlot, from);
    return item.place.kind == SchedulePlace::Kind::kTask ? free_on_processor(items_, item, from) : from;
  }

  // Puts the item that can begin first. Returns false if none can.
  bool put_next() {
    Item* best = nullptr;
    Ticks first = 0;
    for (std::size_t i = 0; i < items_.all.size(); ++i) {
      Item& item = items_.all[i];
      if (item.at) continue;
      const bool anywhere = item.list && parts_.lists[*item.list].anywhere;
      if (needs_[i].empty() && !item.fixed && !anywhere && item.place.kind != SchedulePlace::Kind::kMeasurement)
        return refuse(item, 0, no_beginning(item));
      const auto from = earliest(i);
      if (!from) continue;
      const auto start = fitted(item, *from);
      if (!start)
        return refuse(item, *from,
                      item.list ? "its list finds no free static slots one behind the other"
                                : "the other tasks of the node leave no time for it",
                      item.list.has_value());
      if (best == nullptr || *start < first) best = &item, first = *start;
    }
    if (best == nullptr) return false;
    best->at = first;
    if (!best->fixed) write(*best, first);
    return true;
  }

  // Returns why nothing leads to the item.
  std::string no_beginning(const Item& item) const {
    std::vector<model::PortBinding> lists;
    if (item.place.kind == SchedulePlace::Kind::kTask) lists = task_at(cluster_, item.place.task).reads;
    for (const model::PortBinding& list : lists) {
      const std::string& name = cluster_.pdu(list.pdu).name;
      if (list.medium.is_flexray() && !items_.places.contains({SchedulePlace::Kind::kSlots, kNoSensor, {}, list.pdu}))
        return fmt::format("{}, which it reads, has no static slots", name);
      if (!list.medium.is_can()) continue;
      const model::CanBus& bus = cluster_.can(list.medium);
      const double load = analysis::can_worst_load(cluster_, bus);
      if (load > analysis::kCanLoadLimit)
        return fmt::format(
            "{}, which it reads, comes at no certain time: the worst-case load of {} is {:.1f} %, above {:.0f} %", name,
            bus.name, 100.0 * load, 100.0 * analysis::kCanLoadLimit);
    }
    return "it takes nothing that the schedule begins";
  }

  // A ring ends where the file says an instant: that item takes the data of an earlier round.
  bool put_fixed() {
    const auto next =
        std::find_if(items_.all.begin(), items_.all.end(), [](const Item& item) { return !item.at && item.fixed; });
    if (next == items_.all.end()) return false;
    next->at = next->fixed;
    return true;
  }

  // The others go on, and may have findings of their own. No file has the parts of a copied sensor: the copy is refused.
  bool refuse(Item& item, Ticks at, const std::string& reason, bool lacks_slots = false) {
    item.at = at;
    if (const auto& copied = copied_for(item))
      findings_.add(cluster_.finding(item.line, fmt::format("sensors.{}.like", cluster_.sensor(copied->sensor).name),
                                     cluster_.sensor(copied->from).name, needs_of_copy(item, reason, lacks_slots)));
    else
      findings_.add(cluster_.finding(item.line, item.path + (item.list ? ".slot" : ".offset"), "",
                                     "must be in the file: " + reason));
    return true;
  }

  std::optional<Copied> copied_for(const Item& item) const {
    if (item.list) return parts_.lists[*item.list].copied;
    if (item.place.kind != SchedulePlace::Kind::kTask) return std::nullopt;
    return parts_.tasks[index_of(item.place.task.node)][item.place.task.task].copied;
  }

  std::string needs_of_copy(const Item& item, const std::string& reason, bool lacks_slots) const {
    if (!item.list) return fmt::format("needs an instant for {}: {}", item.path, reason);
    const PduId list = parts_.lists[*item.list].pdu;
    if (!lacks_slots) return fmt::format("needs an instant for {}: {}", cluster_.pdu(list).name, reason);
    return fmt::format("needs {} free static slots for {} among the {} of a cycle (flexray.gNumberOfStaticSlots): {}",
                       cluster_.pdu(list).max_fragments(), cluster_.pdu(list).name,
                       cluster_.flexray.gNumberOfStaticSlots, reason);
  }

  void write(const Item& item, Ticks start) {
    const model::GlobalParameters& g = cluster_.flexray;
    const int base_cycle = static_cast<int>(start % item.period / g.gMacroPerCycle);
    const Ticks offset = start % g.gMacroPerCycle;
    if (item.list) {
      List& list = parts_.lists[*item.list];
      list.base_cycle = base_cycle;
      list.slot = static_cast<int>(offset / g.gdStaticSlot) + 1;
      return add_frames(cluster_, list);
    }
    const bool measures = item.place.kind == SchedulePlace::Kind::kMeasurement;
    model::CycleInstant& at =
        measures ? cluster_.sensors[index_of(item.place.sensor)].at
                 : cluster_.nodes[index_of(item.place.task.node)].tasks[item.place.task.task].activation.at;
    at.base_cycle = base_cycle;
    at.offset = Macroticks{offset};
  }

  // All that is left waits for itself.
  void report_ring() {
    const auto left = std::find_if(items_.all.begin(), items_.all.end(), [](const Item& item) { return !item.at; });
    if (left == items_.all.end()) return;
    std::vector<std::size_t> way{static_cast<std::size_t>(left - items_.all.begin())};
    auto ring = way.end();
    while (ring == way.end()) {
      const std::vector<Wait>& needs = needs_[way.back()];
      const std::size_t next =
          std::find_if(needs.begin(), needs.end(), [&](const Wait& wait) { return !stands(wait.item); })->item;
      ring = std::find(way.begin(), way.end(), next);
      if (ring != way.end()) break;
      way.push_back(next);
      ring = way.end();
    }
    std::string words = items_.all[*ring].path;
    for (auto it = ring + 1; it != way.end(); ++it) words += fmt::format(" waits for {}, which", items_.all[*it].path);
    (void)refuse(items_.all[*ring], 0, words + " waits for the first");
  }

  model::Cluster& cluster_;
  Parts& parts_;
  Findings& findings_;
  std::int64_t apart_ns_;
  Sources sources_;
  Items items_;
  std::vector<std::vector<Wait>> needs_;        // by item; their gaps change until these stand
  std::vector<std::optional<Ticks>> earliest_;  // by item, once all that it needs stands
};

}  // namespace

void add_frames(model::Cluster& cluster, const List& list) {
  for (int f = 0; f < cluster.pdu(list.pdu).max_fragments(); ++f) {
    model::FrameSlot frame{list.slot + f, list.channels, list.base_cycle, list.repetition, list.sender, list.pdu, f,
                           list.line};
    frame.entry = list.entry;
    cluster.frames.push_back(frame);
  }
  model::order(cluster.frames);
}

void use_key_slots(const model::Cluster& cluster, std::vector<List>& lists) {
  for (List& list : lists) {
    const auto& flexray = cluster.node(list.sender).flexray;
    if (!flexray || cluster.pdu(list.pdu).max_fragments() > 1) continue;
    const int slot = flexray->pKeySlotId;
    const bool every_cycle = list.at.repetition || list.repetition == 1;
    if (list.channels != flexray->pChannels || !every_cycle ||
        (!list.at.instant && (list.slot != slot || list.base_cycle != 0)))
      continue;
    const bool taken = std::any_of(cluster.frames.begin(), cluster.frames.end(),
                                   [&](const model::FrameSlot& frame) { return frame.slot == slot; });
    const bool promised = std::any_of(lists.begin(), lists.end(), [&](const List& other) {
      return &other != &list && !other.at.instant && other.slot == slot;
    });
    if (taken || promised) continue;
    list.base_cycle = 0;
    list.repetition = 1;
    list.slot = slot;
    list.at = {};
  }
}

void put_earliest(model::Cluster& cluster, Parts& parts, Findings& findings) {
  Periods periods(cluster, parts.tasks);
  periods.set(parts.lists);
  set_shortest_periods(cluster, parts.shortest_periods, periods);
  Putting(cluster, parts, findings).put();
}

void set_deadlines(model::Cluster& cluster, const std::vector<std::vector<TaskParts>>& tasks) {
  constexpr std::int64_t kGrain = 10'000;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (std::none_of(tasks[n].begin(), tasks[n].end(), [](const TaskParts& task) { return task.deadline; })) continue;
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
