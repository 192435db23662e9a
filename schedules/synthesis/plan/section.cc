#include "schedules/synthesis/plan/section.h"

#include <fmt/format.h>

#include <algorithm>

#include "schedules/file/likeness/layouts.h"
#include "schedules/file/likeness/sensor_copy.h"
#include "schedules/model/limits.h"
#include "schedules/synthesis/plan/demands.h"
#include "schedules/synthesis/plan/ways.h"

namespace ttf::schedules::synthesis::plan {
namespace {

namespace likeness = file::likeness;

constexpr Range<Duration> kCycles{Duration::microseconds(10), Duration::milliseconds(16)};
constexpr Range<Duration> kPeriods{Duration::milliseconds(1), Duration::milliseconds(1'024)};  // 64 cycles of 16 ms
constexpr Duration kLongestAge = Duration::milliseconds(10'000);
constexpr std::int64_t kMostLengths = 10'000;

// Adds a sensor that is like an earlier one. Its instant is left out.
void add_alike(const std::string& name, YamlMap& map, Plan& plan) {
  model::Cluster& cluster = plan.cluster;
  likeness::SensorCopy copy;
  copy.name = name;
  copy.line = map.line("like");
  if (map.refuse_misspelt("like")) return;
  std::string like = map.value_text("like");
  const auto kind = map.choice_if("kind", likeness::known_kinds());
  likeness::read_differences(map, copy);
  map.finish();
  if (name.empty() || cluster.find_sensor(name)) return map.fail("", "is the name of an earlier sensor");
  const auto from = cluster.find_sensor(like);
  if (!from) {
    if (map.has("like"))
      map.fail("like", "must be an earlier sensor: " + likeness::originals(cluster, name), std::move(like));
    else
      (void)map.text("like");  // is missing
    return;
  }
  model::Sensor made = cluster.sensor(*from);
  copy.from = *from;
  copy.kind = made.kind = kind.value_or(made.kind);
  const likeness::Unfinished schedule{cluster, plan.tasks, plan.lists, plan.shortest_periods};
  if (const auto refused = refusal(schedule, copy)) return map.fail(refused->key, refused->expected);
  for (const NodeId node : {made.device, made.host})
    plan.parameters.controllers.push_back(plan.parameters.controllers[index_of(node)]);
  for (std::size_t p = 0; p < cluster.pdus.size(); ++p)
    if (cluster.pdus[p].sensor == *from)
      plan.free_layouts.push_back(plan.free_layouts[p] && copy.kind == cluster.sensor(*from).kind);
  PlannedSensor planned = plan.sensors[index_of(*from)];
  planned.at.instant = true;
  planned.like = from;
  plan.sensors.push_back(planned);
  made.name = name;
  made.line = copy.line;
  cluster.sensors.push_back(std::move(made));
  copy_nodes(schedule, copy, static_cast<SensorId>(cluster.sensors.size() - 1));
}

// A copy without a rate of its own has that of its original.
void share_rates(Plan& plan) {
  for (PlannedSensor& sensor : plan.sensors)
    if (sensor.like && sensor.at.repetition && !sensor.rate) sensor.rate = plan.sensors[index_of(*sensor.like)].rate;
}

void read_rates(YamlMap& section, Plan& plan) {
  if (!section.has("rates")) return;
  auto rates = section.named_maps("rates");
  YamlMap places = section.map("rates");
  for (auto& [name, map] : rates) {
    Rate rate;
    rate.line = map.line();
    rate.shortest = map.duration("shortest", kPeriods);
    rate.longest = map.duration("longest", {rate.shortest, kPeriods.high});
    map.finish();
    const auto sensor = plan.cluster.find_sensor(name);
    if (!sensor)
      places.fail(name, "is not the name of a sensor in this file");
    else if (!plan.sensors[index_of(*sensor)].at.repetition)
      places.fail(name, fmt::format("must be left out: sensors.{} has its repetition, or is not scheduled", name));
    else
      plan.sensors[index_of(*sensor)].rate = rate;
  }
}

void check_rates(YamlMap& section, const Plan& plan) {
  for (std::size_t s = 0; s < plan.sensors.size(); ++s)
    if (plan.sensors[s].at.repetition && !plan.sensors[s].rate)
      section.fail("rates",
                   fmt::format("must say how often {0} measures ({0}: {{shortest: 30 ms, longest: 40 ms}}), or "
                               "sensors.{0} must have its repetition",
                               plan.cluster.sensors[s].name));
}

// Returns the task that the text names: NODE.TASK.
std::optional<TaskId> task_named(const model::Cluster& cluster, const std::string& text) {
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    for (std::size_t t = 0; t < cluster.nodes[n].tasks.size(); ++t)
      if (text == fmt::format("{}.{}", cluster.nodes[n].name, cluster.nodes[n].tasks[t].name))
        return TaskId{static_cast<NodeId>(n), t};
  return std::nullopt;
}

void read_chain(const std::string& name, YamlMap& map, Plan& plan) {
  PlannedChain chain;
  chain.name = name;
  chain.line = map.line();
  const std::string from = map.text("from"), to = map.text("to");
  if (map.has("largest_age")) chain.largest_age = map.duration("largest_age", {Duration::microseconds(1), kLongestAge});
  map.finish();
  const auto sensor = plan.cluster.find_sensor(from);
  const auto task = task_named(plan.cluster, to);
  if (!sensor && map.has("from")) map.fail("from", "is not the name of a sensor in this file");
  if (!task && map.has("to")) map.fail("to", "must be NODE.TASK, a task of this file");
  if (!sensor || !task) return;
  if (!plan.cluster.sensor(*sensor).scheduled)
    return map.fail("from", "must be a sensor with measurement: scheduled: other ages depend on a phase by chance");
  if (!by_time(task_at(plan.cluster, *task)))
    return map.fail("to", "must be a task that time activates: a plan chooses no other instants");
  if (way_to(plan.cluster, *sensor, *task).empty())
    return map.fail("to", fmt::format("must take the data of {}: no list leads there", from));
  chain.from = *sensor;
  chain.node = task->node;
  chain.task = task->task;
  plan.chains.push_back(std::move(chain));
}

void read_chains(YamlMap& section, Plan& plan) {
  std::vector<bool> chained(plan.sensors.size());
  if (section.has("chains"))
    for (auto& [name, map] : section.named_maps("chains")) read_chain(name, map, plan);
  for (const PlannedChain& chain : plan.chains) chained[index_of(chain.from)] = true;
  // Sensors without a chain have one to their use.
  for (std::size_t s = 0; s < plan.sensors.size(); ++s) {
    if (chained[s] || !plan.cluster.sensors[s].scheduled) continue;
    const auto way = way_to_use(plan.cluster, static_cast<SensorId>(s));
    if (way.empty()) continue;
    plan.chains.push_back({plan.cluster.sensors[s].name, static_cast<SensorId>(s), way.back().at.node,
                           way.back().at.task, std::nullopt, plan.cluster.sensors[s].line});
  }
  if (plan.chains.empty() && !section.has("chains"))
    section.fail("chains", "must have an entry: no scheduled sensor's data comes to a task that time activates");
}

void read_objective(YamlMap& section, Plan& plan) {
  if (!section.has("objective")) {
    plan.objective = {Goal::kWorstAge};
    return;
  }
  for (const std::string& word : section.words("objective", {kGoalWords.begin(), kGoalWords.end()})) {
    const auto goal = static_cast<Goal>(std::find(kGoalWords.begin(), kGoalWords.end(), word) - kGoalWords.begin());
    if (std::find(plan.objective.begin(), plan.objective.end(), goal) != plan.objective.end())
      section.fail("objective", fmt::format("must name {} once", word));
    else
      plan.objective.push_back(goal);
  }
}

bool leaves_out_channels(const Plan& plan, const PlannedList& list) {
  const std::string key = fmt::format("frames[{}].channels", list.entry.value_or(0));
  return std::any_of(plan.cluster.derived.begin(), plan.cluster.derived.end(),
                     [&](const model::DerivedValue& one) { return one.path == key; });
}

void read_one_channel(YamlMap& section, Plan& plan) {
  if (!section.has("one_channel")) return;
  for (const std::string& name : section.texts("one_channel")) {
    const auto pdu = plan.cluster.find_pdu(name);
    const std::size_t before = plan.one_channel.size();
    for (std::size_t l = 0; pdu && l < plan.lists.size(); ++l) {
      if (plan.lists[l].pdu != *pdu || !plan.lists[l].at.instant) continue;
      if (!leaves_out_channels(plan, plan.lists[l]))
        section.fail("one_channel", fmt::format("must name lists whose channels are left out; {} (line {}) says them",
                                                name, plan.lists[l].line));
      if (channels_to_readers(plan.cluster, plan.lists[l].sender, *pdu).empty())
        section.fail("one_channel",
                     fmt::format("must name lists whose sender and readers share a channel; those of {} do not", name));
      plan.one_channel.push_back(l);
    }
    if (plan.one_channel.size() == before)
      section.fail("one_channel", fmt::format("must name lists whose slots are left out; {} is none", name));
  }
  std::vector<std::size_t> once = plan.one_channel;
  std::sort(once.begin(), once.end());
  if (std::adjacent_find(once.begin(), once.end()) != once.end())
    section.fail("one_channel", "must name each list once");
}

}  // namespace

std::optional<CycleLengths> read_cycle(YamlMap& section) {
  auto map = section.map_if("cycle");
  if (!map) return std::nullopt;
  CycleLengths lengths;
  lengths.line = map->line();
  lengths.shortest = map->duration("shortest", kCycles);
  lengths.longest = map->duration("longest", {lengths.shortest, kCycles.high});
  lengths.step = map->duration("step", {Duration::microseconds(1), kCycles.high});
  if ((lengths.longest - lengths.shortest).ns / lengths.step.ns >= kMostLengths)
    map->fail("step", fmt::format("must make at most {} lengths of the cycle", kMostLengths));
  map->finish();
  return lengths;
}

std::optional<PayloadLengths> read_payload(YamlMap& section) {
  auto map = section.map_if("payload");
  if (!map) return std::nullopt;
  PayloadLengths lengths;
  lengths.line = map->line();
  const auto even = [&](const char* key, std::int64_t bytes) {
    if (bytes % 2 != 0) map->fail(key, "must be even: a payload is of words of two bytes");
    return static_cast<int>(bytes);
  };
  lengths.shortest = even("shortest", map->integer("shortest", {2, model::kMostFragmentBytes}, "bytes"));
  lengths.longest = even("longest", map->integer("longest", {lengths.shortest, model::kMostFragmentBytes}, "bytes"));
  lengths.step = even("step", map->integer_or("step", 2, {2, model::kMostFragmentBytes}, "bytes"));
  map->finish();
  return lengths;
}

void read_section(YamlMap& section, Plan& plan) {
  if (section.has("sensors"))
    for (auto& [name, map] : section.named_maps("sensors")) add_alike(name, map, plan);
  read_rates(section, plan);
  share_rates(plan);
  check_rates(section, plan);
  read_chains(section, plan);
  read_objective(section, plan);
  read_demands(section, plan);
  read_one_channel(section, plan);
  plan.slot_multiplexing = section.boolean_or("slot_multiplexing", true);
  plan.in_order = section.boolean_or("in_order", true);
  section.finish();
}

}  // namespace ttf::schedules::synthesis::plan
