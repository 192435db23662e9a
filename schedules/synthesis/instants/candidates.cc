#include "schedules/synthesis/instants/candidates.h"

#include <algorithm>

#include "schedules/analysis/clock_bounds.h"
#include "schedules/analysis/parameter_bounds.h"
#include "schedules/left_out/periods.h"
#include "schedules/model/limits.h"
#include "schedules/model/repetitions.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::instants {

using plan::by_time;
using plan::LeftOutParameters;
using plan::Plan;
using plan::PlannedList;
namespace {

constexpr int kCorrectionRoom = 100;  // macroticks behind gOffsetCorrectionStart

// A list of the layout is distinguished by its header, and is no longer than records can number.
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

// Whether the channels may change places: nothing else is on one of them alone.
bool channels_are_alike(const Plan& plan) {
  const auto on_both = [](const auto& sent) { return sent.channels == model::Channels::kAB; };
  return std::all_of(plan.cluster.frames.begin(), plan.cluster.frames.end(), on_both) &&
         std::all_of(plan.lists.begin(), plan.lists.end(), on_both);
}

// Returns all choices of channels; of two that are alike the one whose first list is on A.
std::vector<std::vector<model::Channels>> channel_choices(const Plan& plan) {
  std::vector<std::vector<model::Channels>> found{{}};
  bool alike = channels_are_alike(plan);
  for (const std::size_t list : plan.one_channel) {
    std::vector<std::vector<model::Channels>> longer;
    const std::vector<model::Channels> possible =
        plan::channels_to_readers(plan.cluster, plan.lists[list].sender, plan.lists[list].pdu);
    alike = alike && possible.size() == 2;
    for (const auto& choice : found)
      for (const model::Channels channel : possible) {
        longer.push_back(choice);
        longer.back().push_back(channel);
        if (longer.size() > kMostCandidates) return longer;
      }
    found = std::move(longer);
  }
  if (alike) found.resize((found.size() + 1) / 2);  // A comes first
  return found;
}

}  // namespace

std::vector<Candidate> candidates(const Plan& plan) {
  std::vector<Candidate> found;
  const std::vector<std::vector<model::Channels>> choices = channel_choices(plan);
  for (Duration cycle = plan.cycle.shortest; cycle <= plan.cycle.longest; cycle += plan.cycle.step) {
    std::vector<Candidate> of_length;
    for (const int payload : payloads(plan))
      for (const auto& choice : choices) of_length.push_back({cycle, {}, payload, choice});
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
  for (std::size_t i = 0; i < candidate.channels.size(); ++i)
    made.lists[plan.one_channel[i]].channels = candidate.channels[i];
  if (candidate.payload > 0 && !set_payload(plan, candidate.payload, made)) return std::nullopt;
  if (!set_parameters(plan, candidate.cycle, made.cluster)) return std::nullopt;
  set_controllers(plan, made.cluster);
  for (std::size_t s = 0; s < plan.sensors.size(); ++s) {
    model::Sensor& sensor = made.cluster.sensors[s];
    if (!sensor.scheduled) continue;
    sensor.at.repetition = candidate.repetitions[s];
    sensor.period = made.cluster.cycle() * sensor.at.repetition;
  }
  left_out::Periods periods(made.cluster, plan.tasks);
  periods.set(made.lists);
  left_out::set_shortest_periods(made.cluster, plan.shortest_periods, periods);
  if (!fixed_instants_fit(plan, made)) return std::nullopt;
  return made;
}

}  // namespace ttf::schedules::synthesis::instants
