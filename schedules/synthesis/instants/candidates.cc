#include "schedules/synthesis/instants/candidates.h"

#include <algorithm>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/parameter_bounds.h"
#include "schedules/analysis/responses.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/model/limits.h"
#include "schedules/model/repetitions.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::instants {

using plan::by_time;
using plan::fuses;
using plan::LeftOutParameters;
using plan::Plan;
using plan::PlannedList;
using plan::task_at;
using plan::TaskId;
namespace {

constexpr int kCorrectionRoom = 100;  // macroticks behind gOffsetCorrectionStart

// A list of the layout is told apart by its header, and is no longer than records can number.
bool is_numbered(const model::PduLayout& layout, const model::PduLayout& with_signals) {
  const auto found = find_signal(with_signals.header, "fragment");
  return found && layout.max_fragments() <= model::kMostFragments &&
         layout.max_fragments() <= std::int64_t{1} << with_signals.header[*found].bits;
}

// Sets the payload of static slots, their length and the free layouts. Returns false if something does not fit.
bool set_payload(const Plan& plan, int bytes, Timed& timed) {
  model::Cluster& cluster = timed.cluster;
  cluster.flexray.gPayloadLengthStatic = bytes / 2;
  const auto shortest = analysis::shortest_static_slot(cluster.flexray);
  if (plan.parameters.slot_length)
    cluster.flexray.gdStaticSlot = static_cast<int>(std::min<std::int64_t>(shortest, 661));
  if (cluster.flexray.gdStaticSlot < shortest) return false;
  for (std::size_t p = 0; p < cluster.pdus.size(); ++p) {
    model::PduLayout& layout = cluster.pdus[p];
    if (!plan.free_layouts[p]) continue;
    layout.fragment_bytes = bytes;
    layout.elements_per_fragment = model::most_elements(bytes, layout.header_bits, layout.element_bits);
    if (layout.header_bits + layout.elements_per_fragment * layout.element_bits > 8 * bytes) return false;
    if (!is_numbered(layout, plan.unchanging->pdus[p])) return false;
  }
  const auto fits = [&](PduId pdu, int before) { return before + cluster.pdu(pdu).fragment_bytes <= bytes; };
  return std::all_of(timed.lists.begin(), timed.lists.end(), [&](const auto& list) { return fits(list.pdu, 0); }) &&
         std::all_of(cluster.frames.begin(), cluster.frames.end(), [&](const model::FrameSlot& frame) {
           return frame.pdu == kNoPdu || is_dynamic(cluster.flexray, frame) ||
                  fits(frame.pdu, preamble_bytes(cluster.flexray, frame));
         });
}

// Sets FlexRay's parameters. Returns false if one leaves its range.
bool set_parameters(const Plan& plan, Duration cycle, model::Cluster& cluster) {
  model::GlobalParameters& g = cluster.flexray;
  const std::int64_t cycle_ps = cycle.ns * 1'000;
  if (cycle_ps % g.gdMacrotick_ps != 0 || cycle_ps / g.gdMacrotick_ps > 16'000) return false;
  g.gdCycle_ps = cycle_ps;
  g.gMacroPerCycle = static_cast<int>(cycle_ps / g.gdMacrotick_ps);
  const int rest = g.gMacroPerCycle - analysis::segments_sum(g) + g.gNumberOfStaticSlots * g.gdStaticSlot;
  if (plan.parameters.static_slots) {
    const int idle = plan.parameters.idle_time ? kCorrectionRoom : g.gdNIT;
    g.gNumberOfStaticSlots = std::min((rest - idle) / g.gdStaticSlot, 1023);
  }
  if (plan.parameters.idle_time) g.gdNIT = rest - g.gNumberOfStaticSlots * g.gdStaticSlot;
  if (plan.parameters.correction_start)
    g.gOffsetCorrectionStart = g.gMacroPerCycle - std::min(g.gdNIT, kCorrectionRoom);
  if (g.gNumberOfStaticSlots < 2 || g.gdNIT < 2 || g.gdNIT > 805) return false;
  return rest == g.gNumberOfStaticSlots * g.gdStaticSlot + g.gdNIT;  // constraint 18
}

void set_controllers(const Plan& plan, model::Cluster& cluster) {
  std::int64_t worst = 0;
  for (const model::Node& node : cluster.nodes)
    if (node.flexray) worst = std::max(worst, analysis::worst_drift_ppb(node));
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    if (!cluster.nodes[n].flexray) continue;
    model::NodeParameters& p = *cluster.nodes[n].flexray;
    const analysis::Terms terms{cluster.flexray, p, analysis::worst_drift_ppb(cluster.nodes[n]), worst};
    const LeftOutParameters::Controller& left = plan.parameters.controllers[n];
    if (left.microticks) p.pMicroPerCycle = static_cast<int>(cluster.flexray.gdCycle_ps / p.pdMicrotick_ps);
    if (left.rate)
      p.pRateCorrectionOut = static_cast<int>(std::max<std::int64_t>(analysis::least_rate_correction(terms), 2));
    if (left.listen) p.pdListenTimeout = static_cast<int>(analysis::listen_timeout(terms));
  }
}

// Chooses the repetitions of tasks and lists by those of the sensors.
class Periods {
 public:
  Periods(const Plan& plan, Timed& timed) : plan_(plan), timed_(timed), cluster_(timed.cluster) {
    for (const model::Node& node : cluster_.nodes) state_.emplace_back(node.tasks.size(), 0);
  }

  void set() {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t) (void)of({static_cast<NodeId>(n), t});
    for (PlannedList& list : timed_.lists)
      if (list.at.repetition) list.repetition = of_list(list.pdu, model::kFlexRay);
  }

  // Returns the repetition of a task in cycles.
  int of(TaskId id) {
    int& known = state_[index_of(id.node)][id.task];
    if (known == kAsked) return seldom_;  // a ring: its other lists decide
    if (known != 0) return known;
    known = kAsked;
    const int found = find(id);
    model::Task& task = cluster_.nodes[index_of(id.node)].tasks[id.task];
    if (by_time(task) && plan_.tasks[index_of(id.node)][id.task].at.repetition) task.activation.at.repetition = found;
    return state_[index_of(id.node)][id.task] = found;
  }

  // Returns the repetition of the list's writer.
  int of_list(PduId pdu, model::MediumId medium) {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (std::size_t t = 0; t < cluster_.nodes[n].tasks.size(); ++t)
        for (const model::PortBinding& out : cluster_.nodes[n].tasks[t].writes)
          if (out.pdu == pdu && out.medium == medium) return of({static_cast<NodeId>(n), t});
    return seldom_;
  }

 private:
  static constexpr int kAsked = -1;

  int find(TaskId id) {
    const model::Task& task = task_at(cluster_, id);
    if (task.activation.kind == model::ActivationKind::kSensor) {
      const model::Sensor& sensor = cluster_.sensor(task.activation.sensor);
      return sensor.scheduled ? sensor.at.repetition : seldom_;
    }
    if (by_time(task) && !plan_.tasks[index_of(id.node)][id.task].at.repetition) return task.activation.at.repetition;
    int least = seldom_;
    for (const model::PortBinding& in : task.reads)
      if (task.activation.kind != model::ActivationKind::kMessage || activates(task, in))
        least = std::min(least, of_list(in.pdu, in.medium));
    if (!task.reads.empty()) return least;
    for (std::size_t t = 0; t < cluster_.node(id.node).tasks.size(); ++t)
      if (fuses(cluster_, {id.node, t})) least = std::min(least, of({id.node, t}));
    return least;
  }

  const Plan& plan_;
  Timed& timed_;
  model::Cluster& cluster_;
  const int seldom_ = model::frame_repetitions(cluster_.flexray).back();  // where nothing says how often
  std::vector<std::vector<int>> state_;
};

// A bound from below of the time between two lists of a sensor's device: the checker proves it (check/responses.cc).
void set_shortest_periods(const Plan& plan, model::Cluster& cluster, Periods& periods) {
  const analysis::ClockBounds clocks = analysis::clock_bounds(cluster);
  for (std::size_t c = 0; c < cluster.can_buses.size(); ++c)
    for (std::size_t m = 0; m < cluster.can_buses[c].messages.size(); ++m) {
      if (!plan.shortest_periods[c][m]) continue;
      model::CanMessage& message = cluster.can_buses[c].messages[m];
      const Duration period = cluster.cycle() * periods.of_list(message.pdu, model::MediumId::can(c));
      Duration varies = Duration::microseconds(100);
      for (const model::Task& task : cluster.node(message.sender).tasks)
        for (const model::PortBinding& out : task.writes)
          if (out.pdu == message.pdu) varies += task.worst_case - analysis::shortest_execution(task);
      const std::int64_t least = period.ns - 2 * clocks.drift_ns(period.ns) - varies.ns;
      message.shortest_period = {std::max<std::int64_t>(100'000, least / 10'000 * 10'000)};
    }
}

bool fixed_instants_fit(const Plan& plan, const Timed& timed) {
  const auto fits = [&](const model::CycleInstant& at) {
    return at.base_cycle < at.repetition && at.offset.value < timed.cluster.flexray.gMacroPerCycle;
  };
  for (std::size_t n = 0; n < plan.tasks.size(); ++n)
    for (std::size_t t = 0; t < plan.tasks[n].size(); ++t) {
      const model::Task& task = timed.cluster.nodes[n].tasks[t];
      if (by_time(task) && !plan.tasks[n][t].at.instant && !fits(task.activation.at)) return false;
    }
  for (std::size_t s = 0; s < plan.sensors.size(); ++s) {
    const model::Sensor& sensor = timed.cluster.sensors[s];
    if (sensor.scheduled && !plan.sensors[s].at.instant && !fits(sensor.at)) return false;
  }
  return std::all_of(timed.lists.begin(), timed.lists.end(),
                     [](const PlannedList& list) { return list.at.instant || list.base_cycle < list.repetition; });
}

// Returns the repetitions that a sensor may have in a cycle of this length.
std::vector<int> repetitions(const Plan& plan, std::size_t sensor, Duration cycle) {
  if (!plan.sensors[sensor].at.repetition) return {plan.cluster.sensors[sensor].at.repetition};
  const auto& rate = plan.sensors[sensor].rate;
  std::vector<int> found;
  for (const int repetition : model::frame_repetitions(plan.cluster.flexray))
    if (rate && cycle * repetition >= rate->shortest && cycle * repetition <= rate->longest)
      found.push_back(repetition);
  return found;
}

std::vector<int> payloads(const Plan& plan) {
  if (!plan.payload) return {0};
  std::vector<int> found;
  for (int bytes = plan.payload->shortest; bytes <= plan.payload->longest; bytes += plan.payload->step)
    found.push_back(bytes);
  return found;
}

}  // namespace

std::vector<Candidate> candidates(const Plan& plan) {
  std::vector<Candidate> found;
  for (Duration cycle = plan.cycle.shortest; cycle <= plan.cycle.longest; cycle += plan.cycle.step) {
    std::vector<Candidate> of_length;
    for (const int payload : payloads(plan)) of_length.push_back({cycle, {}, payload});
    for (std::size_t s = 0; s < plan.sensors.size(); ++s) {
      std::vector<Candidate> longer;
      for (const Candidate& one : of_length)
        for (const int repetition : repetitions(plan, s, cycle)) {
          longer.push_back(one);
          longer.back().repetitions.push_back(repetition);
          if (longer.size() > kMostCandidates) break;
        }
      of_length = std::move(longer);
    }
    found.insert(found.end(), of_length.begin(), of_length.end());
    if (found.size() > kMostCandidates) break;
  }
  return found;
}

std::optional<Timed> timed(const Plan& plan, const Candidate& candidate) {
  Timed made{plan.cluster, plan.lists};
  if (candidate.payload > 0 && !set_payload(plan, candidate.payload, made)) return std::nullopt;
  if (!set_parameters(plan, candidate.cycle, made.cluster)) return std::nullopt;
  set_controllers(plan, made.cluster);
  for (std::size_t s = 0; s < plan.sensors.size(); ++s) {
    model::Sensor& sensor = made.cluster.sensors[s];
    if (!sensor.scheduled) continue;
    sensor.at.repetition = candidate.repetitions[s];
    sensor.period = made.cluster.cycle() * sensor.at.repetition;
  }
  Periods periods(plan, made);
  periods.set();
  set_shortest_periods(plan, made.cluster, periods);
  if (!fixed_instants_fit(plan, made)) return std::nullopt;
  return made;
}

}  // namespace ttf::schedules::synthesis::instants
