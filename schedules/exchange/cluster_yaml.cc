#include "schedules/exchange/cluster_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string_view>

#include "core/decimal.h"
#include "core/yaml_merge.h"
#include "schedules/file/parameter_table.h"
#include "schedules/model/ports.h"

namespace ttf::schedules::exchange {
namespace {

std::string instant(const model::CycleInstant& at) {
  return fmt::format("base_cycle: {}, repetition: {}, offset: {}", at.base_cycle, at.repetition, at.offset.value);
}

using Controllers = std::vector<const model::NodeParameters*>;

// A parameter of controllers: its key, and its value as text.
struct Parameter {
  std::string key;
  std::function<std::string(const model::NodeParameters&)> text;
};

std::vector<Parameter> controller_parameters() {
  std::vector<Parameter> all;
  for (const auto& p : file::kNodeScaled)
    all.push_back({std::string(p.name), [&p](const auto& node) { return scaled_text(node.*p.member, p.scale); }});
  for (const auto& p : file::kNodeIntegers)
    all.push_back({std::string(p.name), [&p](const auto& node) { return fmt::format("{}", node.*p.member); }});
  for (const auto& p : file::kNodeFlags)
    all.push_back({std::string(p.name), [&p](const auto& node) { return node.*p.member ? "true" : "false"; }});
  all.push_back({"pChannels", [](const auto& node) { return std::string(channels_text(node.pChannels)); }});
  all.push_back({"pWakeupChannel", [](const auto& node) { return std::string(1, letter(node.pWakeupChannel)); }});
  return all;
}

class Writer {
 public:
  explicit Writer(const model::Cluster& cluster) : cluster_(cluster), parameters_(controller_parameters()) {}

  std::string write(const std::string& heading) {
    std::istringstream lines(heading);
    for (std::string line; std::getline(lines, line);) say("# {}", line);
    say("name: {}", yaml_scalar(cluster_.name));
    say("synchronisation: {}", cluster_.synchronisation);
    if (cluster_.topology == model::Topology::kStar) say("topology: star");
    if (cluster_.guardian) say("guardian: true");
    if (const auto& window = cluster_.arrival_window)
      say("real_time: {{early: {}, late: {}}}", duration_text(window->early), duration_text(window->late));
    flexray();
    shared_parameters();
    pdus();
    sensors();
    nodes();
    frames();
    cans();
    return std::move(text_);
  }

 private:
  template <class... Values> void say(fmt::format_string<Values...> form, const Values&... values) {
    text_ += fmt::vformat(form, fmt::make_format_args(values...));
    text_ += '\n';
  }

  void flexray() {
    const model::GlobalParameters& g = cluster_.flexray;
    say("\nflexray:");
    for (const auto& p : file::kGlobalScaled) say("  {}: {}", p.name, scaled_text(g.*p.member, p.scale));
    for (const auto& p : file::kGlobalIntegers) say("  {}: {}", p.name, g.*p.member);
  }

  // Returns the value that all controllers have; none if they differ.
  std::string shared(const Parameter& parameter) const {
    std::string value;
    for (const model::Node& node : cluster_.nodes) {
      if (!node.flexray) continue;
      const std::string own = parameter.text(*node.flexray);
      if (!value.empty() && own != value) return "";
      value = own;
    }
    return value;
  }

  void shared_parameters() {
    std::string block;
    for (const Parameter& parameter : parameters_)
      if (const std::string value = shared(parameter); !value.empty())
        block += fmt::format("  {}: {}\n", parameter.key, value);
    text_ += block.empty() ? "\nnode_parameters: {}\n" : "\nnode_parameters:\n" + block;
  }

  void signals(std::string_view key, const std::vector<model::Signal>& signals) {
    say("    {}:{}", key, signals.empty() ? " []" : "");
    for (const model::Signal& signal : signals) {
      std::string line = fmt::format("name: {}", yaml_scalar(signal.name));
      if (!signal.unit.empty()) line += fmt::format(", unit: {}", yaml_scalar(signal.unit));
      line += fmt::format(", bits: {}", signal.bits);
      if (signal.low != 0.0) line += fmt::format(", low: {}", signal.low);
      const double top = signal.low + (std::ldexp(1.0, signal.bits) - 1.0) * signal.resolution;
      if (signal.high != top) line += fmt::format(", high: {}", signal.high);
      if (signal.resolution != 1.0) line += fmt::format(", resolution: {}", signal.resolution);
      say("      - {{{}}}", line);
    }
  }

  void pdus() {
    say("\npdus:{}", cluster_.pdus.empty() ? " {}" : "");
    for (const model::PduLayout& layout : cluster_.pdus) {
      say("  {}:", yaml_scalar(layout.name));
      if (layout.sensor != kNoSensor) say("    sensor: {}", yaml_scalar(cluster_.sensor(layout.sensor).name));
      say("    fragment_bytes: {}", layout.fragment_bytes);
      say("    max_elements: {}", layout.max_elements);
      say("    elements_per_fragment: {}", layout.elements_per_fragment);
      signals("header", layout.header);
      signals("element", layout.element);
    }
  }

  void sensors() {
    say("\nsensors:{}", cluster_.sensors.empty() ? " {}" : "");
    for (const model::Sensor& sensor : cluster_.sensors) {
      std::string when;
      if (sensor.scheduled)
        when = fmt::format("scheduled, {}", instant(sensor.at));
      else if (sensor.follows())
        when = fmt::format("completion, after: {}, shortest_period: {}, longest_period: {}", yaml_scalar(sensor.after),
                           duration_text(sensor.period), duration_text(sensor.longest));
      else
        when = fmt::format("free, period: {}", duration_text(sensor.period));
      if (sensor.phase) when += fmt::format(", phase: {}", duration_text(*sensor.phase));
      say("  {}:\n    {{kind: {}, device: {}, host: {}, measurement: {}}}", yaml_scalar(sensor.name),
          model::row_of(sensor.kind).word, yaml_scalar(cluster_.node(sensor.device).name),
          yaml_scalar(cluster_.node(sensor.host).name), when);
    }
  }

  void nodes() {
    say("\nnodes:{}", cluster_.nodes.empty() ? " {}" : "");
    for (const model::Node& node : cluster_.nodes) {
      say("  {}:", yaml_scalar(node.name));
      if (node.flexray) {
        std::string own;
        for (const Parameter& parameter : parameters_)
          if (shared(parameter).empty())
            own += fmt::format("{}{}: {}", own.empty() ? "" : ", ", parameter.key, parameter.text(*node.flexray));
        say("    flexray: {{{}}}", own);
      } else {
        say("    microtick: {}", scaled_text(node.microtick_ps, 1'000));
      }
      if (node.drift_ppb) say("    drift_ppm: {}", scaled_text(*node.drift_ppb, 1'000));
      say("    max_drift_ppm: {}", scaled_text(node.max_drift_ppb, 1'000));
      say("    tasks:{}", node.tasks.empty() ? " {}" : "");
      for (const model::Task& task : node.tasks) write_task(task);
    }
  }

  std::string activation(const model::Activation& activation) const {
    switch (activation.kind) {
      case model::ActivationKind::kTime: return fmt::format("kind: time, {}", instant(activation.at));
      case model::ActivationKind::kMessage: return fmt::format("kind: message, port: {}", yaml_scalar(activation.port));
      case model::ActivationKind::kSensor:
        return fmt::format("kind: sensor, sensor: {}", yaml_scalar(cluster_.sensor(activation.sensor).name));
      case model::ActivationKind::kCompletion:
        return fmt::format("kind: completion, after: {}", yaml_scalar(activation.after));
      case model::ActivationKind::kModes: return fmt::format("kind: modes, {}", instant(activation.at));
    }
    return "";
  }

  void write_task(const model::Task& task) {
    say("      {}:", yaml_scalar(task.name));
    say("        step: {}", yaml_scalar(task.step));
    say("        activation: {{{}}}", activation(task.activation));
    say("        best_case: {}", duration_text(task.best_case));
    say("        worst_case: {}", duration_text(task.worst_case));
    say("        draw: {}", task.draw == model::ExecutionDraw::kWorst ? "worst" : "uniform");
    say("        deadline: {}", duration_text(task.deadline));
    if (task.holds > Duration{}) say("        holds: {}", duration_text(task.holds));
    if (!task.modes.empty()) write_modes(task);
    ports("reads", task.reads);
    ports("writes", task.writes);
  }

  void write_modes(const model::Task& task) {
    const std::vector<const model::PortBinding*> cameras = camera_ports(task);
    say("        modes:");
    for (const model::TaskMode& mode : task.modes) {
      say("          {}:", yaml_scalar(mode.name));
      say("            frame: {}", mode.cycles);
      say("            detections:");
      for (const model::ModeInstant& one : mode.instants)
        say("              - {{cycle: {}, camera: {}, look: {}, lasts: {}}}", one.cycle,
            yaml_scalar(cameras[one.camera]->port), one.secondary ? "secondary" : "primary", duration_text(one.lasts));
    }
  }

  void ports(std::string_view key, const std::vector<model::PortBinding>& bindings) {
    std::string list;
    for (const model::PortBinding& binding : bindings)
      list += fmt::format(
          "{}{}: {}", list.empty() ? "" : ", ", yaml_scalar(binding.port),
          yaml_scalar(fmt::format("{} on {}", cluster_.pdu(binding.pdu).name,
                                  binding.medium.is_can() ? cluster_.can(binding.medium).name : "flexray")));
    if (!list.empty()) say("        {}: {{{}}}", key, list);
  }

  void frames() {
    say("\nframes:{}", cluster_.frames.empty() ? " []" : "");
    std::vector<bool> done(cluster_.frames.size());
    for (std::size_t f = 0; f < cluster_.frames.size(); ++f) {
      if (done[f]) continue;
      const model::FrameSlot& first = cluster_.frames[f];
      int fragments = 1;
      const model::FrameSlot* last = &first;
      for (std::size_t next = f + 1; next < cluster_.frames.size(); ++next)
        if (!done[next] && continues(*last, cluster_.frames[next])) {
          last = &cluster_.frames[next];
          done[next] = true;
          ++fragments;
        }
      frame(first, fragments);
    }
  }

  void frame(const model::FrameSlot& first, int fragments) {
    std::string more;
    if (first.pdu != kNoPdu) {
      more = fmt::format(", pdu: {}, fragments: {}", yaml_scalar(cluster_.pdu(first.pdu).name), fragments);
      if (first.fragment > 0) more += fmt::format(", first_fragment: {}", first.fragment);
    } else if (first.payload_bytes > 0) {
      more = fmt::format(", bytes: {}", first.payload_bytes);
    }
    if (first.network_management) more += ", network_management: true";
    if (first.message_id) more += fmt::format(", message_id: {}", *first.message_id);
    say("  - {{slot: {}, channels: {}, sender: {}, base_cycle: {}, repetition: {}{}}}", first.slot,
        channels_text(first.channels), yaml_scalar(cluster_.node(first.sender).name), first.base_cycle,
        first.repetition, more);
  }

  void cans() {
    say("\ncan:{}", cluster_.can_buses.empty() ? " {}" : "");
    for (const model::CanBus& bus : cluster_.can_buses) {
      say("  {}:", yaml_scalar(bus.name));
      say("    flexible_data_rate: {}", bus.flexible_data_rate);
      say("    nominal_bit_rate: {}", bus.nominal_bit_rate);
      if (bus.flexible_data_rate) say("    data_bit_rate: {}", bus.data_bit_rate);
      say("    other_load: {}", bus.other_load);
      say("    messages:{}", bus.messages.empty() ? " []" : "");
      for (const model::CanMessage& message : bus.messages)
        say("      - {{pdu: {}, identifier: {}, sender: {}, shortest_period: {}}}",
            yaml_scalar(cluster_.pdu(message.pdu).name), message.identifier,
            yaml_scalar(cluster_.node(message.sender).name), duration_text(message.shortest_period));
    }
  }

  const model::Cluster& cluster_;
  std::vector<Parameter> parameters_;
  std::string text_;
};

}  // namespace

std::string cluster_yaml(const model::Cluster& cluster, const std::string& heading) {
  return Writer(cluster).write(heading);
}

}  // namespace ttf::schedules::exchange
