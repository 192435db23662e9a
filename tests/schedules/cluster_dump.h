// All that a cluster says, as lines of text, to compare two clusters. Its lines, text and file are left out.
#pragma once

#include <fmt/format.h>

#include <string>

#include "schedules/file/parameter_table.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules {

inline std::string dump(const model::CycleInstant& at) {
  return fmt::format("{}/{}+{}", at.base_cycle, at.repetition, at.offset.value);
}

inline std::string dump(const std::string& start, const std::vector<model::Signal>& signals) {
  std::string text;
  for (const model::Signal& s : signals)
    text += fmt::format("{} {} [{}] bits {} at {} {}..{} step {}\n", start, s.name, s.unit, s.bits, s.bit_offset, s.low,
                        s.high, s.resolution);
  return text;
}

inline std::string dump(const std::string& start, const model::Task& task) {
  const model::Activation& a = task.activation;
  std::string text =
      fmt::format("{} step {} {}..{} draw {} deadline {} holds {} by {} {} port {} sensor {} after {}\n", start,
                  task.step, task.best_case.ns, task.worst_case.ns, static_cast<int>(task.draw), task.deadline.ns,
                  task.holds.ns, static_cast<int>(a.kind), dump(a.at), a.port, static_cast<int>(a.sensor), a.after);
  for (const model::TaskMode& mode : task.modes) {
    text += fmt::format("{} mode {} of {} cycles\n", start, mode.name, mode.cycles);
    for (const model::ModeInstant& one : mode.instants)
      text += fmt::format("{} cycle {} camera {} secondary {} lasts {}\n", start, one.cycle, one.camera, one.secondary,
                          one.lasts.ns);
  }
  for (const auto* ports : {&task.reads, &task.writes})
    for (const model::PortBinding& port : *ports)
      text += fmt::format("{} {} {} = {} on {}\n", start, ports == &task.reads ? "reads" : "writes", port.port,
                          static_cast<int>(port.pdu), port.medium.number());
  return text;
}

inline std::string dump(const model::Node& node) {
  std::string text = fmt::format("node {} {} drift {} max {}\n", node.name, node.microtick_ps,
                                 node.drift_ppb ? fmt::format("{}", *node.drift_ppb) : "drawn", node.max_drift_ppb);
  if (node.flexray) {
    const model::NodeParameters& p = *node.flexray;
    for (const auto& row : file::kNodeIntegers) text += fmt::format("{} {} {}\n", node.name, row.name, p.*row.member);
    for (const auto& row : file::kNodeScaled) text += fmt::format("{} {} {}\n", node.name, row.name, p.*row.member);
    for (const auto& row : file::kNodeFlags) text += fmt::format("{} {} {}\n", node.name, row.name, p.*row.member);
    text += fmt::format("{} channels {} wakeup {}\n", node.name, static_cast<int>(p.pChannels),
                        static_cast<int>(p.pWakeupChannel));
  }
  for (const model::Task& task : node.tasks) text += dump(node.name + "." + task.name, task);
  return text;
}

inline std::string dump(const model::Cluster& cluster) {
  std::string text = fmt::format("synchronisation {} topology {} guardian {}\n", cluster.synchronisation,
                                 static_cast<int>(cluster.topology), cluster.guardian);
  if (const auto& window = cluster.arrival_window)
    text += fmt::format("real_time {} {}\n", window->early.ns, window->late.ns);
  for (const auto& row : file::kGlobalIntegers) text += fmt::format("{} {}\n", row.name, cluster.flexray.*row.member);
  for (const auto& row : file::kGlobalScaled) text += fmt::format("{} {}\n", row.name, cluster.flexray.*row.member);
  for (const model::PduLayout& pdu : cluster.pdus) {
    text +=
        fmt::format("pdu {} sensor {} {} bytes, {} elements, {} each, {} {}\n", pdu.name, static_cast<int>(pdu.sensor),
                    pdu.fragment_bytes, pdu.max_elements, pdu.elements_per_fragment, pdu.header_bits, pdu.element_bits);
    text += dump(pdu.name + " header", pdu.header) + dump(pdu.name + " element", pdu.element);
  }
  for (const model::Sensor& s : cluster.sensors)
    text +=
        fmt::format("sensor {} kind {} device {} host {} scheduled {} period {} phase {} at {} after {} longest {}\n",
                    s.name, static_cast<int>(s.kind), static_cast<int>(s.device), static_cast<int>(s.host), s.scheduled,
                    s.period.ns, s.phase ? s.phase->ns : -1, dump(s.at), s.after, s.longest.ns);
  for (const model::Node& node : cluster.nodes) text += dump(node);
  for (const model::FrameSlot& f : cluster.frames)
    text += fmt::format("slot {} channels {} cycles {}/{} sender {} pdu {} {} vector {} id {} bytes {}\n", f.slot,
                        static_cast<int>(f.channels), f.base_cycle, f.repetition, static_cast<int>(f.sender),
                        static_cast<int>(f.pdu), f.fragment, f.network_management,
                        f.message_id ? static_cast<int>(*f.message_id) : -1, f.payload_bytes);
  for (const model::CanBus& bus : cluster.can_buses) {
    text += fmt::format("can {} fd {} {} {} load {}\n", bus.name, bus.flexible_data_rate, bus.nominal_bit_rate,
                        bus.data_bit_rate, bus.other_load);
    for (const model::CanMessage& m : bus.messages)
      text += fmt::format("{} message {} id {} sender {} every {}\n", bus.name, static_cast<int>(m.pdu), m.identifier,
                          static_cast<int>(m.sender), m.shortest_period.ns);
  }
  return text;
}

}  // namespace ttf::schedules
