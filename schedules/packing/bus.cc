#include "schedules/packing/bus.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "core/errors.h"
#include "schedules/analysis/parameter_bounds.h"
#include "schedules/check/checker.h"
#include "schedules/exchange/fibex/assumptions.h"
#include "schedules/exchange/fibex/export.h"
#include "schedules/exchange/fibex/export_pdus.h"

namespace ttf::schedules::packing {
namespace {

namespace fibex = exchange::fibex;

constexpr int kLeastNit = 20;                    // macroticks, for the offset correction
constexpr int kLongestNit = 805, kStarters = 3;  // specification 2.1A, annex B: gdNIT; three nodes survive one loss
constexpr int kAfterActionPoint = 15;            // macroticks of a minislot: more than precision and propagation delay
constexpr std::int64_t kNsPerMacrotick = 1000;

// Fills the cycle: static slots, then minislots if the network idle time would be too long.
void lay_out(model::GlobalParameters& g) {
  g.gdStaticSlot = static_cast<int>(analysis::shortest_static_slot(g));
  int rest = g.gMacroPerCycle - g.gdStaticSlot * g.gNumberOfStaticSlots;
  if (rest > kLongestNit) {
    g.gdMinislotActionPointOffset = g.gdActionPointOffset;  // so no macroticks are lost between the segments
    g.gdMinislot = g.gdMinislotActionPointOffset + kAfterActionPoint;
    g.gNumberOfMinislots = (rest - kLeastNit) / g.gdMinislot;
    rest -= g.gNumberOfMinislots * g.gdMinislot;
  }
  g.gdNIT = rest;
  g.gOffsetCorrectionStart = g.gMacroPerCycle - g.gdNIT + 1;
}

model::GlobalParameters parameters_of(const Instance& instance, int slots, const BusRequest& request) {
  model::GlobalParameters g;
  if (request.cycle.ns % kNsPerMacrotick != 0)
    throw InputError({request.file, 0, "cycle", fmt::format("{} ns", request.cycle.ns),
                      "must be a whole number of microseconds, the macroticks of the bus"});
  g.gMacroPerCycle = static_cast<int>(request.cycle.ns / kNsPerMacrotick);
  g.gdCycle_ps = g.cycle_ps();
  g.gPayloadLengthStatic = (instance.payload_bits + 15) / 16;
  g.gNumberOfStaticSlots = std::max(2, slots);
  lay_out(g);
  if (g.gdNIT < kLeastNit)
    throw InputError({request.file, 0, "slots", std::to_string(slots),
                      fmt::format("must fit the cycle of {} macroticks: each needs {}, and the idle time {}",
                                  g.gMacroPerCycle, g.gdStaticSlot, kLeastNit)});
  g.gdMaxMicrotick_ps = 25'000;
  return g;
}

class FibexWriter {
 public:
  FibexWriter(const Instance& instance, const Assignment& assignment, const std::vector<PackedFrame>& frames)
      : instance_(instance), assignment_(assignment), frames_(frames) {}

  std::string write(const model::Cluster& bus) {
    pugi::xml_document document;
    document.load_string(fibex::fibex_text(bus).c_str(), pugi::parse_full);
    pugi::xml_node root = document.child("fx:FIBEX"), elements = root.child("fx:ELEMENTS");
    std::size_t index = 0;
    for (pugi::xml_node frame : elements.child("fx:FRAMES").children("fx:FRAME")) fill(frame, elements, index++);
    pugi::xml_node codings = root.child("fx:PROCESSING-INFORMATION").child("fx:CODINGS");
    std::set<int> lengths;
    for (std::size_t i = 0; i < assignment_.size(); ++i) {
      if (!assignment_[i]) continue;
      const int bits = instance_.signals[i].bits;
      fibex::put_reference(
          fibex::put_named(elements.child("fx:SIGNALS"), "fx:SIGNAL", signal_id(i), instance_.signals[i].name),
          "fx:CODING-REF", coding_id(bits));
      if (lengths.insert(bits).second) put_coding(codings, bits);
    }
    std::ostringstream text;
    document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
    return text.str();
  }

 private:
  static std::string signal_id(std::size_t signal) { return fmt::format("signal_{}", signal); }
  static std::string coding_id(int bits) { return fmt::format("coding_{}", bits); }

  // Gives a frame its name, and the PDU with its signals.
  void fill(pugi::xml_node frame, pugi::xml_node elements, std::size_t index) {
    const PackedFrame& packed = frames_[index];
    const std::string name =
        fmt::format("slot_{}_cycle_{}_of_{}", packed.number.slot, packed.base_cycle, packed.repetition);
    frame.child("ho:SHORT-NAME").text().set(name.c_str());
    if (packed.signals.empty()) return;
    frame.child("fx:FRAME-TYPE").text().set("APPLICATION");
    const std::string id = fmt::format("pdu_{}", index);
    pugi::xml_node instance = frame.append_child("fx:PDU-INSTANCES").append_child("fx:PDU-INSTANCE");
    instance.append_attribute("ID") = fmt::format("pdu_instance_{}", index).c_str();
    fibex::put_reference(instance, "fx:PDU-REF", id);
    fibex::put(instance, "fx:BIT-POSITION", "0");
    fibex::put(instance, "fx:IS-HIGH-LOW-BYTE-ORDER", "false");
    pugi::xml_node pdu = fibex::put_named(elements.child("fx:PDUS"), "fx:PDU", id, name);
    fibex::put(pdu, "fx:BYTE-LENGTH", std::to_string((instance_.payload_bits + 7) / 8));
    fibex::put(pdu, "fx:PDU-TYPE", "APPLICATION");
    pugi::xml_node signals = pdu.append_child("fx:SIGNAL-INSTANCES");
    for (const std::size_t signal : packed.signals) {
      pugi::xml_node one = signals.append_child("fx:SIGNAL-INSTANCE");
      one.append_attribute("ID") = fmt::format("instance_{}_{}", index, signal).c_str();
      const int offset = assignment_[signal]->offset;  // sawtooth counting, most significant bit first
      fibex::put(one, "fx:BIT-POSITION", std::to_string(offset / 8 * 8 + 7 - offset % 8));
      fibex::put(one, "fx:IS-HIGH-LOW-BYTE-ORDER", "true");
      fibex::put_reference(one, "fx:SIGNAL-REF", signal_id(signal));
    }
  }

  // The raw bits are the value.
  static void put_coding(pugi::xml_node codings, int bits) {
    pugi::xml_node coding = fibex::put_named(codings, "fx:CODING", coding_id(bits), fmt::format("raw_{}", bits));
    pugi::xml_node type = coding.append_child("ho:CODED-TYPE");
    type.append_attribute("ho:BASE-DATA-TYPE") = bits <= 8    ? "A_UINT8"
                                                 : bits <= 16 ? "A_UINT16"
                                                 : bits <= 32 ? "A_UINT32"
                                                              : "A_BYTEFIELD";
    type.append_attribute("CATEGORY") = "STANDARD-LENGTH-TYPE";
    type.append_attribute("ENCODING") = "UNSIGNED";
    fibex::put(type, "ho:BIT-LENGTH", std::to_string(bits));
  }

  const Instance& instance_;
  const Assignment& assignment_;
  const std::vector<PackedFrame>& frames_;
};

}  // namespace

std::set<int> starters_of(const std::vector<std::vector<PackedFrame>>& vehicles) {
  std::map<int, std::vector<std::size_t>> vehicles_of;  // by node
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    std::set<int> nodes;
    for (const PackedFrame& frame : vehicles[i]) nodes.insert(frame.node);
    for (const int node : nodes) vehicles_of[node].push_back(i);
  }
  std::vector<int> order;
  for (const auto& [node, of] : vehicles_of) order.push_back(node);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return vehicles_of[a].size() > vehicles_of[b].size(); });
  std::set<int> starters;
  std::vector<int> in_vehicle(vehicles.size());
  for (const int node : order) {
    const auto& own = vehicles_of[node];
    if (std::all_of(own.begin(), own.end(), [&](std::size_t i) { return in_vehicle[i] >= kStarters; })) continue;
    starters.insert(node);
    for (const std::size_t i : own) ++in_vehicle[i];
  }
  return starters;
}

model::Cluster bus_of(const Instance& instance, const std::vector<PackedFrame>& frames, const BusRequest& request) {
  model::Cluster bus;
  bus.name = request.name;
  bus.file = request.file;
  int slots = request.slots;
  std::map<int, NodeId> ids;  // the nodes with frames, in the order of the instance
  for (const PackedFrame& frame : frames) {
    slots = std::max(slots, frame.number.slot);
    ids.emplace(frame.node, NodeId{});
  }
  bus.flexray = parameters_of(instance, slots, request);
  const std::set<int> starters = request.starters.empty() ? starters_of({frames}) : request.starters;
  const model::Channels channels = frames.empty() ? model::Channels::kA : frames.front().number.channels;
  for (auto& [node, id] : ids) {
    id = static_cast<NodeId>(bus.nodes.size());
    fibex::FibexEcu ecu;
    ecu.name = instance.nodes[static_cast<std::size_t>(node)];
    ecu.parameters.pChannels = channels;
    ecu.parameters.pWakeupChannel = default_wakeup(channels);
    ecu.parameters.pKeySlotUsedForStartup = ecu.parameters.pKeySlotUsedForSync = starters.contains(node);
    std::set<std::string, std::less<>> assumed;
    model::Node& added = bus.nodes.emplace_back();
    added.name = ecu.name;
    const auto common = request.key_slots.find(node);
    const int own_slot = common != request.key_slots.end() ? common->second : key_slot(frames, node).value();
    added.flexray = fibex::assume_local(ecu, bus.flexray, own_slot, assumed);
    added.microtick_ps = added.flexray->pdMicrotick_ps;
  }
  for (const PackedFrame& frame : frames)
    bus.frames.push_back({frame.number.slot, frame.number.channels, frame.base_cycle, frame.repetition,
                          ids.at(frame.node), kNoPdu, 0, 0});
  return bus;
}

std::string bus_fibex(const Instance& instance, const Assignment& assignment, const std::vector<PackedFrame>& frames,
                      const model::Cluster& bus) {
  return FibexWriter(instance, assignment, frames).write(bus);
}

}  // namespace ttf::schedules::packing
