#include "schedules/synthesis/instants/reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/check.h"
#include "core/int128.h"
#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/model/round.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::instants {

using plan::by_time;
using plan::fuses;
using plan::Hop;
using plan::Plan;
using plan::PlannedChain;
using plan::PlannedList;
using plan::PlannedTask;
using plan::task_at;
using plan::TaskId;
using plan::way_to;
using plan::way_to_use;
namespace {

class Reader {
 public:
  Reader(const Plan& plan, const Timed& timed)
      : plan_(plan), timed_(timed), cluster_(timed.cluster), g_(cluster_.flexray),
        clocks_(analysis::clock_bounds(cluster_)), sources_(cluster_) {}

  Reading read() {
    add_resources();
    add_sensors();
    add_tasks();
    add_planned_lists();
    add_standing_frames();
    add_precedences();
    add_chains();
    if (plan_.in_order) add_fused();
    return std::move(made_);
  }

 private:
  Problem& problem() { return made_.problem; }
  Ticks cycle() const { return g_.gMacroPerCycle; }
  Ticks at(int base_cycle, Ticks offset) const { return base_cycle * cycle() + offset; }

  std::size_t add(Activity activity) {
    problem().activities.push_back(std::move(activity));
    return problem().activities.size() - 1;
  }

  void add_resources() {
    problem().resources.push_back({"the static segment"});
    for (const model::Node& node : cluster_.nodes)
      problem().resources.push_back({fmt::format("the processor of {}", node.name)});
  }

  void add_sensors() {
    for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
      const model::Sensor& sensor = cluster_.sensors[s];
      made_.sensors.emplace_back();
      if (!sensor.scheduled) continue;
      Activity activity;
      activity.name = fmt::format("sensors.{}", sensor.name);
      activity.period = sensor.at.repetition * cycle();
      if (!plan_.sensors[s].at.instant) activity.fixed = at(sensor.at.base_cycle, sensor.at.offset.value);
      made_.sensors.back() = add(std::move(activity));
    }
  }

  void add_tasks() {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const model::Node& node = cluster_.nodes[n];
      made_.tasks.emplace_back(node.tasks.size());
      for (std::size_t t = 0; t < node.tasks.size(); ++t) {
        const model::Task& task = node.tasks[t];
        if (!by_time(task)) continue;
        const PlannedTask& planned = plan_.tasks[n][t];
        Activity activity;
        activity.name = fmt::format("nodes.{}.tasks.{}", node.name, task.name);
        activity.resource = n + 1;
        activity.period = task.activation.at.repetition * cycle();
        activity.duration = ticks(g_, analysis::least_apart(cluster_, node, task.worst_case).ns);
        if (!planned.at.instant) activity.fixed = at(task.activation.at.base_cycle, task.activation.at.offset.value);
        made_.tasks.back()[t] = add(std::move(activity));
      }
    }
  }

  void own_slots(Activity& activity, NodeId sender) const {
    activity.turn = plan_.slot_multiplexing ? 0 : cycle();
    activity.owner = index_of(sender);
  }

  void add_planned_lists() {
    for (const PlannedList& list : timed_.lists) {
      const model::PduLayout& layout = cluster_.pdu(list.pdu);
      const Ticks fragments = layout.max_fragments();
      Activity activity;
      activity.name = fmt::format("frames of {}", layout.name);
      activity.resource = kStaticSegment;
      activity.period = list.repetition * cycle();
      activity.duration = fragments * g_.gdStaticSlot;
      activity.grid = {cycle(), 0, (left_out::last_slot(cluster_) - fragments) * g_.gdStaticSlot, g_.gdStaticSlot};
      activity.lanes = static_cast<std::uint8_t>(list.channels);
      own_slots(activity, list.sender);
      if (!list.at.instant) activity.fixed = at(list.base_cycle, (list.slot - 1) * Ticks{g_.gdStaticSlot});
      made_.lists.push_back(add(std::move(activity)));
      if (!slots_of_.contains(list.pdu)) slots_of_[list.pdu] = made_.lists.back();
    }
  }

  // Frames that stand: each list's slots of one base and repetition are an activity.
  void add_standing_frames() {
    for (std::size_t f = 0; f < cluster_.frames.size(); ++f) {
      const model::FrameSlot& frame = cluster_.frames[f];
      if (is_dynamic(g_, frame) || (frame.pdu != kNoPdu && frame.fragment != 0)) continue;
      Ticks slots = 1;
      auto lanes = static_cast<std::uint8_t>(frame.channels);
      for (const model::FrameSlot& other : cluster_.frames)
        if (frame.pdu != kNoPdu && other.pdu == frame.pdu && other.base_cycle == frame.base_cycle &&
            other.repetition == frame.repetition) {
          slots = std::max<Ticks>(slots, other.slot - frame.slot + 1);
          lanes |= static_cast<std::uint8_t>(other.channels);
        }
      Activity activity;
      activity.name = fmt::format("slot {}", frame.slot);
      activity.resource = kStaticSegment;
      activity.period = frame.repetition * cycle();
      activity.duration = slots * g_.gdStaticSlot;
      activity.fixed = at(frame.base_cycle, (frame.slot - 1) * Ticks{g_.gdStaticSlot});
      activity.lanes = lanes;
      own_slots(activity, frame.sender);
      const std::size_t made = add(std::move(activity));
      if (frame.pdu != kNoPdu && !slots_of_.contains(frame.pdu)) slots_of_[frame.pdu] = made;
    }
  }

  // Returns the activity of a place, if the plan gives its instant or chooses it.
  std::optional<std::size_t> activity_of(const left_out::SchedulePlace& place) const {
    switch (place.kind) {
      case left_out::SchedulePlace::Kind::kMeasurement: return made_.sensors[index_of(place.sensor)];
      case left_out::SchedulePlace::Kind::kTask: return made_.tasks[index_of(place.task.node)][place.task.task];
      case left_out::SchedulePlace::Kind::kSlots: {
        const auto slots = slots_of_.find(place.list);
        return slots == slots_of_.end() ? std::nullopt : std::optional(slots->second);
      }
    }
    return std::nullopt;
  }

  // `after` takes the data of all sources.
  void follow(const std::vector<left_out::Source>& sources, std::size_t after) {
    for (const left_out::Source& source : sources) {
      const auto before = activity_of(source.place);
      if (!before) continue;
      std::int64_t ns = source.ns;
      if (source.place.kind == left_out::SchedulePlace::Kind::kSlots)
        ns += (problem().activities[*before].duration * g_.gdMacrotick_ps + 999) / 1'000;
      follow(*before, after, ns);
    }
  }

  // `after` takes data that is there `ns` behind the beginning of `before`, by another clock.
  void follow(std::size_t before, std::size_t after, std::int64_t ns) {
    const Ticks gap = ticks(g_, ns + clocks_.apart_ns) - problem().activities[before].duration;
    follow_ticks(before, after, gap);
  }
  void follow_ticks(std::size_t before, std::size_t after, Ticks gap) {
    const auto [known, fresh] = precedence_.try_emplace({before, after}, problem().precedences.size());
    if (fresh)
      problem().precedences.push_back({before, after, gap});
    else
      problem().precedences[known->second].gap = std::max(problem().precedences[known->second].gap, gap);
  }

  void add_precedences() {
    for (const auto& [pdu, slots] : slots_of_)
      if (const auto writer = left_out::writer_of(cluster_, pdu, model::kFlexRay))
        follow(sources_.ready(*writer), slots);
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      const auto node = static_cast<NodeId>(n);
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) {
        const auto activity = made_.tasks[n][t];
        if (!activity) continue;
        for (const model::PortBinding& in : cluster_.nodes[n].tasks[t].reads)
          follow(sources_.arrival(in.pdu, in.medium), *activity);
        if (fuses(cluster_, {node, t})) before_image(n, *activity);
      }
    }
  }

  // The image is written behind the task that fuses.
  void before_image(std::size_t n, std::size_t fusing) {
    for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) {
      const bool writes_image = left_out::writes_image(cluster_, {static_cast<NodeId>(n), t});
      if (const auto publisher = made_.tasks[n][t]; publisher && writes_image && *publisher != fusing)
        follow_ticks(fusing, *publisher, 0);
    }
  }

  void add_chains() {
    for (const PlannedChain& planned : plan_.chains) {
      Chain chain;
      chain.name = planned.name;
      if (planned.largest_age) chain.largest_age = nominal(*planned.largest_age);
      chain.activities.push_back(*made_.sensors[index_of(planned.from)]);
      for (const Hop& hop : way_to(cluster_, planned.from, {planned.node, planned.task})) {
        if (hop.list != nullptr && hop.list->medium.is_flexray())
          if (const auto slots = slots_of_.find(hop.list->pdu); slots != slots_of_.end()) append(chain, slots->second);
        if (const auto task = made_.tasks[index_of(hop.at.node)][hop.at.task]) append(chain, *task);
      }
      problem().chains.push_back(std::move(chain));
    }
  }

  // Returns the longest way by one clock whose age is within the bound by any clock: both ends' difference, and the drift
  // (schedules/analysis/ages.h, A2).
  Ticks nominal(Duration largest) const {
    const std::int64_t ns = static_cast<std::int64_t>(static_cast<Int128>(largest.ns - clocks_.apart_ns - 1) *
                                                      1'000'000'000 / (1'000'000'000 + 2 * clocks_.drift_ppb));
    return ns < 0 ? -1 : static_cast<Ticks>(static_cast<Int128>(ns) * 1'000 / g_.gdMacrotick_ps);
  }

  void append(Chain& chain, std::size_t activity) {
    const auto known = precedence_.find({chain.activities.back(), activity});
    chain.gaps.push_back(known == precedence_.end() ? 0 : problem().precedences[known->second].gap);
    chain.activities.push_back(activity);
  }

  void add_fused() {
    // A stamp is a reading of a clock, at most a macrotick old and rounded to a microsecond (schedules/analysis/settled.h).
    made_.order = ticks(g_, clocks_.apart_ns + (g_.gdMacrotick_ps + 999) / 1'000 + 1'000);
    for (std::size_t s = 0; s < cluster_.sensors.size(); ++s) {
      if (!made_.sensors[s] || !model::row_of(cluster_.sensors[s].kind).observes) continue;
      for (const Hop& hop : way_to_use(cluster_, static_cast<SensorId>(s))) {
        const auto activity = made_.tasks[index_of(hop.at.node)][hop.at.task];
        if (!activity || !fuses(cluster_, hop.at)) continue;
        made_.fused.push_back({*made_.sensors[s], *activity, hop.at.node});
        break;
      }
    }
  }

  const Plan& plan_;
  const Timed& timed_;
  const model::Cluster& cluster_;
  const model::GlobalParameters& g_;
  analysis::ClockBounds clocks_;
  left_out::Sources sources_;
  std::map<PduId, std::size_t> slots_of_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> precedence_;
  Reading made_;
};

}  // namespace

Reading reading(const Plan& plan, const Timed& timed) { return Reader(plan, timed).read(); }

std::optional<Read> read_of(const Plan& plan, const Candidate& candidate) {
  auto made = timed(plan, candidate);
  if (!made) return std::nullopt;
  Reading read = reading(plan, *made);
  return Read{std::move(*made), std::move(read)};
}

Ticks last_slot_of(const Read& read, const Solution& solution) {
  const model::GlobalParameters& g = read.timed.cluster.flexray;
  const Problem& problem = read.reading.problem;
  Ticks end = 0;
  for (std::size_t a = 0; a < problem.activities.size(); ++a)
    if (problem.activities[a].resource == kStaticSegment)
      end = std::max(end, solution.offsets[a] % g.gMacroPerCycle + problem.activities[a].duration);
  return (end + g.gdStaticSlot - 1) / g.gdStaticSlot;
}

Ticks least_slots(const Read& read) {
  const model::GlobalParameters& g = read.timed.cluster.flexray;
  Ticks least = 0;
  for (const std::uint8_t lane : kLanes) {
    double load = 0;
    for (const Activity& one : read.reading.problem.activities) {
      if (one.resource != kStaticSegment || (one.lanes & lane) == 0) continue;
      least = std::max(least, (one.fixed.value_or(0) % g.gMacroPerCycle + one.duration) / g.gdStaticSlot);
      load += static_cast<double>(one.duration / g.gdStaticSlot) * g.gMacroPerCycle / static_cast<double>(one.period);
    }
    least = std::max(least, static_cast<Ticks>(load - 1e-9) + 1);
  }
  return least;
}

double free_share(const Read& read) {
  const model::GlobalParameters& g = read.timed.cluster.flexray;
  double used = 0;
  for (const std::uint8_t lane : kLanes)
    for (const Activity& activity : read.reading.problem.activities)
      if (activity.resource == kStaticSegment && (activity.lanes & lane) != 0)
        used += static_cast<double>(activity.duration) / g.gdStaticSlot * g.gMacroPerCycle /
                static_cast<double>(activity.period);
  return 1.0 - used / std::size(kLanes) / g.gNumberOfStaticSlots;
}

}  // namespace ttf::schedules::synthesis::instants
