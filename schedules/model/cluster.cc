#include "schedules/model/cluster.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/check.h"
#include "core/int128.h"

namespace ttf::schedules::model {

namespace {

template <class Id, class Item> std::optional<Id> find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  if (found == items.end()) return std::nullopt;
  return static_cast<Id>(found - items.begin());
}

}  // namespace

std::string_view channels_text(Channels channels) {
  return channels == Channels::kA ? "A" : channels == Channels::kB ? "B" : "AB";
}

void order(std::vector<FrameSlot>& frames) {
  std::stable_sort(frames.begin(), frames.end(), [](const FrameSlot& a, const FrameSlot& b) {
    return std::pair{a.slot, a.base_cycle} < std::pair{b.slot, b.base_cycle};
  });
}

bool share_a_cycle(const FrameSlot& a, const FrameSlot& b) {
  const int common = std::gcd(a.repetition, b.repetition);
  return a.base_cycle % common == b.base_cycle % common;
}

bool activates(const Task& task, const PortBinding& read) {
  return task.activation.kind == ActivationKind::kMessage && task.activation.port == read.port;
}

bool continues(const FrameSlot& before, const FrameSlot& frame, int step) {
  return frame.pdu != kNoPdu && frame.pdu == before.pdu && frame.slot == before.slot + 1 &&
         frame.fragment == before.fragment + step && frame.sender == before.sender &&
         frame.channels == before.channels && frame.base_cycle == before.base_cycle &&
         frame.repetition == before.repetition && frame.network_management == before.network_management &&
         frame.message_id == before.message_id;
}

Finding Cluster::finding(int line, std::string key, std::string value, std::string expected) const {
  if (const Inherited* other = inherited_at(key)) {
    line = other->line;
    expected += value.empty() ? fmt::format("; {} has it", other->from)
                              : fmt::format("; {} has the value {}", other->from, value);
    value.clear();
  }
  return origins.moved({file, line, std::move(key), std::move(value), std::move(expected)});
}

const Inherited* Cluster::inherited_at(std::string_view key) const {
  const auto behind = inherited.upper_bound(key);
  if (behind == inherited.begin()) return nullptr;
  const auto& [of, other] = *std::prev(behind);
  const bool within = key.starts_with(of) && (key.size() == of.size() || key[of.size()] == '[');
  return within ? &other : nullptr;
}

bool Cluster::describes_tasks() const {
  return !sensors.empty() ||
         std::any_of(nodes.begin(), nodes.end(), [](const Node& node) { return !node.tasks.empty(); }) ||
         std::any_of(can_buses.begin(), can_buses.end(), [](const CanBus& bus) { return !bus.messages.empty(); });
}

std::optional<NodeId> Cluster::find_node(std::string_view node_name) const {
  return find_named<NodeId>(nodes, node_name);
}

std::optional<PduId> Cluster::find_pdu(std::string_view pdu_name) const { return find_named<PduId>(pdus, pdu_name); }

std::optional<SensorId> Cluster::find_sensor(std::string_view sensor_name) const {
  return find_named<SensorId>(sensors, sensor_name);
}

bool has_step(const Node& node, std::string_view step) {
  return std::ranges::any_of(node.tasks, [&](const Task& task) { return task.step == step; });
}
bool has_step(const Cluster& cluster, std::string_view step) {
  return std::ranges::any_of(cluster.nodes, [&](const Node& node) { return has_step(node, step); });
}

bool is_on_can(const Node& node, std::size_t can_bus) {
  const MediumId medium = MediumId::can(can_bus);
  const auto leads_there = [medium](const PortBinding& port) { return port.medium == medium; };
  return std::any_of(node.tasks.begin(), node.tasks.end(), [&](const Task& task) {
    return std::any_of(task.reads.begin(), task.reads.end(), leads_there) ||
           std::any_of(task.writes.begin(), task.writes.end(), leads_there);
  });
}

std::vector<NodeId> nodes_on_can(const Cluster& cluster, std::size_t can_bus) {
  std::vector<NodeId> nodes;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
    if (is_on_can(cluster.nodes[n], can_bus)) nodes.push_back(static_cast<NodeId>(n));
  return nodes;
}

GlobalTime time_of(const GlobalParameters& flexray, std::int64_t cycle, Macroticks offset) {
  const Int128 ps =
      static_cast<Int128>(cycle) * flexray.cycle_ps() + static_cast<Int128>(offset.value) * flexray.gdMacrotick_ps;
  // Rounded up: a clock that shows this nanosecond has reached the macrotick.
  const Int128 ns = ps / 1000;
  return {static_cast<std::int64_t>(ns * 1000 < ps ? ns + 1 : ns)};
}

Occurrence next_occurrence(const GlobalParameters& flexray, const CycleInstant& at, GlobalTime from) {
  TTF_CHECK(at.repetition > 0 && at.base_cycle >= 0 && at.base_cycle < at.repetition, "base {} repetition {}",
            at.base_cycle, at.repetition);
  const std::int64_t repetition = at.repetition;
  std::int64_t cycle = at.base_cycle;
  if (from.ns > 0) {
    // Starts at a round that certainly ends at or before `from`; at most two steps follow.
    const Int128 round_ps = static_cast<Int128>(repetition) * flexray.cycle_ps();
    const auto rounds = static_cast<std::int64_t>(static_cast<Int128>(from.ns) * 1000 / round_ps);
    cycle += std::max<std::int64_t>(rounds - 1, 0) * repetition;
  }
  while (time_of(flexray, cycle, at.offset) < from) cycle += repetition;
  return {cycle, time_of(flexray, cycle, at.offset)};
}

}  // namespace ttf::schedules::model
