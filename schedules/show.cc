#include "schedules/show.h"

#include <fmt/format.h>

#include <algorithm>

#include "schedules/can_load.h"

namespace ttf::schedules {
namespace {

std::string cycles_text(int base_cycle, int repetition) {
  if (repetition == 1) return "every cycle";
  return fmt::format("cycles {} + n*{}", base_cycle, repetition);
}

double in_ms(Duration d) { return static_cast<double>(d.ns) * 1e-6; }

// The cycle to scale: S static slots in use, s free ones, d dynamic segment, w symbol window, n network idle time.
std::string bar(const Cluster& cluster) {
  constexpr int kWidth = 96;
  const GlobalParameters& g = cluster.flexray;
  std::string text;
  for (int column = 0; column < kWidth; ++column) {
    const int at = static_cast<int>((2LL * column + 1) * g.gMacroPerCycle / (2 * kWidth));
    const int slot = at / g.gdStaticSlot + 1;
    const bool used = std::any_of(cluster.frames.begin(), cluster.frames.end(),
                                  [&](const FrameSlot& frame) { return frame.slot == slot; });
    const int idle = g.gMacroPerCycle - g.gdNIT;
    text += slot <= g.gNumberOfStaticSlots ? (used ? 'S' : 's')
            : at >= idle                   ? 'n'
            : at >= idle - g.gdSymbolWindow ? 'w' : 'd';
  }
  return text;
}

std::string activation_text(const Cluster& cluster, const Task& task) {
  const GlobalParameters& g = cluster.flexray;
  const Activation& activation = task.activation;
  switch (activation.kind) {
    case ActivationKind::kTime: {
      const GlobalTime start = time_of(g, activation.at.base_cycle, activation.at.offset);
      return fmt::format("at {:.3f} ms + n*{:g} ms (macrotick {} of {})", in_ms(start - GlobalTime{}),
                         in_ms(cluster.cycle() * activation.at.repetition), activation.at.offset.value,
                         cycles_text(activation.at.base_cycle, activation.at.repetition));
    }
    case ActivationKind::kMessage: return fmt::format("when {} arrives", activation.port);
    case ActivationKind::kSensor: return fmt::format("when {} measures", cluster.sensor(activation.sensor).name);
    case ActivationKind::kCompletion: return fmt::format("after {}", activation.after);
  }
  return {};
}

void show_slots(const Cluster& cluster, std::string& text) {
  const GlobalParameters& g = cluster.flexray;
  text += fmt::format("{:>9}  {:>15}  {:<2}  {:<12}{:<34}{}\n", "slot", "macroticks", "ch", "sender", "frame", "cycles");
  for (std::size_t i = 0; i < cluster.frames.size();) {
    const FrameSlot& first = cluster.frames[i];
    std::size_t end = i + 1;
    while (end < cluster.frames.size() && continues(cluster.frames[end - 1], cluster.frames[end])) ++end;
    const FrameSlot& last = cluster.frames[end - 1];
    const std::string slots = end - i == 1 ? fmt::format("{}", first.slot) : fmt::format("{}-{}", first.slot, last.slot);
    std::string frame = "status";
    if (first.pdu != kNoPdu)
      frame = fmt::format("{} {}{}", cluster.pdu(first.pdu).name, first.fragment,
                          end - i == 1 ? "" : fmt::format("-{}", last.fragment));
    const NodeParameters* sender = cluster.node(first.sender).flexray ? &*cluster.node(first.sender).flexray : nullptr;
    if (sender != nullptr && sender->pKeySlotId == first.slot)
      frame += sender->pKeySlotUsedForSync ? (sender->pKeySlotUsedForStartup ? " (sync, startup)" : " (sync)") : " (key)";
    text += fmt::format("{:>9}  {:>7}-{:<7}  {:<2}  {:<12}{:<34}{}\n", slots, (first.slot - 1) * g.gdStaticSlot,
                        last.slot * g.gdStaticSlot, channels_text(first.channels), cluster.node(first.sender).name,
                        frame, cycles_text(first.base_cycle, first.repetition));
    i = end;
  }
}

}  // namespace

std::string show_text(const Cluster& cluster) {
  const GlobalParameters& g = cluster.flexray;
  const int dynamic = g.gMacroPerCycle - g.gdNIT - g.gdSymbolWindow - g.gNumberOfStaticSlots * g.gdStaticSlot;
  std::string text = fmt::format(
      "{}: cycle of {:g} ms, {} macroticks: static {} x {}, dynamic {}, symbol window {}, idle {}\n\n{}\n"
      "S static slot in use, s free, d dynamic segment, w symbol window, n network idle time\n\n",
      cluster.name, in_ms(cluster.cycle()), g.gMacroPerCycle, g.gNumberOfStaticSlots, g.gdStaticSlot, dynamic,
      g.gdSymbolWindow, g.gdNIT, bar(cluster));
  show_slots(cluster, text);
  text += "\nsensors\n";
  for (const Sensor& sensor : cluster.sensors) {
    std::string when = fmt::format("runs freely, every {:g} ms", in_ms(sensor.period));
    if (sensor.scheduled)
      when = fmt::format("at {:.3f} ms + n*{:g} ms",
                         in_ms(time_of(g, sensor.at.base_cycle, sensor.at.offset) - GlobalTime{}), in_ms(sensor.period));
    text += fmt::format("  {:<12}{} -> {}: {}\n", sensor.name, cluster.node(sensor.device).name,
                        cluster.node(sensor.host).name, when);
  }
  text += "\ntasks\n";
  for (const Node& node : cluster.nodes)
    for (const Task& task : node.tasks)
      text += fmt::format("  {:<12}{:<16}{:g}-{:g} ms, deadline {:g} ms, {}\n", node.name, task.name,
                          in_ms(task.best_case), in_ms(task.worst_case), in_ms(task.deadline),
                          activation_text(cluster, task));
  text += "\nCAN, worst-case load\n";
  for (const CanBus& bus : cluster.can_buses)
    text += fmt::format("  {:<20}{:>5.1f} %\n", bus.name, 100.0 * can_worst_load(cluster, bus));
  return text;
}

}  // namespace ttf::schedules
