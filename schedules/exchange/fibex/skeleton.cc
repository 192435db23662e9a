// Writes a cluster file from imported FIBEX content, with open tasks in comments.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "schedules/exchange/fibex/import.h"
#include "schedules/exchange/fibex/parameters.h"
#include "schedules/file/parameter_table.h"

namespace ttf::schedules::exchange::fibex {
namespace {

constexpr const char* kAssumed = "assumed: FIBEX does not say";

std::string remark(std::string_view unit, bool assumed) {
  if (unit.empty() && !assumed) return "";
  return fmt::format("   # {}{}{}", unit, !unit.empty() && assumed ? ", " : "", assumed ? kAssumed : "");
}

// Writes a plain scalar if every YAML reader takes it for text, otherwise a quoted one.
std::string scalar(const std::string& text) {
  static const std::set<std::string> kMeaningful{"null",  "Null",  "NULL", "true", "True", "TRUE", "false",
                                                 "False", "FALSE", "yes",  "no",   "on",   "off"};
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto plain = [&](char c) { return letter(c) || c == '/' || (c >= '0' && c <= '9'); };
  if (!text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), plain) && kMeaningful.count(text) == 0)
    return text;
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += code < 0x20 ? fmt::format("\\x{:02x}", code) : std::string(1, c);
  }
  return quoted + '"';
}

// Keeps a comment on one line, whatever the names in the file contain.
std::string comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

std::string signal_text(const model::Signal& signal) {
  std::string text = fmt::format("{{name: {}", scalar(signal.name));
  if (!signal.unit.empty()) text += fmt::format(", unit: {}", scalar(signal.unit));
  text += fmt::format(", bits: {}", signal.bits);
  if (signal.low != 0.0) text += fmt::format(", low: {}", signal.low);
  const double top = signal.low + (std::ldexp(1.0, signal.bits) - 1.0) * signal.resolution;
  if (signal.high != top) text += fmt::format(", high: {}", signal.high);
  if (signal.resolution != 1.0) text += fmt::format(", resolution: {}", signal.resolution);
  return text + "}";
}

class Writer {
 public:
  explicit Writer(const FibexImport& import) : in_(import), cluster_(import.cluster) {}

  std::string write() {
    write_head();
    line(fmt::format("name: {}", scalar(cluster_.name)));
    line("synchronisation: true");
    if (cluster_.topology == model::Topology::kStar) line("topology: star");
    if (cluster_.guardian) line("guardian: true");
    line("");
    line("flexray:");
    const auto global = [&](std::string_view name, std::string_view unit) {
      const bool assumed = in_.assumed.count(fmt::format("flexray.{}", name)) != 0;
      line(fmt::format("  {}: {}{}", name, yaml_value(cluster_.flexray, name), remark(unit, assumed)));
    };
    for (const auto& p : file::kGlobalScaled) global(p.name, p.unit);
    for (const auto& p : file::kGlobalIntegers) global(p.name, "");
    write_nodes();
    write_pdus();
    line("\n# To be added: FIBEX knows no sensors.\nsensors: {}");
    write_frames();
    line("\n# To be added: only the FlexRay cluster is imported.\ncan: {}");
    return std::move(text_);
  }

 private:
  void line(const std::string& text) { text_ += text + '\n'; }

  void write_head() {
    line(comment(
        fmt::format("# From the FIBEX file {}: the timing of the cluster, its controllers, slots, PDUs and signals.",
                    cluster_.file)));
    line("# To be added before this cluster can run, as FIBEX does not have it: the tasks of each node with the lists");
    line(
        "# they read and write, sensors, CANs, oscillator drifts. Values marked as assumed are to be confirmed. Until");
    line("# then it can be checked as far as the bus goes, drawn, exported, and held against a capture.");
    if (in_.left_out.empty()) return;
    line("# Left out or changed:");
    for (const Finding& finding : in_.left_out) line(comment("#   " + finding.sentence()));
  }

  struct Value {
    std::string_view name;
    std::string text;
    bool assumed = false;
    std::string_view unit;
    bool operator==(const Value& other) const { return text == other.text && assumed == other.assumed; }
  };
  static std::string text_of(const Value& value) {
    return fmt::format("{}: {}{}", value.name, value.text, remark(value.unit, value.assumed));
  }
  std::vector<Value> values_of(const model::Node& node) const {
    std::vector<Value> values;
    const auto assumed = [&](std::string_view name) {
      return in_.assumed.count(fmt::format("nodes.{}.flexray.{}", node.name, name)) != 0;
    };
    const auto add = [&](std::string_view name, std::string_view unit = {}) {
      values.push_back({name, yaml_value(*node.flexray, name), assumed(name), unit});
    };
    values.push_back({"pChannels", std::string(channels_text(node.flexray->pChannels)), assumed("pChannels"), {}});
    values.push_back({"pWakeupChannel",
                      node.flexray->pWakeupChannel == model::Channel::kA ? "A" : "B",
                      assumed("pWakeupChannel"),
                      {}});
    for (const auto& p : file::kNodeScaled) add(p.name, p.unit);
    for (const auto& p : file::kNodeIntegers) add(p.name);
    for (const auto& p : file::kNodeFlags) add(p.name);
    return values;
  }

  // Writes values shared by all nodes only once.
  void write_nodes() {
    if (cluster_.nodes.empty()) {
      line("\nnode_parameters: {}\n\n# To be added: FIBEX names no controller on this cluster.\nnodes: {}");
      return;
    }
    std::vector<std::vector<Value>> values;
    for (const model::Node& node : cluster_.nodes) values.push_back(values_of(node));
    std::vector<bool> shared;
    std::string common;
    for (std::size_t i = 0; i < values[0].size(); ++i) {
      shared.push_back(
          std::all_of(values.begin(), values.end(), [&](const auto& of) { return of[i] == values[0][i]; }));
      if (shared[i]) common += "\n  " + text_of(values[0][i]);
    }
    line(fmt::format("\nnode_parameters:{}", common.empty() ? " {}" : common));
    line("\nnodes:");
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n) {
      line(fmt::format("  {}:", scalar(cluster_.nodes[n].name)));
      std::string own;
      for (std::size_t i = 0; i < shared.size(); ++i)
        if (!shared[i]) own += "\n      " + text_of(values[n][i]);
      line(fmt::format("    flexray:{}", own.empty() ? " {}" : own));
      line(fmt::format("    max_drift_ppm: 1500{}", remark("cClockDeviationMax", true)));
      std::string receives;
      for (const std::string& what : in_.receives[n]) receives += (receives.empty() ? "" : ", ") + what;
      if (!receives.empty()) line(comment(fmt::format("    # receives {}", receives)));
      line("    tasks: {}   # to be added");
    }
  }

  std::string pdu_named(const std::string& id) const {
    for (const ForeignPdu& foreign : in_.foreign)
      if (foreign.pdu.id == id) return foreign.pdu.name;
    return id;
  }

  void write_multiplexer(const FibexMultiplexer& multiplexer) {
    if (!multiplexer.static_pdu.empty()) line(comment("#   always: " + pdu_named(multiplexer.static_pdu)));
    for (const auto& [code, id] : multiplexer.layouts)
      line(comment(fmt::format("#   from bit {}, where the {} bits at bit {} are {}: {}", multiplexer.dynamic_position,
                               multiplexer.switch_bits, multiplexer.switch_position, code, pdu_named(id))));
  }

  void write_pdus() {
    line("");
    for (const ForeignPdu& foreign : in_.foreign) {
      line(comment(fmt::format("# {}: {} bytes, no list of a cluster file, for {}", foreign.pdu.name, foreign.pdu.bytes,
                               foreign.reason)));
      for (const FibexSignal& signal : foreign.pdu.signals)
        line(comment(fmt::format("#   bit {}, {} first: {}{}", signal.position,
                                 signal.high_low ? "high byte" : "low byte", signal_text(signal.meaning),
                                 signal.unlike.empty() ? "" : fmt::format(", but {}", signal.unlike))));
      if (foreign.pdu.multiplexer) write_multiplexer(*foreign.pdu.multiplexer);
    }
    line(cluster_.pdus.empty() ? "pdus: {}" : "pdus:");
    for (const model::PduLayout& pdu : cluster_.pdus) {
      line(fmt::format("  {}:", scalar(pdu.name)));
      line(fmt::format("    fragment_bytes: {}", pdu.fragment_bytes));
      line(fmt::format("    max_elements: {}", pdu.max_elements));
      line(fmt::format("    elements_per_fragment: {}", pdu.elements_per_fragment));
      line("    header:");
      for (const model::Signal& signal : pdu.header) line("      - " + signal_text(signal));
      line("    element:");
      for (const model::Signal& signal : pdu.element) line("      - " + signal_text(signal));
    }
  }

  void write_frames() {
    line(cluster_.frames.empty() ? "\nframes: []" : "\nframes:");
    for (std::size_t i = 0; i < cluster_.frames.size();) {
      const model::FrameSlot& first = cluster_.frames[i];
      std::size_t end = i + 1;
      while (end < cluster_.frames.size() && continues(cluster_.frames[end - 1], cluster_.frames[end])) ++end;
      std::string text = fmt::format("  - {{slot: {}, channels: {}, sender: {}, base_cycle: {}, repetition: {}",
                                     first.slot, channels_text(first.channels),
                                     scalar(cluster_.node(first.sender).name), first.base_cycle, first.repetition);
      if (first.pdu != kNoPdu) {
        text += fmt::format(", pdu: {}, fragments: {}", scalar(cluster_.pdu(first.pdu).name), end - i);
        if (first.fragment != 0) text += fmt::format(", first_fragment: {}", first.fragment);
      }
      if (first.payload_bytes > 0) text += fmt::format(", bytes: {}", first.payload_bytes);
      if (first.network_management) text += ", network_management: true";
      if (first.message_id) text += fmt::format(", message_id: {}", *first.message_id);
      text += "}";
      if (!in_.contents[i].empty()) text += comment("   # " + in_.contents[i]);
      line(text);
      i = end;
    }
  }

  const FibexImport& in_;
  const model::Cluster& cluster_;
  std::string text_;
};

}  // namespace

std::string skeleton_yaml(const FibexImport& import) { return Writer(import).write(); }

}  // namespace ttf::schedules::exchange::fibex
