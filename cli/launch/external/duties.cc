#include "cli/launch/external/duties.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bus/socketcan/flexray_on_can.h"
#include "bus/wire/flexray_frame.h"
#include "core/check.h"
#include "core/counted.h"
#include "schedules/analysis/can_load.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/model/sensor_lines.h"

namespace ttf::cli::launch::external {
namespace {

using schedules::check::stretched;
using schedules::model::Cluster;

Duration scheduled(const Cluster& cluster, Macroticks offset) {
  return {offset.value * cluster.flexray.gdMacrotick_ps / 1000};
}

SlotDuty slot_duty(const Cluster& cluster, const schedules::model::FrameSlot& frame, std::int64_t scale) {
  const auto& g = cluster.flexray;
  const auto& parameters = *cluster.node(frame.sender).flexray;
  SlotDuty duty;
  duty.slot = frame.slot;
  duty.base_cycle = frame.base_cycle;
  duty.repetition = frame.repetition;
  duty.channels = frame.channels;
  const Macroticks action_point{std::int64_t{frame.slot - 1} * g.gdStaticSlot + g.gdActionPointOffset};
  duty.due = stretched(scheduled(cluster, action_point), scale);
  duty.payload_bytes = 2 * g.gPayloadLengthStatic;
  duty.sync = parameters.pKeySlotUsedForSync && frame.slot == parameters.pKeySlotId;
  duty.startup = duty.sync && parameters.pKeySlotUsedForStartup;
  duty.pdu = frame.pdu;
  duty.fragment = frame.fragment;
  bus::wire::FrameHeader header;
  header.payload_preamble = frame.network_management;
  header.sync = duty.sync;
  header.startup = duty.startup;
  header.frame_id = static_cast<std::uint16_t>(frame.slot);
  const std::vector<std::byte> payload(static_cast<std::size_t>(duty.payload_bytes));
  std::array<std::byte, bus::wire::kMaxFrameBytes> bytes{};
  const auto channel = includes(frame.channels, schedules::model::Channel::kA) ? schedules::model::Channel::kA
                                                                               : schedules::model::Channel::kB;
  const std::size_t size = bus::wire::encode_frame(header, channel, payload, bytes);
  std::transform(bytes.begin(), bytes.begin() + bus::wire::kHeaderBytes, duty.header.begin(),
                 [](std::byte byte) { return static_cast<std::uint8_t>(byte); });
  for (const canfd_frame& can : bus::socketcan::frame_to_can(frame.slot, std::span(bytes).first(size)).all())
    duty.can_lengths.push_back(can.len);
  return duty;
}

// Returns the lines of sensors that this node drives.
void add_lines(const Cluster& cluster, NodeId node, std::int64_t scale, Duties& duties) {
  for (std::size_t s = 0; s < cluster.sensors.size(); ++s) {
    const schedules::model::Sensor& sensor = cluster.sensors[s];
    const auto id = static_cast<SensorId>(s);
    const auto can = schedules::model::can_of_lines(cluster, id);
    if (!can) continue;
    const bool triggered = sensor.scheduled || sensor.follows();
    const std::string& name = cluster.can_buses[*can].name;
    CanDuty duty{.can_bus = *can, .sensor = id};
    if (sensor.host == node && triggered) {
      duty.kind = CanDutyKind::kTrigger;
      duty.identifier = schedules::model::trigger_identifier(id);
      if (sensor.scheduled) {
        duty.at = sensor.at;
        duty.due = stretched(scheduled(cluster, sensor.at.offset), scale);
      }
      duties.cans.push_back(duty);
    }
    if (sensor.device == node) {
      duty.kind = CanDutyKind::kStrobe;
      duty.identifier = schedules::model::strobe_identifier(id);
      duty.length = schedules::model::kStrobeBytes;
      duties.cans.push_back(duty);
    }
    const auto reads = [&](const char* what, std::uint32_t identifier) {
      duties.reads.push_back(
          {kNoPdu, id, fmt::format("{} {}, {}, identifier 0x{:03X}", sensor.name, what, name, identifier)});
    };
    if (sensor.host == node) reads("strobe", schedules::model::strobe_identifier(id));
    if (sensor.device == node && triggered) reads("trigger", schedules::model::trigger_identifier(id));
  }
}

void add_messages(const Cluster& cluster, NodeId node, std::int64_t scale, Duties& duties) {
  for (std::size_t b = 0; b < cluster.can_buses.size(); ++b) {
    const schedules::model::CanBus& bus = cluster.can_buses[b];
    for (const schedules::model::CanMessage& message : bus.messages) {
      if (message.sender != node) continue;
      CanDuty duty{.can_bus = b, .pdu = message.pdu};
      duty.identifier = message.identifier;
      duty.flexible_data_rate = bus.flexible_data_rate;
      const auto length =
          schedules::analysis::can_data_length(bus.flexible_data_rate, cluster.pdu(message.pdu).fragment_bytes);
      TTF_CHECK(length.has_value(), "{} on {}", cluster.pdu(message.pdu).name, bus.name);
      duty.length = static_cast<std::size_t>(*length);
      duty.shortest = stretched(message.shortest_period, scale);
      duties.cans.push_back(duty);
    }
  }
}

// Returns "6, 20..22" for the slots 22, 20, 21, 6.
std::string runs_text(std::vector<int> slots) {
  std::ranges::sort(slots);
  std::vector<std::string> runs;
  for (std::size_t first = 0, last = 0; first < slots.size(); first = last = last + 1) {
    while (last + 1 < slots.size() && slots[last + 1] <= slots[last] + 1) ++last;  // a slot may be there twice
    runs.push_back(slots[first] == slots[last] ? fmt::to_string(slots[first])
                                               : fmt::format("{}..{}", slots[first], slots[last]));
  }
  return joined(runs);
}

// Returns where a list is sent on FlexRay: "slots 22..34, cycles 1 + 8n".
std::string slots_of(const Cluster& cluster, PduId pdu) {
  std::vector<int> slots;
  std::string cycles;
  for (const schedules::model::FrameSlot& frame : cluster.frames) {
    if (frame.pdu != pdu) continue;
    slots.push_back(frame.slot);
    const std::string these = cycles_text(frame.base_cycle, frame.repetition);
    cycles = cycles.empty() || cycles == these ? these : "several";
  }
  const std::string runs = runs_text(std::move(slots));
  const bool one = runs.find_first_not_of("0123456789") == std::string::npos;
  return fmt::format("{} {}, cycles {}", one ? "slot" : "slots", runs, cycles);
}

void add_reads(const Cluster& cluster, NodeId node, Duties& duties) {
  for (const schedules::model::Task& task : cluster.node(node).tasks)
    for (const schedules::model::PortBinding& read : task.reads) {
      std::string from;
      if (read.medium.is_flexray()) {
        from = slots_of(cluster, read.pdu);
      } else {
        const schedules::model::CanBus& bus = cluster.can(read.medium);
        const auto message = std::ranges::find(bus.messages, read.pdu, &schedules::model::CanMessage::pdu);
        if (message == bus.messages.end()) continue;
        from = fmt::format("{}, identifier 0x{:03X}", bus.name, message->identifier);
      }
      const auto same = [&](const Reading& one) { return one.pdu == read.pdu && one.from == from; };
      if (std::ranges::none_of(duties.reads, same)) duties.reads.push_back({read.pdu, kNoSensor, std::move(from)});
    }
}

}  // namespace

Duties duties_of(const Cluster& cluster, NodeId node, std::int64_t time_scale_ppm) {
  TTF_CHECK(cluster.arrival_window.has_value(), "{} has no arrival window", cluster.file);
  Duties duties;
  duties.node = cluster.node(node).name;
  duties.cycle = stretched(cluster.cycle(), time_scale_ppm);
  duties.window = *cluster.arrival_window;
  for (const schedules::model::FrameSlot& frame : cluster.frames)
    if (frame.sender == node && !is_dynamic(cluster.flexray, frame))
      duties.slots.push_back(slot_duty(cluster, frame, time_scale_ppm));
  add_messages(cluster, node, time_scale_ppm, duties);
  add_lines(cluster, node, time_scale_ppm, duties);
  add_reads(cluster, node, duties);
  const auto add = [&](PduId pdu) {
    if (pdu != kNoPdu && std::ranges::find(duties.lists, pdu) == duties.lists.end()) duties.lists.push_back(pdu);
  };
  for (const SlotDuty& slot : duties.slots) add(slot.pdu);
  for (const CanDuty& can : duties.cans) add(can.pdu);
  for (const Reading& read : duties.reads) add(read.pdu);
  return duties;
}

std::string cycles_text(int base_cycle, int repetition) {
  return repetition == 1 ? "all" : fmt::format("{} + {}n", base_cycle, repetition);
}

}  // namespace ttf::cli::launch::external
