#include "schedules/exchange/fibex/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>
#include <vector>

#include "core/decimal.h"
#include "schedules/analysis/minislots.h"
#include "schedules/exchange/fibex/export_pdus.h"
#include "schedules/exchange/fibex/parameters.h"
#include "schedules/exchange/fibex/xml.h"
#include "schedules/model/round.h"

namespace ttf::schedules::exchange::fibex {
namespace {

std::string channel_id(model::Channel channel) { return fmt::format("channel_{}", letter(channel)); }
std::string controller_id(std::size_t ecu) { return fmt::format("controller_{}", ecu); }
std::string triggering_id(std::size_t frame, model::Channel channel) {
  return fmt::format("triggering_{}_{}", frame, letter(channel));
}

class Exporter {
 public:
  explicit Exporter(const model::Cluster& cluster) : cluster_(cluster) {
    std::size_t ecus = 0;
    for (const model::Node& node : cluster.nodes) ecu_.push_back(node.flexray ? ecus++ : 0);
  }

  std::string write() {
    pugi::xml_node declaration = document_.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    document_.append_child(pugi::node_comment)
        .set_value(
            " The FlexRay side of a ttfusion cluster. FIBEX has no place for its tasks, sensors and "
            "oscillators; its CANs are\n"
            "     not in this file. ");
    pugi::xml_node root = document_.append_child("fx:FIBEX");
    for (const XmlNamespace& one : kFibexNamespaces)
      root.append_attribute(fmt::format("xmlns:{}", one.prefix).c_str()) = std::string(one.name).c_str();
    root.append_attribute("VERSION") = "3.1.0";
    put_named(root, "fx:PROJECT", "project", cluster_.name);
    pugi::xml_node elements = root.append_child("fx:ELEMENTS");
    put_cluster(elements.append_child("fx:CLUSTERS"));
    put_channels(elements.append_child("fx:CHANNELS"));
    put_ecus(elements.append_child("fx:ECUS"));
    put_fibex_pdus(elements.append_child("fx:PDUS"), cluster_);
    put_frames(elements.append_child("fx:FRAMES"));
    put_fibex_signals(elements.append_child("fx:SIGNALS"), cluster_);
    put_fibex_codings(root.append_child("fx:PROCESSING-INFORMATION"), cluster_);
    std::ostringstream text;
    document_.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
    return text.str();
  }

 private:
  template <class Parameters>
  static void put_parameter(pugi::xml_node to, const FibexParameter& one, const Parameters& values) {
    put(to, one.element, fibex_value(values, one.name));
  }

  void put_cluster(pugi::xml_node clusters) {
    const model::GlobalParameters& g = cluster_.flexray;
    pugi::xml_node cluster = put_named(clusters, "fx:CLUSTER", "cluster", cluster_.name, "flexray:CLUSTER-TYPE");
    put(cluster, "fx:SPEED", fibex_value(g, "baudrate"));
    put(cluster, "fx:IS-HIGH-LOW-BIT-ORDER", "true");
    put(cluster, "fx:BIT-COUNTING-POLICY", "SAWTOOTH");
    put(cluster, "fx:PROTOCOL", "FlexRay").append_attribute("xsi:type") = "flexray:PROTOCOL-TYPE";
    put(cluster, "fx:PROTOCOL-VERSION", "2.1");
    pugi::xml_node channels = cluster.append_child("fx:CHANNEL-REFS");
    for (const model::Channel channel : model::kBothChannels)
      put_reference(channels, "fx:CHANNEL-REF", channel_id(channel));
    put(cluster, "fx:MEDIUM", "ELECTRICAL");
    pugi::xml_node extension = cluster.append_child("fx:MANUFACTURER-EXTENSION");
    for (const FibexParameter& one : kFibexExtension) put_parameter(extension, one, g);
    if (cycles_per_round(g) != model::kMostCycles) put_parameter(extension, kFibexRound[0], g);
    if (cluster_.topology == model::Topology::kStar) put(extension, "ttf:TOPOLOGY", "star");
    if (cluster_.guardian) put(extension, "ttf:GUARDIAN", "true");
    for (const FibexParameter& one : kFibexCluster) {
      put_parameter(cluster, one, g);
      // An eighth of a bit (cSamplesPerBit), in microseconds.
      if (one.name == "gdNIT") put(cluster, "flexray:SAMPLE-CLOCK-PERIOD", scaled_text(g.gdBit_ps / 8, 1'000'000));
      if (one.name == "gdTSSTransmitter") {
        pugi::xml_node wake_up = cluster.append_child("flexray:WAKE-UP");
        for (const FibexParameter& part : kFibexWakeUp) put_parameter(wake_up, part, g);
      }
    }
  }

  void put_channels(pugi::xml_node channels) {
    for (const model::Channel channel : model::kBothChannels) {
      pugi::xml_node one = put_named(channels, "fx:CHANNEL", channel_id(channel),
                                     fmt::format("Channel_{}", letter(channel)), "flexray:CHANNEL-TYPE");
      pugi::xml_node triggerings = one.append_child("fx:FRAME-TRIGGERINGS");
      for (std::size_t i = 0; i < cluster_.frames.size(); ++i)
        if (includes(cluster_.frames[i].channels, channel)) put_triggering(triggerings, i, channel);
      put(one, "flexray:FLEXRAY-CHANNEL-NAME", std::string(1, letter(channel)));
    }
  }

  void put_triggering(pugi::xml_node triggerings, std::size_t index, model::Channel channel) {
    const model::FrameSlot& frame = cluster_.frames[index];
    pugi::xml_node one = triggerings.append_child("fx:FRAME-TRIGGERING");
    one.append_attribute("ID") = triggering_id(index, channel).c_str();
    pugi::xml_node timing = one.append_child("fx:TIMINGS").append_child("fx:ABSOLUTELY-SCHEDULED-TIMING");
    const auto typed = [&](const char* name, int value, const char* type) {
      put(timing, name, std::to_string(value)).append_attribute("xsi:type") = type;
    };
    typed("fx:SLOT-ID", frame.slot, "flexray:SLOT-ID-TYPE");
    typed("fx:BASE-CYCLE", frame.base_cycle, "flexray:CYCLE-COUNTER-TYPE");
    typed("fx:CYCLE-REPETITION", frame.repetition, "flexray:CYCLE-REPETITION-TYPE");
    put_reference(one, "fx:FRAME-REF", frame_id(index));
  }

  void put_ecus(pugi::xml_node ecus) {
    for (std::size_t i = 0; i < cluster_.nodes.size(); ++i) {
      const model::Node& node = cluster_.nodes[i];
      if (!node.flexray) continue;
      pugi::xml_node ecu = put_named(ecus, "fx:ECU", fmt::format("ecu_{}", ecu_[i]), node.name);
      put_controller(ecu.append_child("fx:CONTROLLERS"), i);
      pugi::xml_node connectors = ecu.append_child("fx:CONNECTORS");
      for (const model::Channel channel : model::kBothChannels)
        if (includes(node.flexray->pChannels, channel)) put_connector(connectors, i, channel);
    }
  }

  void put_controller(pugi::xml_node controllers, std::size_t index) {
    const model::NodeParameters& p = *cluster_.nodes[index].flexray;
    pugi::xml_node one = put_named(controllers, "fx:CONTROLLER", controller_id(ecu_[index]),
                                   fmt::format("{}_controller", cluster_.nodes[index].name), "flexray:CONTROLLER-TYPE");
    const std::string key_slot = std::to_string(p.pKeySlotId);
    if (!p.pKeySlotUsedForSync) put(one.append_child("fx:MANUFACTURER-EXTENSION"), "ttf:KEY-SLOT-ID", key_slot);
    pugi::xml_node usage = one.append_child("flexray:KEY-SLOT-USAGE");
    if (p.pKeySlotUsedForSync)
      put(usage, p.pKeySlotUsedForStartup ? "flexray:STARTUP-SYNC" : "flexray:SYNC", key_slot);
    else
      usage.append_child("flexray:NONE");
    put(one, "flexray:MAX-DYNAMIC-PAYLOAD-LENGTH",
        std::to_string(analysis::longest_dynamic_words(cluster_, static_cast<NodeId>(index))));
    for (const FibexParameter& parameter : kFibexController) {
      put_parameter(one, parameter, p);
      if (parameter.name != "pdListenTimeout") continue;
      // pdListenTimeout = 2 (pMicroPerCycle + pdMaxDrift)
      const int drift = p.pdListenTimeout / 2 - p.pMicroPerCycle;
      if (drift >= kLeastMaxDrift && drift <= kMostMaxDrift) put(one, "flexray:MAX-DRIFT", std::to_string(drift));
    }
  }

  // Returns whether a task of the node reads the frame's list from FlexRay.
  bool receives(const model::Node& node, const model::FrameSlot& frame) const {
    if (frame.pdu == kNoPdu) return false;
    for (const model::Task& task : node.tasks)
      for (const model::PortBinding& port : task.reads)
        if (port.medium.is_flexray() && port.pdu == frame.pdu) return true;
    return false;
  }

  void put_connector(pugi::xml_node connectors, std::size_t index, model::Channel channel) {
    pugi::xml_node one = connectors.append_child("fx:CONNECTOR");
    one.append_attribute("ID") = fmt::format("connector_{}_{}", ecu_[index], letter(channel)).c_str();
    one.append_attribute("xsi:type") = "flexray:CONNECTOR-TYPE";
    put_reference(one, "fx:CHANNEL-REF", channel_id(channel));
    put_reference(one, "fx:CONTROLLER-REF", controller_id(ecu_[index]));
    const auto ports = [&](const char* list, const char* port, const char* id, auto&& wanted) {
      pugi::xml_node to;
      for (std::size_t i = 0; i < cluster_.frames.size(); ++i) {
        const model::FrameSlot& frame = cluster_.frames[i];
        if (!includes(frame.channels, channel) || !wanted(frame)) continue;
        if (!to) to = one.append_child(list);
        pugi::xml_node item = to.append_child(port);
        item.append_attribute("ID") = fmt::format("{}_{}_{}_{}", id, ecu_[index], i, letter(channel)).c_str();
        put_reference(item, "fx:FRAME-TRIGGERING-REF", triggering_id(i, channel));
        item.append_child("fx:COMPLETE-FRAME");
      }
    };
    ports("fx:INPUTS", "fx:INPUT-PORT", "input",
          [&](const model::FrameSlot& frame) { return receives(cluster_.nodes[index], frame); });
    ports("fx:OUTPUTS", "fx:OUTPUT-PORT", "output",
          [&](const model::FrameSlot& frame) { return index_of(frame.sender) == index; });
    put(one, "flexray:WAKE-UP-CHANNEL", channel == cluster_.nodes[index].flexray->pWakeupChannel ? "true" : "false");
  }

  void put_frames(pugi::xml_node frames) {
    for (std::size_t i = 0; i < cluster_.frames.size(); ++i) {
      const model::FrameSlot& frame = cluster_.frames[i];
      const bool status = frame.pdu == kNoPdu;
      const std::string what = status ? fmt::format("{}_status", cluster_.node(frame.sender).name)
                                      : fmt::format("{}_{}", cluster_.pdu(frame.pdu).name, frame.fragment);
      pugi::xml_node one = put_named(frames, "fx:FRAME", frame_id(i),
                                     fmt::format("{}_slot_{}_cycle_{}", what, frame.slot, frame.base_cycle));
      const int words = is_dynamic(cluster_.flexray, frame) ? analysis::dynamic_words(cluster_, frame)
                                                            : cluster_.flexray.gPayloadLengthStatic;
      put(one, "fx:BYTE-LENGTH", std::to_string(frame.payload_bytes > 0 ? frame.payload_bytes : 2 * words));
      put(one, "fx:FRAME-TYPE", status ? "OTHER" : "APPLICATION");
      if (status && !frame.network_management && !frame.message_id) continue;
      if (status) {
        pugi::xml_node extension = one.append_child("fx:MANUFACTURER-EXTENSION");
        if (frame.network_management) put(extension, "ttf:NETWORK-MANAGEMENT", "true");
        if (frame.message_id) put(extension, "ttf:MESSAGE-ID", std::to_string(*frame.message_id));
        continue;
      }
      pugi::xml_node instance = one.append_child("fx:PDU-INSTANCES").append_child("fx:PDU-INSTANCE");
      instance.append_attribute("ID") = fmt::format("pdu_instance_{}", i).c_str();
      put_reference(instance, "fx:PDU-REF", fibex_pdu_id(frame.pdu));
      put(instance, "fx:BIT-POSITION", std::to_string(8 * preamble_bytes(cluster_.flexray, frame)));
      put(instance, "fx:IS-HIGH-LOW-BYTE-ORDER", "false");
      pugi::xml_node extension = one.append_child("fx:MANUFACTURER-EXTENSION");
      put(extension, "ttf:FRAGMENT", std::to_string(frame.fragment));
      if (frame.network_management) put(extension, "ttf:NETWORK-MANAGEMENT", "true");
      if (frame.message_id) put(extension, "ttf:MESSAGE-ID", std::to_string(*frame.message_id));
    }
  }

  static std::string frame_id(std::size_t frame) { return fmt::format("frame_{}", frame); }

  const model::Cluster& cluster_;
  std::vector<std::size_t> ecu_;  // by node, among those on FlexRay: an import has no others
  pugi::xml_document document_;
};

}  // namespace

std::string fibex_text(const model::Cluster& cluster) { return Exporter(cluster).write(); }

}  // namespace ttf::schedules::exchange::fibex
