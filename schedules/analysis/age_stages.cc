#include "schedules/analysis/age_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "schedules/analysis/can_load.h"
#include "schedules/analysis/responses.h"
#include "schedules/analysis/sensor_loop.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/model/round.h"

namespace ttf::schedules::analysis {
namespace {

// Returns the instant up to which a written list is taken for a cycle, certainly or possibly.
model::CycleInstant latch(const SlotGroup& group, bool latest) {
  return {group.base_cycle, group.repetition, latest ? group.taken_from : group.taken_by};
}

// Returns the shortest time from a frame's action point at one node to its end at another.
std::int64_t shortest_frame(const model::GlobalParameters& g, int words) {
  return (frame_bits(g, words) * g.gdBit_ps + g.gdMinPropagationDelay_ps) / 1000;
}

std::int64_t transmitted(const model::Cluster& cluster, const std::vector<SlotGroup>& groups, std::int64_t from,
                         bool latest) {
  const model::GlobalParameters& g = cluster.flexray;
  std::int64_t end = INT64_MAX;
  for (const SlotGroup& group : groups) {
    const model::Occurrence sent = next_occurrence(g, latch(group, latest), GlobalTime{from});
    // A full list counts to the end of its last slot, a list of one fragment to the end of its frame.
    const std::int64_t done =
        latest ? time_of(g, sent.cycle, group.complete_by).ns
               : time_of(g, sent.cycle, slot_start(g, group.first_fragment) + Macroticks{g.gdActionPointOffset}).ns +
                     shortest_frame(g, g.gPayloadLengthStatic);
    end = std::min(end, done);
  }
  return end;
}

class Builder {
 public:
  explicit Builder(const model::Cluster& cluster) : cluster_(cluster), clocks_(clock_bounds(cluster)) {}

  Path build(SensorId sensor) {
    Path path;
    path.sensor = sensor;
    NodeId node = cluster_.sensor(sensor).device;
    const model::Task* task = measuring_task(cluster_, sensor);
    std::size_t hops = 0, tasks = 0;
    for (const model::Node& any : cluster_.nodes) tasks += any.tasks.size();
    while (task != nullptr) {
      TTF_CHECK(++hops <= tasks, "the lists of {} go round in a ring", cluster_.sensor(sensor).name);
      const model::PortBinding* out = written(*task, sensor);
      if (out == nullptr) break;
      send(path, node, *task, *out);
      path.available = path.stages.size();
      task = reader(*out, node);
      if (task == nullptr) return {};
      receive(path, node, *task, *out);
      pass(path, Waypoint::Kind::kRead, node, out->pdu);
      path.on_arrival = activates(*out, *task);
    }
    if (task == nullptr || path.stages.empty()) return {};
    path.fused = path.stages.size();
    pass(path, Waypoint::Kind::kFused, node);
    publish(path, node, *task);
    return path;
  }

  Path along(SensorId sensor, const std::vector<Reading>& way) {
    Path path;
    path.sensor = sensor;
    NodeId node = cluster_.sensor(sensor).device;
    const model::Task* task = measuring_task(cluster_, sensor);
    bool of_sensor = true, held = false;
    for (const Reading& next : way) {
      if (of_sensor && cluster_.pdu(next.out->pdu).sensor != sensor) {
        of_sensor = false;
        path.fused = path.stages.size();
        held = !writes(*task, *next.out) || !reads_shared(cluster_, *task);
        if (held) pass(path, Waypoint::Kind::kFused, node);
        if (!writes(*task, *next.out)) {
          const Publisher publisher = publisher_of(cluster_, node);
          if (publisher.image != next.out || !wait_for_image(path, node, *task, *publisher.task)) return {};
          task = publisher.task;
        }
      }
      send(path, node, *task, *next.out);
      if (of_sensor) path.available = path.stages.size();
      node = next.node;
      task = next.task;
      receive(path, node, *task, *next.out);
      if (of_sensor) path.on_arrival = activates(*next.out, *task);
      pass(path, &next == &way.back() ? Waypoint::Kind::kUsed : Waypoint::Kind::kRead, node, next.out->pdu);
    }
    path.held = held;
    path.used = path.stages.size();
    if (task->activation.kind == model::ActivationKind::kTime) path.use = task->activation.at;
    return path;
  }

 private:
  void span(Path& path, std::string name, Duration best, Duration worst) {
    Stage stage;
    stage.name = std::move(name);
    stage.best = {std::max<std::int64_t>(0, best.ns - clocks_.drift_ns(best.ns) - model::kGranularity_ns)};
    stage.worst = {worst.ns + clocks_.drift_ns(worst.ns) + model::kGranularity_ns};
    path.stages.push_back(std::move(stage));
  }

  static void pass(Path& path, Waypoint::Kind kind, NodeId node, PduId pdu = kNoPdu) {
    path.waypoints.push_back({kind, node, pdu, path.stages.size(), {}, {}, {}});
  }

  // From the task's start until its list is complete at the reader.
  void send(Path& path, NodeId node, const model::Task& task, const model::PortBinding& out) {
    execution(path, node, task);
    pass(path, Waypoint::Kind::kWritten, node, out.pdu);
    transfer(path, out);
  }
  // From there until the reader starts.
  void receive(Path& path, NodeId node, const model::Task& task, const model::PortBinding& out) {
    pass(path, Waypoint::Kind::kReceived, node, out.pdu);
    activation(path, node, task, out);
  }

  static bool writes(const model::Task& task, const model::PortBinding& out) {
    return std::any_of(task.writes.begin(), task.writes.end(), [&](const auto& binding) { return &binding == &out; });
  }

  const model::PortBinding* written(const model::Task& task, SensorId sensor) const {
    for (const model::PortBinding& binding : task.writes)
      if (cluster_.pdu(binding.pdu).sensor == sensor) return &binding;
    return nullptr;
  }

  void execution(Path& path, NodeId node, const model::Task& task) {
    path.chosen = path.chosen || task.holds > Duration{} || !task.modes.empty();
    if (task.holds > Duration{})
      span(path, fmt::format("{}.{} holds it", cluster_.node(node).name, task.name), {}, task.holds);
    span(path, fmt::format("{}.{} executes", cluster_.node(node).name, task.name), shortest_execution(task),
         task.worst_case);
  }

  void transfer(Path& path, const model::PortBinding& binding) {
    const model::PduLayout& layout = cluster_.pdu(binding.pdu);
    if (binding.medium.is_flexray()) {
      Stage stage;
      stage.name = fmt::format("{} waits for its slots and is sent", layout.name);
      stage.kind = Stage::Kind::kSlots;
      stage.slots = slot_groups(cluster_, binding.pdu);
      TTF_CHECK(!stage.slots.empty(), "{} has no slots", layout.name);
      const std::int64_t shortest = shortest_frame(cluster_.flexray, (layout.fragment_bytes + 1) / 2);
      stage.shortest = {std::max<std::int64_t>(0, shortest - clocks_.drift_ns(shortest) - model::kGranularity_ns)};
      path.stages.push_back(std::move(stage));
      return;
    }
    const model::CanBus& bus = cluster_.can(binding.medium);
    const auto worst = can_worst_response(cluster_, bus, *message_of(bus, binding.pdu));
    TTF_CHECK(worst.has_value(), "{} is overloaded", bus.name);
    span(path, fmt::format("{} on {}", layout.name, bus.name), can_soonest_arrival(bus, layout.fragment_bytes), *worst);
  }

  const model::CanMessage* message_of(const model::CanBus& bus, PduId pdu) const {
    const auto message = std::find_if(bus.messages.begin(), bus.messages.end(),
                                      [&](const model::CanMessage& m) { return m.pdu == pdu; });
    TTF_CHECK(message != bus.messages.end(), "{} is no message on {}", cluster_.pdu(pdu).name, bus.name);
    return &*message;
  }

  const model::Task* reader(const model::PortBinding& out, NodeId& node) const {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (const model::Task& task : cluster_.nodes[n].tasks)
        for (const model::PortBinding& in : task.reads)
          if (in.pdu == out.pdu && in.medium == out.medium) {
            node = static_cast<NodeId>(n);
            return &task;
          }
    return nullptr;
  }

  const model::Task* task_called(const model::Node& node, const std::string& name) const {
    for (const model::Task& task : node.tasks)
      if (task.name == name) return &task;
    return nullptr;
  }

  // Adds the time from the list's arrival to the task's start.
  void activation(Path& path, NodeId id, const model::Task& task, const model::PortBinding& list) {
    const model::Node& node = cluster_.node(id);
    const std::string who = fmt::format("{}.{}", node.name, task.name);
    // A task with modes begins at some instants of its grid. It looks at the newest list.
    if (is_by_time(task.activation)) {
      instant(path, who, task.activation.at);
    } else if (task.activation.kind == model::ActivationKind::kCompletion) {
      // It reads at its own start. The wait is at most a period of its chain's first task and all responses.
      Duration worst{};
      const model::Task* before = task_called(node, task.activation.after);
      for (; before->activation.kind == model::ActivationKind::kCompletion;
           before = task_called(node, before->activation.after))
        worst += response(id, *before);
      worst += response(id, *before) + longest_period(*before);
      span(path, who + " is waited for", {}, worst);
    } else if (!activates(list, task)) {
      span(path, who + " is waited for", {}, longest_period(task));
    }
    queue(path, id, task, activates(list, task) ? lists_before(node, list) : Before{});
  }

  // Other tasks activated by lists on the same CAN. One list's last frame ends before the other's next begins.
  // When `in` arrives, such a task has therefore had the processor for at least `lead`. The lead is the duration
  // of the last frame of `in`, or of all its frames if the other list must wait for them. A shorter list has a
  // shorter lead but arrived earlier by the same amount: the longest list is the worst.
  struct Before {
    std::vector<const model::Task*> tasks;
    Duration lead{};
  };
  Before lists_before(const model::Node& node, const model::PortBinding& in) const {
    Before before;
    if (in.medium.is_flexray()) return before;
    const model::CanBus& bus = cluster_.can(in.medium);
    const model::CanMessage& own = *message_of(bus, in.pdu);
    for (const model::Task& other : node.tasks) {
      if (other.activation.kind != model::ActivationKind::kMessage) continue;
      for (const model::PortBinding& binding : other.reads) {
        if (binding.port != other.activation.port || binding.medium != in.medium || binding.pdu == in.pdu) continue;
        const Duration lead = message_of(bus, binding.pdu)->identifier > own.identifier
                                  ? can_list_worst_case(bus, cluster_.pdu(in.pdu))
                                  : can_worst_case(bus, cluster_.pdu(in.pdu).fragment_bytes);
        before.lead = before.tasks.empty() ? lead : std::min(before.lead, lead);
        before.tasks.push_back(&other);
      }
    }
    return before;
  }

  // Returns whether this list, not another one, activates the task.
  bool activates(const model::PortBinding& list, const model::Task& task) const {
    return std::any_of(task.reads.begin(), task.reads.end(), [&](const model::PortBinding& in) {
      return model::activates(task, in) && in.pdu == list.pdu && in.medium == list.medium;
    });
  }

  // A task not activated by time is activated by some sensor's lists. They all come (A1), at the latest after
  // the next period as well.
  Duration longest_period(const model::Task& task) const {
    Duration longest{};
    if (is_by_time(task.activation)) return cluster_.cycle() * task.activation.at.repetition;
    for (const model::Sensor& sensor : cluster_.sensors) longest = std::max(longest, sensor.longest_period());
    return longest * 2;
  }

  void instant(Path& path, const std::string& who, const model::CycleInstant& at) {
    Stage stage;
    stage.name = who + " is waited for";
    stage.kind = Stage::Kind::kActivation;
    stage.at = at;
    path.stages.push_back(std::move(stage));
  }

  // First come, first served: adds the task's response bound less its own execution.
  void queue(Path& path, NodeId id, const model::Task& task, const Before& before) {
    const Duration others = response(id, task, before) - task.worst_case;
    if (others > Duration{})
      span(path, fmt::format("{}.{} waits for other tasks", cluster_.node(id).name, task.name), {}, others);
  }

  Duration response(NodeId id, const model::Task& task) const { return response(id, task, Before{}); }
  Duration response(NodeId id, const model::Task& task, const Before& before) const {
    const model::Node& node = cluster_.node(id);
    // The lead is in true time; the processor's clock may be slower.
    std::vector<Duration> ahead(node.tasks.size());
    for (const model::Task* other : before.tasks)
      ahead[index_in(node, *other)] = {std::max<std::int64_t>(0, before.lead.ns - clocks_.drift_ns(before.lead.ns))};
    const auto worst = worst_response(cluster_, id, index_in(node, task), ahead);
    TTF_CHECK(worst.has_value(), "{} may be busy without end", node.name);
    return *worst;
  }

  static std::size_t index_in(const model::Node& node, const model::Task& task) {
    return static_cast<std::size_t>(&task - node.tasks.data());
  }

  // Adds the time from the fusing task's start to that of the task that writes the image. Returns false if it has no
  // bound.
  bool wait_for_image(Path& path, NodeId id, const model::Task& fusing, const model::Task& publisher) {
    const bool follows =
        publisher.activation.kind == model::ActivationKind::kCompletion && publisher.activation.after == fusing.name;
    if (!follows && publisher.activation.kind != model::ActivationKind::kTime) return false;
    execution(path, id, fusing);
    // The instant of the image may come while this list is fused. Its task then follows directly, and the
    // fusing adds nothing to the least age.
    if (!follows && fusing.activation.kind == model::ActivationKind::kMessage) path.stages.back().best = {};
    if (!follows) {
      instant(path, fmt::format("{}.{}", cluster_.node(id).name, publisher.name), publisher.activation.at);
      path.stages.back().behind_execution = true;
    }
    queue(path, id, publisher, {});
    pass(path, Waypoint::Kind::kImage, id);
    return true;
  }

  // Adds the path from the fusing task's start to the start of the image's reader.
  void publish(Path& path, NodeId id, const model::Task& fusing) {
    const auto [publisher, image] = publisher_of(cluster_, id);
    if (publisher == nullptr) return;
    if (publisher != &fusing && !wait_for_image(path, id, fusing, *publisher)) return;
    send(path, id, *publisher, *image);
    NodeId at = id;
    const model::Task* user = reader(*image, at);
    if (user == nullptr) return;
    receive(path, at, *user, *image);
    pass(path, Waypoint::Kind::kUsed, at);
    path.used = path.stages.size();
    if (user->activation.kind == model::ActivationKind::kTime) path.use = user->activation.at;
  }

  const model::Cluster& cluster_;
  ClockBounds clocks_;
};

}  // namespace

Path path_of(const model::Cluster& cluster, SensorId sensor) { return Builder(cluster).build(sensor); }

Path path_along(const model::Cluster& cluster, SensorId sensor, const std::vector<Reading>& way) {
  return Builder(cluster).along(sensor, way);
}

const model::Task* measuring_task(const model::Cluster& cluster, SensorId sensor) {
  for (const model::Task& task : cluster.node(cluster.sensor(sensor).device).tasks)
    if (task.activation.kind == model::ActivationKind::kSensor && task.activation.sensor == sensor) return &task;
  return nullptr;
}

bool reads_shared(const model::Cluster& cluster, const model::Task& task) {
  return std::ranges::any_of(task.reads,
                             [&](const auto& binding) { return cluster.pdu(binding.pdu).sensor == kNoSensor; });
}

Publisher publisher_of(const model::Cluster& cluster, NodeId node) {
  for (const model::Task& task : cluster.node(node).tasks)
    for (const model::PortBinding& binding : task.writes)
      if (cluster.pdu(binding.pdu).sensor == kNoSensor) return {&task, &binding};
  return {};
}

std::vector<std::int64_t> walk(const model::Cluster& cluster, const Path& path, std::size_t first, std::size_t last,
                               std::int64_t start, bool latest, bool first_is_exact) {
  const std::int64_t apart = clock_bounds(cluster).apart_ns;
  std::vector<std::int64_t> instants;
  std::int64_t t = start;
  for (std::size_t i = first; i < last; ++i) {
    const Stage& stage = path.stages[i];
    const std::int64_t margin = i == first && first_is_exact ? 0 : latest ? apart : -apart;
    // The difference between clocks may bring a nominally late event in time, and the reverse.
    switch (stage.kind) {
      case Stage::Kind::kSpan: t += latest ? stage.worst.ns : stage.best.ns; break;
      case Stage::Kind::kActivation: {
        const bool behind = stage.behind_execution && i > first;
        const std::int64_t from = !behind ? t : i == first + 1 ? start : instants[i - first - 2];
        t = std::max(behind ? t : INT64_MIN,
                     next_occurrence(cluster.flexray, stage.at, GlobalTime{from + margin}).time.ns);
        break;
      }
      case Stage::Kind::kSlots:
        t = stage.on_grid(latest) ? transmitted(cluster, stage.slots, t + margin, latest) : t + stage.shortest.ns;
        break;
    }
    instants.push_back(t);
  }
  return instants;
}

std::vector<std::int64_t> entries(const model::Cluster& cluster, const Stage& stage, std::int64_t from_cycle,
                                  bool latest) {
  std::vector<model::CycleInstant> gates;
  if (stage.kind == Stage::Kind::kActivation) gates.push_back(stage.at);
  if (stage.kind == Stage::Kind::kSlots)
    for (const SlotGroup& group : stage.slots) gates.push_back(latch(group, latest));
  std::vector<std::int64_t> instants;
  for (const model::CycleInstant& gate : gates)
    for (std::int64_t cycle = from_cycle; cycle < from_cycle + cycles_per_round(cluster.flexray); ++cycle)
      if (in_cycle(gate, cycle)) instants.push_back(time_of(cluster.flexray, cycle, gate.offset).ns + (latest ? 1 : 0));
  return instants;
}

}  // namespace ttf::schedules::analysis
