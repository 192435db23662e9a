#include "schedules/synthesis/plan/likeness.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "schedules/model/limits.h"
#include "schedules/synthesis/plan/layouts.h"

namespace ttf::schedules::synthesis::plan {
namespace {

struct Wanted {
  std::optional<model::SensorKind> kind;
  std::optional<int> raw, objects;
  std::optional<Duration> preprocessing;
  int line = 0;
};

class Copier {
 public:
  Copier(Plan& plan, SensorId from, std::string name, Wanted wanted)
      : plan_(plan), cluster_(plan.cluster), from_(from), old_(cluster_.sensor(from).name), name_(std::move(name)),
        wanted_(wanted) {}

  // Returns why it cannot be copied; empty if it can.
  std::string refusal() const {
    const model::Sensor& sensor = cluster_.sensor(from_);
    if (sensor.device == sensor.host || !is_alone(sensor.device) || !is_alone(sensor.host))
      return fmt::format("must be a sensor whose device and host have no tasks of other sensors; {} is none", old_);
    for (const model::CanBus& bus : cluster_.can_buses)
      if (carries(bus) &&
          !std::all_of(bus.messages.begin(), bus.messages.end(), [&](const auto& m) { return own(m.pdu); }))
        return fmt::format("must be a sensor with a CAN of its own; {} has other lists, too", bus.name);
    if (cluster_.nodes.size() + 2 > model::kMostNamed || cluster_.pdus.size() + 2 > model::kMostNamed ||
        cluster_.can_buses.size() + 1 > model::kMostCans)
      return fmt::format("has no room beside {} others", model::kMostNamed);
    for (const NodeId node : {sensor.device, sensor.host})
      if (cluster_.find_node(renamed(cluster_.node(node).name)))
        return fmt::format("needs a node {}, a name that is taken", renamed(cluster_.node(node).name));
    for (const model::Node& node : cluster_.nodes)
      if (node.tasks.size() >= model::kMostTasks && reads_own(node))
        return fmt::format("needs another task of {}, which has {}", node.name, model::kMostTasks);
    return "";
  }

  // Returns the key whose number a list cannot have, and the most that it can; none if all fit.
  std::optional<std::pair<const char*, std::int64_t>> too_many() const {
    for (std::size_t p = 0; p < cluster_.pdus.size(); ++p) {
      if (!own(static_cast<PduId>(p))) continue;
      const bool raw = writes(cluster_.sensor(from_).device, static_cast<PduId>(p));
      const std::int64_t most = most_elements(layout_like(p, raw));
      if (const auto& wanted = raw ? wanted_.raw : wanted_.objects; wanted && *wanted > most)
        return std::pair{raw ? "raw" : "objects", most};
    }
    return std::nullopt;
  }

  void copy() {
    const auto sensor = static_cast<SensorId>(cluster_.sensors.size());
    copy_lists(sensor);
    copy_cans();
    const model::Sensor original = cluster_.sensor(from_);
    const NodeId device = copy_node(original.device, sensor), host = copy_node(original.host, sensor);
    model::Sensor made = original;
    made.name = name_;
    made.device = device;
    made.host = host;
    made.line = wanted_.line;
    if (wanted_.kind) made.kind = *wanted_.kind;
    cluster_.sensors.push_back(std::move(made));
    PlannedSensor planned = plan_.sensors[index_of(from_)];
    planned.at.instant = true;
    planned.like = from_;
    plan_.sensors.push_back(planned);
    senders({original.device, device}, {original.host, host});
    copy_slots(host);
    key_slot(host);
    for (std::size_t n = 0; n < index_of(device); ++n)
      if (n != index_of(original.device) && n != index_of(original.host)) extend_reader(n);
  }

 private:
  bool own(PduId pdu) const { return cluster_.pdu(pdu).sensor == from_; }
  bool carries(const model::CanBus& bus) const {
    return std::any_of(bus.messages.begin(), bus.messages.end(), [&](const auto& m) { return own(m.pdu); });
  }
  bool reads_own(const model::Node& node) const {
    return std::any_of(node.tasks.begin(), node.tasks.end(), [&](const model::Task& task) {
      return std::any_of(task.reads.begin(), task.reads.end(), [&](const auto& in) { return own(in.pdu); });
    });
  }
  // Whether all lists of the node's tasks are the sensor's.
  bool is_alone(NodeId id) const {
    for (const model::Task& task : cluster_.node(id).tasks)
      for (const auto* bindings : {&task.reads, &task.writes})
        for (const model::PortBinding& binding : *bindings)
          if (!own(binding.pdu)) return false;
    return !cluster_.node(id).tasks.empty();
  }

  std::string renamed(const std::string& text) const {
    const std::size_t at = text.find(old_);
    return at == std::string::npos ? name_ + "_" + text : std::string(text).replace(at, old_.size(), name_);
  }

  model::PduLayout layout_like(std::size_t pdu, bool raw) const {
    const auto known = wanted_.kind ? known_kind(*wanted_.kind) : std::nullopt;
    if (!known) return cluster_.pdus[pdu];
    return raw ? known->raw : known->objects;
  }

  // The header counts elements and numbers fragments.
  static std::int64_t most_elements(const model::PduLayout& layout) {
    const auto values = [&](std::string_view name) {
      const auto found = find_signal(layout.header, name);
      return std::int64_t{1} << (found ? layout.header[*found].bits : 0);
    };
    const std::int64_t fragments = std::min<std::int64_t>(model::kMostFragments, values("fragment"));
    return std::min(values("count") - 1, fragments * layout.elements_per_fragment);
  }

  void copy_lists(SensorId sensor) {
    const NodeId device = cluster_.sensor(from_).device;
    const std::size_t before = cluster_.pdus.size();
    new_pdus_.assign(before, kNoPdu);
    for (std::size_t p = 0; p < before; ++p) {
      if (!own(static_cast<PduId>(p))) continue;
      const bool raw = writes(device, static_cast<PduId>(p));
      model::PduLayout made = layout_like(p, raw);
      made.name = renamed(cluster_.pdus[p].name);
      made.sensor = sensor;
      made.line = wanted_.line;
      if (const auto& most = raw ? wanted_.raw : wanted_.objects) made.max_elements = *most;
      plan_.free_layouts.push_back(plan_.free_layouts[p] && !(wanted_.kind && known_kind(*wanted_.kind)));
      new_pdus_[p] = static_cast<PduId>(cluster_.pdus.size());
      cluster_.pdus.push_back(std::move(made));
    }
  }

  bool writes(NodeId node, PduId pdu) const {
    for (const model::Task& task : cluster_.node(node).tasks)
      for (const model::PortBinding& out : task.writes)
        if (out.pdu == pdu) return true;
    return false;
  }

  void copy_cans() {
    const std::size_t before = cluster_.can_buses.size();
    new_cans_.assign(before, 0);
    for (std::size_t c = 0; c < before; ++c) {
      if (!carries(cluster_.can_buses[c])) continue;
      model::CanBus made = cluster_.can_buses[c];
      made.name = renamed(made.name);
      made.line = wanted_.line;
      for (model::CanMessage& message : made.messages) {
        message.pdu = new_pdus_[index_of(message.pdu)];
        message.line = wanted_.line;
      }
      new_cans_[c] = cluster_.can_buses.size();
      cluster_.can_buses.push_back(std::move(made));
      plan_.shortest_periods.push_back(std::vector<bool>(cluster_.can_buses.back().messages.size(), true));
    }
  }

  // Messages are sent by the copies.
  void senders(std::pair<NodeId, NodeId> device, std::pair<NodeId, NodeId> host) {
    for (const std::size_t can : new_cans_) {
      if (can == 0) continue;
      for (model::CanMessage& message : cluster_.can_buses[can].messages)
        for (const auto& [old, made] : {device, host})
          if (message.sender == old) message.sender = made;
    }
  }

  model::PortBinding rebound(model::PortBinding binding) const {
    binding.pdu = new_pdus_[index_of(binding.pdu)];
    if (binding.medium.is_can()) binding.medium = model::MediumId::can(new_cans_[binding.medium.can_index()]);
    binding.line = wanted_.line;
    return binding;
  }

  model::Task rebound(model::Task task, SensorId sensor) const {
    for (model::PortBinding& in : task.reads) in = rebound(in);
    for (model::PortBinding& out : task.writes) out = rebound(out);
    if (task.activation.kind == model::ActivationKind::kSensor) task.activation.sensor = sensor;
    task.line = wanted_.line;
    return task;
  }

  NodeId copy_node(NodeId id, SensorId sensor) {
    model::Node made = cluster_.node(id);
    const bool device = id == cluster_.sensor(from_).device;
    made.name = renamed(made.name);
    made.line = wanted_.line;
    const auto known = wanted_.kind ? known_kind(*wanted_.kind) : std::nullopt;
    for (model::Task& task : made.tasks) {
      task = rebound(task, sensor);
      if (known) task.step = device ? known->measuring_step : known->preprocessing_step;
      if (device || !wanted_.preprocessing) continue;
      task.worst_case = *wanted_.preprocessing;
      task.best_case = std::min(task.best_case, task.worst_case);
    }
    cluster_.nodes.push_back(std::move(made));
    std::vector<PlannedTask> planned = plan_.tasks[index_of(id)];
    for (PlannedTask& task : planned) {
      task.at.instant = task.deadline = true;
      task.line = wanted_.line;
    }
    plan_.tasks.push_back(std::move(planned));
    plan_.parameters.controllers.push_back(plan_.parameters.controllers[index_of(id)]);
    return static_cast<NodeId>(cluster_.nodes.size() - 1);
  }

  void copy_slots(NodeId host) {
    std::set<PduId> done;
    const auto add = [&](PlannedList list) {
      if (!own(list.pdu) || !done.insert(list.pdu).second) return;
      list.pdu = new_pdus_[index_of(list.pdu)];
      list.sender = host;
      list.at.instant = true;
      list.line = wanted_.line;
      plan_.lists.push_back(list);
    };
    for (const PlannedList& list : std::vector<PlannedList>(plan_.lists)) add(list);
    for (const model::FrameSlot& frame : std::vector<model::FrameSlot>(cluster_.frames))
      if (frame.pdu != kNoPdu)
        add({frame.pdu, host, frame.channels, 0, frame.repetition, 1, {true, false}, wanted_.line});
  }

  void key_slot(NodeId host) {
    if (!cluster_.node(host).flexray) return;
    std::set<int> taken;
    for (const model::FrameSlot& frame : cluster_.frames) taken.insert(frame.slot);
    for (const PlannedList& list : plan_.lists)  // a list may stand in a key slot
      for (int f = 0; !list.at.instant && f < cluster_.pdu(list.pdu).max_fragments(); ++f) taken.insert(list.slot + f);
    int free = 1;
    while (taken.contains(free)) ++free;
    model::NodeParameters& parameters = *cluster_.nodes[index_of(host)].flexray;
    parameters.pKeySlotId = free;
    parameters.pKeySlotUsedForStartup = parameters.pKeySlotUsedForSync = false;
    cluster_.frames.push_back({free, parameters.pChannels, 0, 1, host, kNoPdu, 0, wanted_.line});
  }

  // A task that reads lists of this sensor alone is copied; another one reads the copy's, too.
  void extend_reader(std::size_t node) {
    for (std::size_t t = 0, count = cluster_.nodes[node].tasks.size(); t < count; ++t) {
      model::Task& task = cluster_.nodes[node].tasks[t];
      const auto is_own = [&](const model::PortBinding& in) { return own(in.pdu); };
      if (std::none_of(task.reads.begin(), task.reads.end(), is_own)) continue;
      if (std::all_of(task.reads.begin(), task.reads.end(), is_own) && task.writes.empty()) {
        model::Task made = rebound(task, from_);
        made.name = renamed(made.name);
        for (model::PortBinding& in : made.reads) in.port = renamed(in.port);
        cluster_.nodes[node].tasks.push_back(std::move(made));
        PlannedTask planned = plan_.tasks[node][t];
        planned.at.instant = planned.deadline = true;
        planned.line = wanted_.line;
        plan_.tasks[node].push_back(planned);
        continue;
      }
      for (const model::PortBinding& in : std::vector<model::PortBinding>(task.reads)) {
        if (!is_own(in)) continue;
        task.reads.push_back(rebound(in));
        task.reads.back().port = renamed(in.port);
      }
    }
  }

  Plan& plan_;
  model::Cluster& cluster_;
  SensorId from_;
  std::string old_, name_;
  Wanted wanted_;
  std::vector<PduId> new_pdus_;        // by the original's
  std::vector<std::size_t> new_cans_;  // by the original's; 0: not copied
};

}  // namespace

void add_alike(const std::string& name, YamlMap& map, Plan& plan) {
  Wanted wanted;
  wanted.line = map.line();
  const std::string like = map.text("like");
  if (map.has("kind"))
    wanted.kind = map.choice<model::SensorKind>("kind", {{"laser", model::SensorKind::kLaser},
                                                         {"camera", model::SensorKind::kCamera},
                                                         {"radar", model::SensorKind::kRadar}});
  if (map.has("raw")) wanted.raw = static_cast<int>(map.integer("raw", {1, 3'584}));
  if (map.has("objects")) wanted.objects = static_cast<int>(map.integer("objects", {1, 255}));
  if (map.has("preprocessing"))
    wanted.preprocessing = map.duration("preprocessing", {Duration::microseconds(1), Duration::milliseconds(1'000)});
  map.finish();
  if (name.empty() || plan.cluster.find_sensor(name)) return map.fail("", "is the name of an earlier sensor");
  const auto from = plan.cluster.find_sensor(like);
  if (!from) {
    if (map.has("like")) map.fail("like", "is not the name of an earlier sensor");
    return;
  }
  Copier copier(plan, *from, name, wanted);
  if (const std::string refusal = copier.refusal(); !refusal.empty()) return map.fail("like", refusal);
  if (const auto most = copier.too_many())
    return map.fail(most->first, fmt::format("must be at most {}: the list's header holds no more", most->second));
  copier.copy();
}

}  // namespace ttf::schedules::synthesis::plan
