#include "schedules/exchange/cluster_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "schedules/analysis/can_load.h"
#include "schedules/analysis/dynamic_load.h"
#include "schedules/analysis/minislots.h"
#include "schedules/analysis/object_ceiling.h"
#include "schedules/analysis/slot_groups.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/model/ports.h"

namespace ttf::schedules::exchange {
namespace {

constexpr std::size_t kWidest = 100;  // characters of a line

std::string cycles_text(int base_cycle, int repetition) {
  if (repetition == 1) return "every cycle";
  return fmt::format("cycles {} + n*{}", base_cycle, repetition);
}

// Draws the cycle to scale: S static slots in use, s free ones, D the most that dynamic frames can take, d the
// rest of their segment, w symbol window (at least one column), n network idle time.
std::string bar(const model::Cluster& cluster) {
  constexpr int kWidth = 96;
  const model::GlobalParameters& g = cluster.flexray;
  const int idle = g.gMacroPerCycle - g.gdNIT, window = idle - g.gdSymbolWindow;
  std::int64_t taken = 0;
  for (const analysis::DynamicLoad& load : analysis::dynamic_load(cluster)) taken = std::max(taken, load.minislots);
  const std::int64_t free = taken == 0 ? 0 : analysis::minislot_start(g, taken + 1).value;
  std::string text;
  for (int column = 0; column < kWidth; ++column) {
    const auto macrotick = [&](int half_columns) {
      return static_cast<int>(static_cast<std::int64_t>(half_columns) * g.gMacroPerCycle / (2 * kWidth));
    };
    const int at = macrotick(2 * column + 1);
    const int slot = at / g.gdStaticSlot + 1;
    const bool used = std::any_of(cluster.frames.begin(), cluster.frames.end(),
                                  [&](const model::FrameSlot& frame) { return frame.slot == slot; });
    if (slot <= g.gNumberOfStaticSlots)
      text += used ? 'S' : 's';
    else if (g.gdSymbolWindow > 0 && window >= macrotick(2 * column) && window < macrotick(2 * column + 2))
      text += 'w';
    else
      text += at >= idle ? 'n' : at >= window ? 'w' : at < free ? 'D' : 'd';
  }
  return text;
}

// Returns the macroticks from the start of the first slot to the end of the last. For dynamic slots these are
// the earliest start and the latest end, within the segment.
std::pair<std::int64_t, std::int64_t> macroticks(const model::Cluster& cluster, const model::FrameSlot& first,
                                                 const model::FrameSlot& last) {
  const model::GlobalParameters& g = cluster.flexray;
  if (!is_dynamic(g, first))
    return {analysis::slot_start(g, first.slot).value, analysis::slot_start(g, last.slot + 1).value};
  const std::int64_t over =
      analysis::latest_turn(cluster, last) + analysis::minislots_of(g, analysis::dynamic_words(cluster, last));
  return {analysis::minislot_start(g, analysis::earliest_turn(g, first)).value,
          analysis::minislot_start(g, std::min<std::int64_t>(over, g.gNumberOfMinislots + 1)).value};
}

std::string activation_text(const model::Cluster& cluster, const model::Task& task) {
  const model::GlobalParameters& g = cluster.flexray;
  const model::Activation& activation = task.activation;
  switch (activation.kind) {
    case model::ActivationKind::kTime: {
      const GlobalTime start = time_of(g, activation.at.base_cycle, activation.at.offset);
      return fmt::format("at {:.3f} ms + n*{:g} ms", in_ms(start - GlobalTime{}),
                         in_ms(cluster.cycle() * activation.at.repetition));
    }
    case model::ActivationKind::kModes: {
      const GlobalTime start = time_of(g, activation.at.base_cycle, activation.at.offset);
      return fmt::format("in modes, from {:.3f} ms + n*{:g} ms on", in_ms(start - GlobalTime{}),
                         in_ms(cluster.cycle() * activation.at.repetition));
    }
    case model::ActivationKind::kMessage: return fmt::format("when {} arrives", activation.port);
    case model::ActivationKind::kSensor: return fmt::format("when {} measures", cluster.sensor(activation.sensor).name);
    case model::ActivationKind::kCompletion: return fmt::format("after {}", activation.after);
  }
  return {};
}

// Fragments of one list in successive slots. Other frames may stand between them in file order: those of other
// cycles, and for a list split between the channels those of the other channel.
struct FrameRun {
  const model::FrameSlot* last = nullptr;
  int step = 1;
};
FrameRun run_from(const model::Cluster& cluster, std::size_t first, std::vector<char>& shown) {
  FrameRun run{&cluster.frames[first], 1};
  for (std::size_t i = first + 1; i < cluster.frames.size() && cluster.frames[i].slot <= run.last->slot + 1; ++i) {
    const model::FrameSlot& frame = cluster.frames[i];
    if (shown[i]) continue;
    if (run.last == &cluster.frames[first] && continues(*run.last, frame, 2)) run.step = 2;
    if (!continues(*run.last, frame, run.step)) continue;
    shown[i] = 1;
    run.last = &frame;
  }
  return run;
}

// Returns the width of a column with these names, and a blank behind the longest.
template <class Named> std::size_t width_of(const std::vector<Named>& all, std::size_t least) {
  for (const Named& one : all) least = std::max(least, one.name.size() + 1);
  return least;
}

void show_slots(const model::Cluster& cluster, std::string& text) {
  const model::GlobalParameters& g = cluster.flexray;
  const std::size_t senders = width_of(cluster.nodes, 12);
  text += fmt::format("{:>9}  {:>15}  {:<2}  {:<{}}{:<34}{}\n", "slot", "macroticks", "ch", "sender", senders, "frame",
                      "cycles");
  std::vector<char> shown(cluster.frames.size());
  for (std::size_t i = 0; i < cluster.frames.size(); ++i) {
    if (shown[i]) continue;
    const model::FrameSlot& first = cluster.frames[i];
    const FrameRun run = run_from(cluster, i, shown);
    const model::FrameSlot& last = *run.last;
    const bool alone = &first == &last;
    const std::string slots = alone ? fmt::format("{}", first.slot) : fmt::format("{}-{}", first.slot, last.slot);
    std::string frame = is_dynamic(g, first) ? fmt::format("{} bytes", first.payload_bytes) : "status";
    if (first.pdu != kNoPdu)
      frame = fmt::format("{} {}{}{}", cluster.pdu(first.pdu).name, first.fragment,
                          alone ? "" : fmt::format("-{}", last.fragment), run.step == 2 ? ", every other" : "");
    const model::NodeParameters* sender =
        cluster.node(first.sender).flexray ? &*cluster.node(first.sender).flexray : nullptr;
    if (sender != nullptr && sender->pKeySlotId == first.slot)
      frame +=
          sender->pKeySlotUsedForSync ? (sender->pKeySlotUsedForStartup ? " (sync, startup)" : " (sync)") : " (key)";
    if (first.network_management) frame += " + vector";
    if (is_dynamic(g, first)) frame += " (dynamic)";
    const auto [begin, over] = macroticks(cluster, first, last);
    text +=
        fmt::format("{:>9}  {:>7}-{:<7}  {:<2}  {:<{}}{:<34}{}\n", slots, begin, over, channels_text(first.channels),
                    cluster.node(first.sender).name, senders, frame, cycles_text(first.base_cycle, first.repetition));
  }
  if (g.gdSymbolWindow > 0) {
    const int idle = g.gMacroPerCycle - g.gdNIT;
    text += fmt::format("{:>9}  {:>7}-{:<7}  {:<2}  {:<{}}{:<34}{}\n", "", idle - g.gdSymbolWindow, idle, "AB", "",
                        senders, "symbol window", cycles_text(0, 1));
  }
}

void show_real_time(const model::Cluster& cluster, std::string& text) {
  text += "\nreal time\n";
  if (const auto& window = cluster.arrival_window)
    text += fmt::format(
        "  frames may arrive from {:g} us before to {:g} us after their action point; time scale 1 has room for {:g} "
        "us\n",
        1e3 * in_ms(window->early), 1e3 * in_ms(window->late),
        1e3 * in_ms(check::arrival_room(cluster, check::kTimeScaleOne)));
  for (const Finding& finding : check::check_real_time(cluster, check::kTimeScaleOne))
    text += fmt::format("  not at time scale 1: {}{}{} {}\n", finding.key, finding.value.empty() ? "" : " = ",
                        finding.value, finding.expected);
}

void show_objects(const model::Cluster& cluster, std::string& text) {
  const analysis::ObjectCeiling ceiling = analysis::object_ceiling(cluster);
  if (ceiling.lists.empty()) return;
  text += "\nobjects\n";
  for (const analysis::ListRoom& room : ceiling.lists)
    text +=
        fmt::format("  {:<16}{:>4} in {} slots, {} to a slot; its header counts to {}\n", cluster.pdu(room.pdu).name,
                    room.objects, room.slots, cluster.pdu(room.pdu).elements_per_fragment, room.countable);
  text += fmt::format("  {} objects in every list; {} if the lists shared all {} static slots without status frames\n",
                      ceiling.carried, ceiling.with_all_static_slots, ceiling.free_for_lists);
}

// A row for each mode: its detections, each at its cycle of the frame.
std::string modes_text(const model::Task& task, const std::string& indent) {
  const std::vector<const model::PortBinding*> cameras = camera_ports(task);
  std::string text;
  for (const model::TaskMode& mode : task.modes) {
    text += fmt::format("{}mode {}: {} cycles:", indent, mode.name, mode.cycles);
    for (const model::ModeInstant& one : mode.instants)
      text += fmt::format(" {}{} at {}{}", cameras[one.camera]->port, one.secondary ? " (region)" : "", one.cycle,
                          &one == &mode.instants.back() ? "" : ",");
    text += '\n';
  }
  return text;
}

// A row for each mapping of the file, in the order in which they are met; a long one goes on below itself.
void show_derived(const model::Cluster& cluster, std::string& text) {
  if (cluster.derived.empty()) return;
  text += "\nderived, as the file leaves them out\n";
  std::vector<std::pair<std::string, std::string>> rows;
  for (const model::DerivedValue& one : cluster.derived) {
    const std::size_t dot = one.path.rfind('.');
    const std::string of = one.path.substr(0, dot), value = one.path.substr(dot + 1) + " = " + one.value;
    auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& known) { return known.first == of; });
    if (row == rows.end()) row = rows.insert(row, {of, fmt::format("  {}:", of)});
    const std::size_t line = row->second.rfind('\n') + 1;
    const bool full = row->second.size() - line + 2 + value.size() > kWidest;
    if (!row->second.ends_with(':')) row->second += ',';
    row->second += (full ? "\n      " : " ") + value;
  }
  for (const auto& row : rows) text += row.second + '\n';
}

// A time on the cycle's own grid goes below a row that it would make too wide.
std::string task_text(const model::Cluster& cluster, const model::Node& node, const model::Task& task) {
  const std::string names =
      fmt::format("  {:<{}}{:<{}}", node.name, width_of(cluster.nodes, 12), task.name, width_of(node.tasks, 16));
  std::string text = fmt::format("{}{:g}-{:g} ms, deadline {:g} ms, {}", names, in_ms(task.best_case),
                                 in_ms(task.worst_case), in_ms(task.deadline), activation_text(cluster, task));
  if (task.activation.kind == model::ActivationKind::kTime) {
    const model::Activation& activation = task.activation;
    const std::string grid = fmt::format("(macrotick {} of {})", activation.at.offset.value,
                                         cycles_text(activation.at.base_cycle, activation.at.repetition));
    text += (text.size() + 1 + grid.size() > kWidest ? '\n' + std::string(names.size(), ' ') : " ") + grid;
  }
  return text + '\n' + modes_text(task, std::string(names.size(), ' '));
}

// Breaks lines that are too wide at blanks. Their other lines are further in.
std::string wrapped(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    const std::string indent(std::min(line.find_first_not_of(' '), line.size()) + 4, ' ');
    while (line.size() > kWidest) {
      const std::size_t blank = line.rfind(' ', kWidest);
      if (blank == std::string::npos || blank <= indent.size()) break;
      out += line.substr(0, blank) + '\n';
      line = indent + line.substr(blank + 1);
    }
    out += line + '\n';
    at = end + 1;
  }
  return out;
}

}  // namespace

std::string show_text(const model::Cluster& cluster) {
  const model::GlobalParameters& g = cluster.flexray;
  const int dynamic = g.gMacroPerCycle - g.gdNIT - g.gdSymbolWindow - g.gNumberOfStaticSlots * g.gdStaticSlot;
  const bool sent = !analysis::dynamic_lists(cluster).empty();
  std::string text = fmt::format(
      "{}: cycle of {:g} ms, {} macroticks: static {} x {}, dynamic {}, symbol window {}, idle {}\n\n{}\n"
      "S static slot in use, s free, {}d dynamic segment, w symbol window, n network idle time\n\n",
      cluster.name, in_ms(cluster.cycle()), g.gMacroPerCycle, g.gNumberOfStaticSlots, g.gdStaticSlot, dynamic,
      g.gdSymbolWindow, g.gdNIT, bar(cluster), sent ? "D dynamic frames at most, " : "");
  show_slots(cluster, text);
  if (sent) text += "\n" + analysis::dynamic_text(cluster);
  show_objects(cluster, text);
  show_real_time(cluster, text);
  show_derived(cluster, text);
  if (!cluster.describes_tasks()) return wrapped(text) + "\nno tasks, sensors and CANs are described\n";
  text += "\nsensors\n";
  for (const model::Sensor& sensor : cluster.sensors) {
    std::string when = fmt::format("runs freely, every {:g} ms", in_ms(sensor.period));
    if (sensor.scheduled)
      when =
          fmt::format("at {:.3f} ms + n*{:g} ms",
                      in_ms(time_of(g, sensor.at.base_cycle, sensor.at.offset) - GlobalTime{}), in_ms(sensor.period));
    if (sensor.follows())
      when =
          fmt::format("when {} ends, every {:g} to {:g} ms", sensor.after, in_ms(sensor.period), in_ms(sensor.longest));
    text += fmt::format("  {:<{}}{} -> {}: {}\n", sensor.name, width_of(cluster.sensors, 12),
                        cluster.node(sensor.device).name, cluster.node(sensor.host).name, when);
  }
  text += "\ntasks\n";
  for (const model::Node& node : cluster.nodes)
    for (const model::Task& task : node.tasks) text += task_text(cluster, node, task);
  text += "\nCAN, worst-case load\n";
  for (const model::CanBus& bus : cluster.can_buses)
    text += fmt::format("  {:<20}{:>5.1f} %\n", bus.name, 100.0 * analysis::can_worst_load(cluster, bus));
  return wrapped(text);
}

}  // namespace ttf::schedules::exchange
