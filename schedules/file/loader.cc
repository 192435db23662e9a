#include "schedules/file/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "core/file_kind.h"
#include "core/strict_yaml.h"
#include "schedules/file/completion.h"
#include "schedules/file/fill_in.h"
#include "schedules/file/inherit.h"
#include "schedules/file/likeness/inherit_alike.h"
#include "schedules/file/likeness/sensor_copy.h"
#include "schedules/file/load_frames.h"
#include "schedules/file/load_instants.h"
#include "schedules/file/load_modes.h"
#include "schedules/file/load_pdus.h"
#include "schedules/file/names.h"
#include "schedules/file/parameter_table.h"
#include "schedules/model/limits.h"
#include "schedules/model/repetitions.h"
#include "schedules/model/round.h"

namespace ttf::schedules::file {
namespace {

constexpr Duration kLongest = Duration::milliseconds(10'000);
constexpr Duration kWidestArrival = Duration::milliseconds(1'000);  // before or after an action point
constexpr Range<Duration> kExecution{Duration::microseconds(1), kLongest};

class Loader {
 public:
  Loader(const StrictYaml& file, Findings& findings)
      : root_(file.root(findings)), findings_(findings), names_(cluster_), completion_(cluster_, findings) {
    cluster_.file = file.name();
    cluster_.text = file.text();
  }

  model::Cluster load() {
    if (root_.has("extends") && !root_.text("extends").empty())
      root_.fail("extends", "must be in a file: a text alone has no folder in which the other file is");
    cluster_.name = root_.text("name");
    cluster_.synchronisation = root_.boolean("synchronisation");
    cluster_.topology = root_.choice_or("topology", model::Topology::kBus,
                                        {{"bus", model::Topology::kBus}, {"star", model::Topology::kStar}});
    cluster_.guardian = root_.boolean_or("guardian", false);
    for (const char* key : {"topology", "guardian", "real_time"}) remember(root_, key);
    if (auto window = root_.map_if("real_time")) load_arrival_window(*window);
    YamlMap globals = root_.map("flexray");
    load_globals(globals);
    YamlMap shared = root_.map("node_parameters");
    auto nodes = root_.named_maps("nodes");
    auto sensors = root_.named_maps("sensors");
    auto pdus = root_.named_maps("pdus");
    auto cans = root_.named_maps("can");
    limit("nodes", nodes.size(), model::kMostNamed);
    limit("sensors", sensors.size(), model::kMostNamed);
    limit("pdus", pdus.size(), model::kMostNamed);
    limit("can", cans.size(), model::kMostCans);
    remember(root_, "nodes");
    // Names first: any entry may refer to any other.
    for (auto& [name, map] : nodes) cluster_.nodes.emplace_back().name = name;
    for (auto& [name, map] : sensors) cluster_.sensors.emplace_back().name = name;
    for (auto& [name, map] : pdus) cluster_.pdus.emplace_back().name = name;
    for (auto& [name, map] : cans) cluster_.can_buses.emplace_back().name = name;
    const auto pdus_alike = likeness::inherit_alike(pdus, "PDU");
    for (std::size_t i = 0; i < pdus.size(); ++i) load_pdu(pdus[i].second, names_, cluster_.pdus[i]);
    likeness::note_inherited(pdus, pdus_alike, cluster_);
    const auto alike = take_likeness(sensors);
    for (std::size_t i = 0; i < sensors.size(); ++i) load_sensor(sensors[i].second, cluster_.sensors[i]);
    likeness::note_inherited(sensors, alike, cluster_);
    for (std::size_t i = 0; i < cans.size(); ++i) load_can(cans[i].second, cluster_.can_buses[i]);
    for (std::size_t i = 0; i < nodes.size(); ++i) load_node(nodes[i].second, shared, cluster_.nodes[i]);
    shared.finish();
    std::vector<YamlMap> frames = root_.maps("frames");
    load_frames(frames, names_, cluster_, left_out_.lists);
    completion_.finish();
    root_.finish();
    if (findings_.empty())
      copy_sensors(sensors);
    else
      list_copied_parts();
    return std::move(cluster_);
  }
  left_out::Parts& left_out() { return left_out_; }

  // Returns a finding about a part that is a copy: in place of all about that part, if there are others.
  Finding in_copied_part(const Finding& finding) {
    for (CopiedPart& part : copied_parts_) {
      if (!finding.key.starts_with(part.path)) continue;
      if (const std::size_t end = part.path.size(); end < finding.key.size() && finding.key[end] != '.') continue;
      if (part.line == 0) part.line = finding.line;
      return {finding.file, part.line, part.path, "", likeness::refusal_of_part(part.sensor)};
    }
    return finding;
  }

 private:
  void limit(std::string_view key, std::size_t count, std::size_t most) {
    if (count > most) root_.fail(key, fmt::format("must have at most {} entries; it has {}", most, count));
  }

  void load_globals(YamlMap& map) {
    model::GlobalParameters& global = cluster_.flexray;
    Absent absent;
    const auto read = [&](const auto& p) {
      read_parameter(map, p, global, absent);
      remember(map, p.name);
    };
    for (const auto& p : kGlobalIntegers) read(p);
    for (const auto& p : kGlobalScaled) read(p);
    if (global.gCycleCountMax % 2 == 0)
      map.fail("gCycleCountMax", "must be odd: clocks are corrected after an even and an odd cycle");
    // Repetitions depend on it: other mistakes are found with the usual number.
    if (std::any_of(findings_.list().begin(), findings_.list().end(),
                    [](const Finding& one) { return one.key == "flexray.gCycleCountMax"; }))
      global.gCycleCountMax = model::kMostCycles - 1;
    completion_.globals(map, std::move(absent));
    map.finish();
  }

  void load_arrival_window(YamlMap& map) {
    model::ArrivalWindow& window = cluster_.arrival_window.emplace();
    window.early = map.duration("early", {Duration{}, kWidestArrival});
    window.late = map.duration("late", {Duration{1}, kWidestArrival});
    remember(map, "early");
    remember(map, "late");
    map.finish();
  }

  void remember(const YamlMap& map, std::string_view key) {
    cluster_.parameter_lines[map.path().empty() ? std::string(key) : fmt::format("{}.{}", map.path(), key)] =
        map.line(key);
  }

  // Returns a node's own value, or the one shared by all nodes.
  model::NodeParameters load_node_parameters(YamlMap& own, YamlMap& shared, Absent& absent) {
    model::NodeParameters local;
    const auto from = [&](std::string_view key) -> YamlMap& {
      const bool in_shared = shared.has(key);  // asked in any case, so that the key is known there
      YamlMap& map = own.has(key) || !in_shared ? own : shared;
      cluster_.parameter_lines[fmt::format("{}.{}", own.path(), key)] = map.line(key);
      return map;
    };
    for (const auto& p : kNodeIntegers) read_parameter(from(p.name), p, local, absent);
    for (const auto& p : kNodeScaled) read_parameter(from(p.name), p, local, absent);
    local.pChannels = from("pChannels").choice_or("pChannels", local.pChannels, kChannelChoices);
    local.pWakeupChannel = from("pWakeupChannel")
                               .choice_or("pWakeupChannel", default_wakeup(local.pChannels),
                                          {{"A", model::Channel::kA}, {"B", model::Channel::kB}});
    for (const auto& p : kNodeFlags) local.*p.member = from(p.name).boolean(p.name);
    own.finish();
    return local;
  }

  // A sensor without device and host has copies of the other's, and its own keys say how these differ.
  std::vector<std::optional<std::size_t>> take_likeness(likeness::NamedMaps& sensors) {
    const auto is_copy = [](const YamlMap& map) { return !map.has_own("device") && !map.has_own("host"); };
    // No task would take the lists of a second odometry.
    const auto may_offer = [&](std::size_t entry, std::size_t other) {
      const std::string kind = sensors[other].second.value_text("kind");
      return !is_copy(sensors[entry].second) ||
             std::none_of(model::kSensorKinds.begin(), model::kSensorKinds.end(),
                          [&](const model::SensorKindRow& row) { return row.word == kind && !row.observes; });
    };
    auto alike = likeness::inherit_alike(sensors, "sensor", may_offer);
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      YamlMap& map = sensors[i].second;
      if (!map.has("like")) continue;
      if (!is_copy(map)) {
        for (const char* key : {"raw", "objects", "preprocessing"})
          if (map.has_own(key) && map.has(key))  // asked for, it is a known key
            map.fail(key, "needs a device and a host that are copies: device and host must be left out");
        continue;
      }
      likeness::SensorCopy copy;
      copy.name = sensors[i].first;
      copy.line = map.line("like");
      read_differences(map, copy);
      if (!alike[i]) continue;
      copy.from = static_cast<SensorId>(*alike[i]);
      copies_.push_back({static_cast<SensorId>(i), std::move(copy)});
    }
    return alike;
  }

  // The parts that the file would have from copies, without its other mistakes.
  void list_copied_parts() {
    if (cluster_.nodes.empty() || cluster_.pdus.empty()) return;
    const likeness::Unfinished schedule{cluster_, left_out_.tasks, left_out_.lists, left_out_.shortest_periods};
    for (const auto& [made, asked] : copies_) {
      likeness::SensorCopy copy = asked;
      copy.kind = cluster_.sensor(made).kind;
      for (auto other = copies_.begin(); other != copies_.end();) {  // the first original has the names
        const bool again = other->first == copy.from;
        if (again) copy.from = other->second.from;
        other = again ? copies_.begin() : std::next(other);
      }
      for (std::string& path : parts_of(schedule, copy)) copied_parts_.push_back({std::move(path), copy.name});
    }
  }

  // A copy's copy comes behind it.
  void copy_sensors(likeness::NamedMaps& sensors) {
    const likeness::Unfinished schedule{cluster_, left_out_.tasks, left_out_.lists, left_out_.shortest_periods};
    const std::size_t before = left_out_.lists.size();
    while (!copies_.empty()) {
      const auto next = std::find_if(copies_.begin(), copies_.end(), [&](const auto& one) {
        return std::none_of(copies_.begin(), copies_.end(),
                            [&](const auto& other) { return other.first == one.second.from; });
      });
      auto& [made, copy] = *next;
      copy.kind = cluster_.sensor(made).kind;
      if (const auto refused = refusal(schedule, copy))
        return sensors[index_of(made)].second.fail(refused->key, refused->expected);
      copy_nodes(schedule, copy, made);
      for (const char* node : {"device", "host"})
        cluster_.inherited.erase(fmt::format("sensors.{}.{}", copy.name, node));
      copies_.erase(next);
    }
    for (std::size_t list = before; list < left_out_.lists.size(); ++list) left_out_.lists[list].entry.reset();
    model::order(cluster_.frames);
  }

  void load_sensor(YamlMap& map, model::Sensor& item) {
    left_out::Instant& absent = left_out_.sensors.emplace_back();
    item.line = map.line();
    item.kind = map.choice("kind", model::kind_choices());
    item.device = names_.node(map, "device");
    item.host = names_.node(map, "host");
    enum class Measures : std::uint8_t { kFreely, kScheduled, kFollowing };
    const auto when = map.choice<Measures>(
        "measurement",
        {{"free", Measures::kFreely}, {"scheduled", Measures::kScheduled}, {"completion", Measures::kFollowing}});
    item.scheduled = when == Measures::kScheduled;
    if (item.scheduled) {
      item.at = load_instant(map, cluster_.flexray, {true, false}, absent);
      item.period = cluster_.cycle() * item.at.repetition;
    } else {
      const bool follows = when == Measures::kFollowing;
      item.period = map.duration(follows ? "shortest_period" : "period", {Duration::milliseconds(1), kLongest});
      if (follows) {
        item.after = map.text("after");
        item.longest = map.duration("longest_period", {item.period, kLongest});
      }
      if (map.has("phase")) item.phase = map.duration("phase", {Duration{}, item.period - Duration{1}});
    }
    for (const char* key : {"after", "longest_period"}) remember(map, key);
    map.finish();
  }

  void load_can(YamlMap& map, model::CanBus& bus) {
    std::vector<bool>& absent = left_out_.shortest_periods.emplace_back();
    bus.line = map.line();
    bus.flexible_data_rate = map.boolean("flexible_data_rate");
    bus.nominal_bit_rate = map.integer("nominal_bit_rate", {model::kSlowestCan, model::kFastestNominal}, "bit/s");
    bus.data_bit_rate = bus.nominal_bit_rate;
    if (bus.flexible_data_rate)
      bus.data_bit_rate = map.integer("data_bit_rate", {bus.nominal_bit_rate, model::kFastestData}, "bit/s");
    bus.other_load = map.number("other_load", {0.0, 0.95});
    for (YamlMap& entry : map.maps("messages")) {
      model::CanMessage message;
      message.line = entry.line();
      message.pdu = names_.pdu(entry, "pdu");
      message.identifier = static_cast<std::uint32_t>(entry.integer("identifier", {0, 2047}));
      message.sender = names_.node(entry, "sender");
      const auto period = entry.duration_if("shortest_period", {Duration::microseconds(100), kLongest});
      message.shortest_period = period.value_or(Duration{});  // zero until all senders are known
      absent.push_back(!period);
      entry.finish();
      bus.messages.push_back(message);
    }
    map.finish();
  }

  std::vector<model::PortBinding> load_ports(YamlMap& task, std::string_view key) {
    std::vector<model::PortBinding> bindings;
    if (!task.has(key)) return bindings;
    auto texts = task.named_texts(key);
    YamlMap lines = *task.map_if(key);
    for (auto& [port, text] : texts) {
      model::PortBinding binding;
      binding.port = port;
      binding.line = lines.line(port);
      const auto on = text.find(" on ");
      const auto found = cluster_.find_pdu(std::string_view(text).substr(0, on));
      const std::string medium = on == std::string::npos ? "" : text.substr(on + 4);
      const auto bus = std::find_if(cluster_.can_buses.begin(), cluster_.can_buses.end(),
                                    [&](const model::CanBus& candidate) { return candidate.name == medium; });
      const auto can = static_cast<std::size_t>(bus - cluster_.can_buses.begin());
      // A CAN beyond the limit is already a finding.
      if (bus != cluster_.can_buses.end() && can < model::kMostCans) binding.medium = model::MediumId::can(can);
      if (!found || (medium != "flexray" && bus == cluster_.can_buses.end())) {
        lines.fail(port, "must be PDU on flexray or PDU on CAN, with the names of a PDU and a CAN of this file");
        continue;
      }
      binding.pdu = *found;
      bindings.push_back(std::move(binding));
    }
    return bindings;
  }

  model::Activation load_activation(YamlMap map, left_out::TaskParts& absent) {
    absent.line = map.line();
    model::Activation activation;
    activation.kind = map.choice<model::ActivationKind>("kind", {{"time", model::ActivationKind::kTime},
                                                                 {"message", model::ActivationKind::kMessage},
                                                                 {"sensor", model::ActivationKind::kSensor},
                                                                 {"completion", model::ActivationKind::kCompletion},
                                                                 {"modes", model::ActivationKind::kModes}});
    switch (activation.kind) {
      case model::ActivationKind::kTime:
        activation.at = load_instant(map, cluster_.flexray, {true, true}, absent.at);
        break;
      case model::ActivationKind::kModes: activation.at = load_instant(map, cluster_.flexray, {}, absent.at); break;
      case model::ActivationKind::kMessage: activation.port = map.text("port"); break;
      case model::ActivationKind::kSensor: activation.sensor = names_.sensor(map, "sensor"); break;
      case model::ActivationKind::kCompletion: activation.after = map.text("after"); break;
    }
    for (const char* key : {"port", "sensor", "after"}) remember(map, key);
    map.finish();
    return activation;
  }

  void load_task(YamlMap& map, model::Task& task, left_out::TaskParts& absent) {
    task.line = map.line();
    task.step = map.text("step");
    task.activation = load_activation(map.map("activation"), absent);
    task.best_case = map.duration("best_case", kExecution);
    task.worst_case = map.duration("worst_case", kExecution);
    if (task.worst_case < task.best_case) map.fail("worst_case", "must not be below best_case");
    task.draw = map.choice<model::ExecutionDraw>(
        "draw", {{"uniform", model::ExecutionDraw::kUniform}, {"worst", model::ExecutionDraw::kWorst}});
    const auto deadline = map.duration_if("deadline", kExecution);
    task.deadline = deadline.value_or(kLongest);  // until all responses are known
    absent.deadline = !deadline;
    task.holds = map.duration_or("holds", task.holds, kExecution);
    task.reads = load_ports(map, "reads");
    task.writes = load_ports(map, "writes");
    if (map.has("modes")) task.modes = load_modes(map, task);
    for (const char* key : {"step", "activation", "worst_case", "draw", "deadline", "holds"}) remember(map, key);
    map.finish();
  }

  void load_node(YamlMap& map, YamlMap& shared, model::Node& item) {
    item.line = map.line();
    if (auto own = map.map_if("flexray")) {
      Absent absent;
      item.flexray = load_node_parameters(*own, shared, absent);
      completion_.clock(static_cast<std::size_t>(&item - cluster_.nodes.data()), *own, std::move(absent));
    } else {
      item.microtick_ps = map.scaled("microtick", 1'000, {2'000, 1'000'000}, "ns");
    }
    constexpr std::int64_t kMostDrift = 1'500'000;  // cClockDeviationMax
    item.max_drift_ppb = map.scaled("max_drift_ppm", 1'000, {0, kMostDrift}, "ppm");
    if (map.has("drift_ppm")) item.drift_ppb = map.scaled("drift_ppm", 1'000, {-kMostDrift, kMostDrift}, "ppm");
    remember(map, "drift_ppm");
    auto tasks = map.named_maps("tasks");
    if (tasks.size() > model::kMostTasks)
      map.fail("tasks", fmt::format("must have at most {} entries", model::kMostTasks));
    std::vector<left_out::TaskParts>& absent = left_out_.tasks.emplace_back();
    for (auto& [name, entry] : tasks) {
      item.tasks.emplace_back().name = name;
      load_task(entry, item.tasks.back(), absent.emplace_back());
    }
    map.finish();
  }

  YamlMap root_;
  Findings& findings_;
  model::Cluster cluster_;
  left_out::Parts left_out_;
  std::vector<std::pair<SensorId, likeness::SensorCopy>> copies_;  // for the sensors without device and host
  struct CopiedPart {
    std::string path, sensor;
    int line = 0;  // its first finding
  };
  std::vector<CopiedPart> copied_parts_;
  Names names_;
  Completion completion_;
};

// Returns whether the entry that has an inherited value has the mistake, too.
bool stands_at_its_original(const model::Cluster& cluster, const Finding& finding, const std::vector<Finding>& all) {
  const model::Inherited* other = cluster.inherited_at(finding.key);
  if (other == nullptr) return false;
  const std::size_t key = finding.key.find('.', finding.key.find('.') + 1);
  return std::any_of(all.begin(), all.end(), [&](const Finding& one) {
    return one.key == other->from + finding.key.substr(key) && one.expected == finding.expected;
  });
}

// All that a plan leaves out would be a finding of its own.
void refuse_plan(const StrictYaml& file) {
  if (file.text().empty()) return;  // a described file
  Findings none;
  const YamlMap root = file.root(none);
  if (root.has("plan"))
    throw InputError({file.name(), root.line("plan"), "plan", "",
                      "is of a plan, not of a cluster; `ttfusion schedule synthesize` takes it"});
}

model::Cluster read_cluster(const StrictYaml& file, const TextOrigins& origins) {
  expect_kind(file, FileKind::kCluster);
  refuse_plan(file);
  Findings collected;
  Loader loader(file, collected);
  model::Cluster cluster = loader.load();
  cluster.origins = origins;
  // Shared parameters are read once per node; a mistake in them is reported once.
  Findings findings;
  std::set<std::pair<int, std::string>> known;
  for (const Finding& each : collected.list()) {
    const Finding finding = loader.in_copied_part(each);
    if (!stands_at_its_original(cluster, finding, collected.list()) &&
        known.insert({finding.line, finding.sentence()}).second)
      findings.add(cluster.finding(finding.line, finding.key, finding.value, finding.expected));
  }
  findings.throw_if_any();
  fill_in(cluster, loader.left_out(), findings);
  findings.throw_if_any();
  return cluster;
}

}  // namespace

model::Cluster read_cluster(const StrictYaml& file) { return read_cluster(file, TextOrigins{}); }

model::Cluster parse_cluster(ClusterText text) {
  return read_cluster(StrictYaml::parse(std::move(text.text), std::move(text.name)), text.origins);
}

model::Cluster parse_cluster(std::string text, std::string name) {
  return parse_cluster(ClusterText{std::move(text), std::move(name), {}});
}

model::Cluster load_cluster(const std::string& path) { return parse_cluster(inherited(path)); }

}  // namespace ttf::schedules::file
