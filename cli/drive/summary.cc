#include "cli/drive/summary.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/drive/fault_tables.h"
#include "cli/drive/recording_outputs.h"
#include "evaluation/measures/figures.h"
#include "keys/summary/summary.h"
#include "recording/osi/truth_trace.h"
#include "recording/records/enumerations.h"

namespace ttf::cli::drive {
namespace {

using evaluation::faults::CheckSeen;
using evaluation::faults::FaultEffects;
using evaluation::faults::HarmSeen;
using recording::records::BinnedDurations;
using ttf::keys::summary::Absent;
using ttf::keys::summary::Json;
using ttf::keys::summary::Rows;

constexpr Absent kIfNull = Absent::kIfNull, kIfEmpty = Absent::kIfEmpty;

// Returns `entry` of every item.
template <class Items, class Entry> auto each(const Items& items, Entry entry) {
  std::vector<decltype(entry(*items.begin()))> all;
  for (const auto& item : items) all.push_back(entry(item));
  return all;
}

struct Drive {
  const sim::drives::Scenario& scenario;
  const StrategyResult& result;

  // Returns no value if the scenario has no faults.
  template <class Value> std::optional<Value> if_planned(Value value) const {
    return scenario.faults.empty() ? std::nullopt : std::optional(std::move(value));
  }
};

// A finding, with the drive that names its nodes.
template <class Finding> struct In {
  const StrategyResult* drive;
  const Finding* finding;

  const Finding* operator->() const { return finding; }
  std::string name(NodeId node) const { return node_name(node, drive->cluster); }
  std::optional<std::string> name_if_any(NodeId node) const {
    return node == kNoNode ? std::nullopt : std::optional(name(node));
  }
};
template <class Findings> auto all_in(const StrategyResult& drive, const Findings& findings) {
  return each(findings, [&](auto& one) { return In<std::remove_cvref_t<decltype(one)>>{&drive, &one}; });
}
auto names(const StrategyResult& drive, const std::vector<NodeId>& nodes) {
  return each(nodes, [&](NodeId node) { return node_name(node, drive.cluster); });
}

double in_s(TrueTime at) { return (at - TrueTime{}).seconds(); }
constexpr auto kInMs = [](auto time) { return in_ms(time); };
template <class Time, class Unit> std::optional<double> if_any(const std::optional<Time>& time, Unit in) {
  return time ? std::optional<double>(in(*time)) : std::nullopt;
}

// Ages and loads.
auto ages_by_sensor(const StrategyResult& drive) {
  return each(drive.summary.age_used_by_sensor,
              [&](auto& age) { return std::pair(drive.cluster.sensor(age.first).name, age.second); });
}
auto stages_by_sensor(const StrategyResult& drive) {
  return each(drive.stages, [&](auto& stages) { return std::pair(drive.cluster.sensor(stages.sensor).name, &stages); });
}
const auto* statistics(const evaluation::ages::DurationStatistics& had) { return had.count == 0 ? nullptr : &had; }
std::array<std::optional<double>, 2> bounds(std::optional<Duration> best, std::optional<Duration> worst) {
  return {if_any(best, kInMs), if_any(worst, kInMs)};
}
auto can_loads(const StrategyResult& drive) {
  std::vector<std::pair<std::string, double>> all;
  for (std::size_t b = 0; b < drive.outcome.can_load.size(); ++b)
    all.emplace_back(drive.cluster.can_buses[b].name, drive.outcome.can_load[b]);
  return all;
}

// Real time.
struct Spread {
  std::uint64_t count = 0;
  std::optional<double> p50, p99, p999, longest;
};
template <class Unit> Spread spread(const BinnedDurations& all, const Unit& in) {
  if (all.empty()) return {};
  return {all.count(), in(all.quantile(500)), in(all.quantile(990)), in(all.quantile(999)), in(all.longest())};
}
// Converts durations of the drive's time to real time.
Spread real(const StrategyResult& drive, const BinnedDurations& all, double unit_us) {
  return spread(all, [&](Duration d) {
    return in_us(evaluation::lateness::in_real_time(d, drive.real_time->time_scale_ppm)) / unit_us;
  });
}
std::optional<Spread> reading_jitter_us(const Drive& drive) {
  if (!drive.result.driving) return std::nullopt;
  return real(drive.result, drive.result.driving->reading_jitter, 1.0);
}
// Returns null for a node without such a finding.
template <class Finding> const Finding* of_node(const std::map<NodeId, Finding>& findings, NodeId node) {
  const auto found = findings.find(node);
  return found == findings.end() ? nullptr : &found->second;
}
auto lateness_of(const StrategyResult& drive, NodeId node) {
  const auto* const late = of_node(drive.real_time->lateness, node);
  return late == nullptr ? recording::exports::NodeLateness{} : *late;
}

// Faults.
struct FailedCheck {
  evaluation::faults::Check check;
  bool by_faulty;
  In<CheckSeen> seen;
};
std::vector<FailedCheck> failed_checks(const In<FaultEffects>& effects) {
  std::vector<FailedCheck> all;
  for (const auto check : evaluation::faults::kAllChecks)
    for (const bool faulty : {false, true}) {
      const CheckSeen& seen = (faulty ? effects->by_faulty : effects->by_others)[static_cast<std::size_t>(check)];
      if (seen.cycles > 0) all.push_back({check, faulty, {effects.drive, &seen}});
    }
  return all;
}
std::optional<std::vector<std::string>> seeing_guardians(const FailedCheck& failed) {
  if (failed.check != evaluation::faults::Check::kGuardian) return std::nullopt;
  std::vector<std::string> channels;
  for (const auto channel : schedules::model::kBothChannels)
    if (failed.seen->guardians[index_of(channel)]) channels.emplace_back(1, letter(channel));
  return channels;
}
struct HarmDone {
  evaluation::faults::Harm harm;
  In<HarmSeen> seen;
};
std::vector<HarmDone> harms_done(const In<FaultEffects>& effects) {
  std::vector<HarmDone> all;
  for (const auto harm : evaluation::faults::kAllHarms)
    for (const HarmSeen& seen : effects->harms[static_cast<std::size_t>(harm)])
      all.push_back({harm, {effects.drive, &seen}});
  return all;
}
auto can_errors(const evaluation::faults::CanSeen& seen) {
  std::vector<std::pair<std::string, std::uint64_t>> all;
  for (std::size_t e = 1; e < seen.errors.size(); ++e)
    all.emplace_back(to_text(static_cast<recording::records::CanError>(e)), seen.errors[e]);
  return all;
}

struct Whole {
  const sim::drives::Scenario& scenario;
  std::uint64_t seed;
  const std::vector<StrategyResult>& results;
};
auto drives_of(const Whole& whole) {
  return each(whole.results, [&](const StrategyResult& result) { return Drive{whole.scenario, result}; });
}

Json measured_json(const Drive& drive) {
  Json json;
  add_to(json, evaluation::measures::measures(), figures_of(drive.result));
  return json;
}

// clang-format off
const Rows<Spread> kSpread{
  {"count", [](auto& s) { return s.count; }, "samples"},
  {"p50", [](auto& s) { return s.p50; }, "median"},
  {"p99", [](auto& s) { return s.p99; }, "99th percentile"},
  {"longest", [](auto& s) { return s.longest; }, "longest"},
};
const Rows<Spread> kLateness{
  {"count", [](auto& s) { return s.count; }, "samples"},
  {"p50", [](auto& s) { return s.p50; }, "median [us]"},
  {"p99", [](auto& s) { return s.p99; }, "99th percentile [us]"},
  {"p999", [](auto& s) { return s.p999; }, "99.9th percentile [us]"},
  {"longest", [](auto& s) { return s.longest; }, "longest [us]"},
};
const Rows<evaluation::ages::DurationStatistics> kStatistics{
  {"least_ms", [](auto& had) { return in_ms(had.least); }, "least [ms]"},
  {"mean_ms", [](auto& had) { return in_ms(had.mean()); }, "mean [ms]"},
  {"p99_ms", [](auto& had) { return in_ms(had.p99()); }, "99th percentile [ms]"},
  {"most_ms", [](auto& had) { return in_ms(had.most); }, "most [ms]"},
};
const Rows<In<FaultEffects>> kEffects{
  {"checks", &failed_checks, "checks that failed", {
    {"check", [](auto& c) { return name_of(c.check); }, "name of the check"},
    {"by_faulty_node", [](auto& c) { return c.by_faulty; }, "a faulty node saw it"},
    {"cycles", [](auto& c) { return c.seen->cycles; }, "cycles in which it failed"},
    {"first_s", [](auto& c) { return in_s(c.seen->first); }, "first time [s]"},
    {"nodes", [](auto& c) { return names(*c.seen.drive, c.seen->nodes); }, "nodes that saw it", "name of a node"},
    {"guardians", &seeing_guardians, "channels whose guardian saw it", "A or B", kIfNull},
  }},
  {"guardians", [](auto& e) { return all_in(*e.drive, e->guardians); }, "interventions of guardians", {
    {"what", [](auto& g) { return g->cut ? "cut" : "blocked"; }, "cut or blocked"},
    {"why", [](auto& g) { return g->why; }, "cause"},
    {"signals", [](auto& g) { return g->signals; }, "signals that were kept off"},
    {"first_cycle", [](auto& g) { return g->first_cycle; }, "first cycle"},
    {"first_s", [](auto& g) { return in_s(g->first); }, "first time [s]"},
  }},
  {"states", [](auto& e) { return all_in(*e.drive, e->states); }, "changes of state", {
    {"node", [](auto& s) { return s.name(s->node); }, "name of the node"},
    {"from", [](auto& s) { return s->from; }, "state before"},
    {"to", [](auto& s) { return s->to; }, "state after"},
    {"why", [](auto& s) { return s->why; }, "cause"},
    {"first_s", [](auto& s) { return in_s(s->first); }, "first time [s]"},
    {"times", [](auto& s) { return s->times; }, "how often"},
  }},
  {"harmed", [](auto& e) { return e->harmed(); }, "a fault-free node was harmed"},
  {"harms", &harms_done, "harms to fault-free nodes", {
    {"harm", [](auto& h) { return name_of(h.harm); }, "its kind"},
    {"first_s", [](auto& h) { return in_s(h.seen->first); }, "first time [s]"},
    {"node", [](auto& h) { return h.seen.name_if_any(h.seen->node); }, "harmed node"},
    {"sender", [](auto& h) { return h.seen.name_if_any(h.seen->sender); }, "sender of the frame"},
    {"slot", [](auto& h) { return h.seen->slot; }, "slot of the frame; 0: none"},
    {"times", [](auto& h) { return h.seen->times; }, "how often"},
  }},
};

const Rows<Drive> kDrive{
  {"strategy", [](auto& d) { return name_of(d.result.strategy); }, "buff, adva or tt"},
  {"cluster", [](auto& d) { return d.result.cluster.name; }, "name of the cluster"},
  {&measured_json, ttf::keys::summary::measured()},
  {"age_when_used_by_sensor", [](auto& d) { return ages_by_sensor(d.result); }, "age when used, by sensor", {
    {"count", [](auto& age) { return age.count; }, "uses of an image with a measurement of the sensor"},
    {"mean_ms", [](auto& age) { return age.count == 0 ? std::nullopt : std::optional(in_ms(age.mean())); }, "mean age [ms]"},
    {"worst_ms", [](auto& age) { return age.count == 0 ? std::nullopt : std::optional(in_ms(age.worst)); }, "largest age [ms]"},
  }, kIfEmpty},
  {"age_by_stage", [](auto& d) { return stages_by_sensor(d.result); }, "latency by stage, by sensor, beside the schedule's bounds", {
    {"measured", [](auto& sensor) { return sensor.measured; }, "measurements of the sensor"},
    {"seen", [](auto& sensor) { return sensor.seen(); }, "measurements that went through all stages"},
    {"to", [](auto& sensor) { return sensor.to_use ? "use" : "fusion"; }, "last stage: use or fusion"},
    {"stages", [](auto& sensor) -> const auto& { return sensor.stages; }, "stages, in their order", {
      {"stage", [](auto& s) { return s.name; }, "name of the stage"},
      {"bounds_ms", [](auto& s) { return bounds(s.best, s.worst); }, "bounds of its length, best and worst [ms]", "a bound [ms]"},
      {"had", [](auto& s) { return statistics(s.had); }, "its length", kStatistics},
      {"age_bounds_ms", [](auto& s) { return bounds(s.age_best, s.age_worst); }, "bounds of the age at its end [ms]", "a bound [ms]"},
      {"age", [](auto& s) { return statistics(s.age); }, "age at its end", kStatistics},
      {"beyond", [](auto& s) { return s.beyond; }, "lengths or ages beyond their bounds"},
    }, kIfEmpty},
  }, kIfEmpty},
  {"startup", [](auto& d) { return all_in(d.result, d.result.startup); }, "nodes that started up or changed their state", {
    {"node", [](auto& s) { return s.name(s->node); }, "name of the node"},
    {"powered_on_ms", [](auto& s) { return if_any(s->powered, kInMs); }, "time of its supply [ms]"},
    {"active", [](auto& s) { return s->active; }, "first cycle in which it was active", {
      {"cycle", [](auto& active) { return active.cycle; }, "number of the cycle"},
      {"at_ms", [](auto& active) { return in_ms(active.at); }, "its time [ms]"},
      {"from", [](auto& active) { return active.from; }, "state before"},
      {"why", [](auto& active) { return active.why; }, "cause of the change"},
    }},
    {"state", [](auto& s) { return s->state; }, "state at the end; empty: not on FlexRay"},
    {"why", [](auto& s) { return s->why; }, "cause of this state"},
  }, kIfEmpty},
  {"can_load", [](auto& d) { return can_loads(d.result); }, "share of the time in which a private CAN carries bits, by its name",
   "load of the CAN", kIfEmpty},
  {"content_hash", [](auto& d) { return d.result.content_hash; }, "hash of the log's records; empty without a log"},
  {"log", [](auto& d) { return d.result.log_path; }, "path of the log; empty without one"},
  {"recording", [](auto& d) { return d.result.recording ? &d : nullptr; }, "recording that the drive played", {
    {"ends_after_s", [](auto& d) { return d.result.recording->ends_after.seconds(); }, "time of its last row [s]"},
    {"ends_early", [](auto& d) { return d.result.recording->ends_early(); }, "it ends before the drive"},
    {"made_track", [](auto& d) { return d.result.made_track; }, "a track came of it"},
    {"reasons", [](auto& d) { return recording_reasons(d.result, d.scenario.tracker); }, "reasons why the drive did not do its work", "a sentence"},
    {"sensors", [](auto& d) -> const auto& { return d.result.recording->sensors; }, "its sensors", {
      {"name", [](auto& of) { return of.sensor; }, "name of the sensor"},
      {"rows", [](auto& of) { return of.rows.rows; }, "rows of the sensor"},
      {"lists", [](auto& of) { return of.rows.lists; }, "lists of these rows"},
      {"unused_between_instants", [](auto& of) { return of.rows.between; }, "rows between two measurements of the schedule"},
      {"unused_beyond_the_end", [](auto& of) { return of.rows.beyond; }, "rows after the drive's end"},
      {"measurements_without_row", [](auto& of) { return of.rows.silent; }, "measurements of the schedule without a row"},
    }, kIfEmpty},
  }, kIfNull},
  {"real_time", [](auto& d) { return d.result.real_time ? &d : nullptr; }, "lateness and loss of a drive in real time", {
    {"time_scale", [](auto& d) { return static_cast<double>(d.result.real_time->time_scale_ppm) * 1e-6; }, "time of the drive over real time"},
    {"nodes", [](auto& d) { return all_in(d.result, d.result.real_time->timing); }, "nodes", {
      {"node", [](auto& n) { return n.name(n->first); }, "name of the node"},
      {"lateness_us", [](auto& n) { return lateness_of(*n.drive, n->first); }, "lateness, in real time", {
        {"wake_ups", [](auto& late) { return spread(late.wake_ups, in_us); }, "of wake-ups", kLateness},
        {"floor", [](auto& late) { return spread(late.floor, in_us); }, "of the kernel's timer alone", kLateness},
        {"departures", [](auto& late) { return spread(late.departures, in_us); }, "of frames that left", kLateness},
        {"arrivals", [](auto& late) { return spread(late.arrivals, in_us); }, "of frames that came", kLateness},
        {"transits", [](auto& late) { return spread(late.transits, in_us); }, "time of frames on their way", kLateness},
      }},
      {"late_wake_ups", [](auto& n) { return n->second.late_wake_ups; }, "late wake-ups"},
      {"slots_missed", [](auto& n) { return n->second.slots_missed; }, "frames that the node withheld, because they were late"},
      {"late_frames", [](auto& n) { return n->second.late_frames; }, "frames of other nodes that came late"},
      {"early_frames", [](auto& n) { return n->second.early_frames; }, "frames of other nodes that came early"},
      {"frames_lost", [](auto& n) { return n->second.frames_lost; }, "frames of other nodes that did not come: the next three together"},
      {"withheld_by_the_sender", [](auto& n) { return n->second.missing.withheld; }, "frames that the sender withheld"},
      {"sender_away", [](auto& n) { return n->second.missing.away; }, "frames of a sender that was not there"},
      {"lost_on_the_way", [](auto& n) { return n->second.lost_on_the_way(); }, "frames that were sent"},
      {"medium", [](auto& n) { return of_node(n.drive->real_time->medium, n->first); }, "counts of the node's medium", {
        {"sent", [](auto& counts) { return counts.sent; }, "frames sent"},
        {"received", [](auto& counts) { return counts.received; }, "frames received"},
        {"not_sent", [](auto& counts) { return counts.not_sent; }, "frames without room to send"},
        {"lost", [](auto& counts) { return counts.lost; }, "frames that the medium lost"},
        {"foreign", [](auto& counts) { return counts.foreign; }, "frames of others"},
        {"malformed", [](auto& counts) { return counts.malformed; }, "frames that are none"},
        {"dropped", [](auto& counts) { return counts.dropped; }, "frames that were dropped before they were read"},
      }},
      {"largest_offset_correction_us", [](auto& n) { return if_any(n->second.largest_offset_correction, in_us); },
       "largest correction of the clock [us]"},
    }},
    {"precision_us", [](auto& d) { return all_in(d.result, d.result.real_time->precision); }, "distance of the clocks of a host", {
      {"host", [](auto& p) { return p->host; }, "name of the host"},
      {"", [](auto& p) { return real(*p.drive, p->apart, 1.0); }, "distance [us]", kSpread},
    }},
    {"sensor_to_feature_ms", [](auto& d) { return d; }, "age of measurements when an image is used, in real time", {
      {"newest", [](auto& d) { return real(d.result, d.result.summary.age_used_newest, 1e3); }, "of the newest one [ms]", kSpread},
      {"oldest", [](auto& d) { return real(d.result, d.result.summary.age_used_oldest, 1e3); }, "of the sensors' oldest one [ms]", kSpread},
    }},
    {"reading_jitter_us", &reading_jitter_us, "jitter of the readings of commands [us]", kSpread, kIfNull},
  }, kIfNull},
  {"faults", [](auto& d) { return d.if_planned(all_in(d.result, d.result.faults.faults)); }, "faults of the scenario that began", {
    {"fault", [](auto& f) { return f->fault; }, "its number in the scenario"},
    {"kind", [](auto& f) { return f->kind; }, "its kind"},
    {"node", [](auto& f) { return f.name_if_any(f->node); }, "its node"},
    {"begins_s", [](auto& f) { return if_any(f->begins, in_s); }, "its beginning [s]"},
    {"ends_s", [](auto& f) { return if_any(f->ends, in_s); }, "its end [s]"},
    {"acts", [](auto& f) { return f->acts; }, "how often it acted"},
    {"first_act_s", [](auto& f) { return if_any(f->first_act, in_s); }, "time of the first act [s]"},
    {"first_act", [](auto& f) { return f->text; }, "the first act, in words"},
    {"", [](auto& f) { return In<FaultEffects>{f.drive, f.finding}; }, "its effects", kEffects},
  }, kIfNull},
  {"fault_free_nodes", [](auto& d) { return d.if_planned(names(d.result, d.result.fault_free)); },
   "nodes on FlexRay without a fault until the end", "name of a node", kIfNull},
  {"unattributed", [](auto& d) { return d.if_planned(In<FaultEffects>{&d.result, &d.result.faults.unattributed}); },
   "effects without a cause among the faults", kEffects, kIfNull},
  {"cans", [](auto& d) { return d.if_planned(all_in(d.result, d.result.faults.cans)); }, "nodes with errors on a private CAN", {
    {"can", [](auto& c) { return can_name(c->bus, c.drive->cluster); }, "name of the CAN"},
    {"node", [](auto& c) { return c.name(c->node); }, "name of the node"},
    {"first_s", [](auto& c) { return in_s(c->first); }, "first error [s]"},
    {"error_passive", [](auto& c) { return c->passive; }, "times that the node became error passive"},
    {"bus_off", [](auto& c) { return c->bus_off; }, "times that it left the bus"},
    {"error_frames", [](auto& c) { return can_errors(*c.finding); }, "error frames that it began, by the error", "their number"},
  }, kIfEmpty},
};

const Rows<Whole> kWhole{
  {"scenario", [](auto& whole) { return whole.scenario.name; }, "name of the scenario"},
  {"seed", [](auto& whole) { return whole.seed; }, "seed of every random stream"},
  {"duration_s", [](auto& whole) { return whole.scenario.duration.seconds(); }, "length of the drive [s]"},
  {"truth", [](auto& whole) { return whole.scenario.truth; }, "trace in place of the scenario's objects", {
    {"file", [](auto& truth) { return truth.name; }, "its name"},
    {"length_s", [](auto& truth) { return truth.length().seconds(); }, "its length [s]"},
    {"objects", [](auto& truth) -> const auto& { return truth.objects; }, "its objects, in the order of our ids", {
      {"id", [](auto& object) { return object.id; }, "id in the trace"},
      {"kind", [](auto& object) { return name_of(object.kind); }, "class of the object"},
    }, kIfEmpty},
  }, kIfNull},
  {"strategies", &drives_of, "drives, one for each strategy", kDrive},
};

const Rows<LaunchFindings> kLaunch{
  {"not_in_operation_at_end", [](auto& l) { return l.absent; }, "of a launch: nodes that were not in operation at its end", {
    {"node", [](auto& node) { return node.name; }, "name of the node"},
    {"state", [](auto& node) { return node.state; }, "its state"},
  }, kIfNull},
  {"external_nodes", [](auto& l) { return l.external; }, "of a launch: nodes in place of its own", {
    {"node", [](auto& e) { return e.node; }, "name of the node"},
    {"in_window", [](auto& e) { return e.in_window; }, "frames in their window"},
    {"early", [](auto& e) { return e.early; }, "frames before it"},
    {"late", [](auto& e) { return e.late; }, "frames after it"},
    {"malformed", [](auto& e) { return e.malformed; }, "malformed frames, by their kind", "their number"},
    {"missing", [](auto& e) { return e.missing; }, "frames that did not come"},
    {"never_heard", [](auto& e) { return e.never_received; }, "lists and lines of which no frame came", "a list or a line"},
    {"first_after_s", [](auto& e) { return e.first_after_s; }, "time of the first frame [s]"},
    {"state", [](auto& e) { return e.state; }, "state, in words"},
  }, kIfEmpty},
  {"verdict", [](auto& l) { return l.verdict; }, "of a launch: whether lateness and loss matter", {
    {"matters", [](auto& verdict) { return verdict.matters; }, "they matter"},
    {"sentence", [](auto& verdict) { return verdict.sentence; }, "the reason"},
  }, kIfNull},
};
// clang-format on

}  // namespace

Json to_json(const sim::drives::Scenario& scenario, std::uint64_t seed, const std::vector<StrategyResult>& results) {
  return json_of(kWhole, Whole{scenario, seed, results});
}

Json to_json(const LaunchFindings& launch) { return json_of(kLaunch, launch); }

std::vector<ttf::keys::summary::Member> summary_members() {
  std::vector<ttf::keys::summary::Member> all = described(kWhole), of_launch = described(kLaunch);
  all.insert(all.end(), of_launch.begin(), of_launch.end());
  return all;
}

}  // namespace ttf::cli::drive
