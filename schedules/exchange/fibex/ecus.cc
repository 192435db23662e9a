// The ECUs of a FIBEX file: parameters of their controllers, and their inputs and outputs on the cluster's
// channels.
#include <set>

#include "schedules/exchange/fibex/file.h"
#include "schedules/exchange/fibex/parameters.h"

namespace ttf::schedules::exchange::fibex {
namespace {

// STARTUP-SYNC and SYNC contain the slot; for NONE it is in our own extension.
void read_key_slot(XmlElement& controller, FibexEcu& out, FibexReader& reader) {
  static constexpr FibexParameter kKeySlot[] = {
      {"pKeySlotId", "flexray:STARTUP-SYNC"}, {"pKeySlotId", "flexray:SYNC"}, {"pKeySlotId", "ttf:KEY-SLOT-ID"}};
  if (auto usage = controller.child("flexray:KEY-SLOT-USAGE")) {
    out.parameters.pKeySlotUsedForStartup = usage->has("flexray:STARTUP-SYNC");
    out.parameters.pKeySlotUsedForSync = usage->has("flexray:STARTUP-SYNC") || usage->has("flexray:SYNC");
    for (const char* flag : {"pKeySlotUsedForStartup", "pKeySlotUsedForSync"}) out.given.insert(flag);
    usage->ignore("flexray:NONE");
    reader.parameters(*usage, kKeySlot, out.parameters, out.given);
    usage->finish();
  }
  if (auto extension = controller.child("fx:MANUFACTURER-EXTENSION")) {
    reader.parameters(*extension, kKeySlot, out.parameters, out.given);
    extension->finish();
  }
}

void read_controller(XmlElement& controller, FibexEcu& out, FibexReader& reader) {
  out.has_controller = true;
  out.controller_line = controller.line();
  controller.ignore("ho:SHORT-NAME");
  read_key_slot(controller, out, reader);
  reader.parameters(controller, kFibexController, out.parameters, out.given);
  // Both follow from other parameters, if these are present.
  if (controller.has("flexray:MAX-DRIFT"))
    out.max_drift = reader.integer(controller, "flexray:MAX-DRIFT", kLeastMaxDrift, kMostMaxDrift);
  if (controller.has("flexray:MICRO-PER-MACRO-NOM"))
    out.micro_per_macro = reader.integer(controller, "flexray:MICRO-PER-MACRO-NOM", 20, 240);
  if (controller.has("flexray:MAX-DYNAMIC-PAYLOAD-LENGTH"))
    out.max_dynamic_words = reader.integer(controller, "flexray:MAX-DYNAMIC-PAYLOAD-LENGTH", 0, 127);
  controller.finish();
}

// Returns whether a connector belongs to the ECU's FlexRay controller on the cluster. A missing reference to a
// controller or channel counts as a match.
bool is_of_the_cluster(XmlElement& connector, const std::set<std::string>& controllers, const std::string& controller,
                       const ChannelIds& channels, FibexReader& reader) {
  const std::string of = connector.reference("fx:CONTROLLER-REF"), on = connector.reference("fx:CHANNEL-REF");
  if (!of.empty() && !controllers.contains(of)) {
    reader.fail(connector, of, "must have a CONTROLLER-REF to a controller of its ECU");
    return false;
  }
  if (!of.empty() && of != controller)
    reader.leave_out(connector, of, "belongs to another controller than the ECU's first on FlexRay, and is left out");
  else if (!on.empty() && !channels.contains(on))
    reader.leave_out(connector, on, "is on no channel of the first FlexRay cluster, and is left out");
  else
    return true;
  return false;
}

// A connector attaches a node to one channel. Without a channel it does not affect pChannels.
void read_attachment(XmlElement& connector, const ChannelIds& channels, unsigned& attached, FibexEcu& out,
                     FibexReader& reader) {
  const bool wakes = connector.has("flexray:WAKE-UP-CHANNEL");
  const bool wakeup = reader.boolean(connector, "flexray:WAKE-UP-CHANNEL", false);
  const std::string on = connector.reference("fx:CHANNEL-REF");
  const auto channel = channels.find(on);
  if (on.empty() || channel == channels.end()) return;
  attached |= 1u << static_cast<unsigned>(channel->second);
  if (!wakes) return;
  if (wakeup && out.given.contains("pWakeupChannel") && out.parameters.pWakeupChannel != channel->second)
    return reader.leave_out(connector, "flexray:WAKE-UP-CHANNEL true",
                            "is left out: a node sends its wake-up pattern on one channel");
  if (!wakeup) return;
  out.parameters.pWakeupChannel = channel->second;
  out.given.insert("pWakeupChannel");
}

FibexEcu read_ecu(XmlElement& ecu, const ChannelIds& channels, FibexReader& reader) {
  FibexEcu one;
  one.name = reader.name_of(ecu);
  one.line = ecu.line();
  std::set<std::string> controllers;  // by ID
  std::string used;
  for (XmlElement& controller : ecu.children_of("fx:CONTROLLERS", "fx:CONTROLLER")) {
    const std::string id = controller.attribute("ID");
    controllers.insert(id);
    if (one.has_controller || !reader.is_flexray(controller, "CONTROLLER-TYPE", "flexray:MICRO-PER-CYCLE"))
      reader.leave_out(controller, controller.attribute("ID"),
                       "is not the ECU's first FlexRay controller, and is left out");
    else
      read_controller(controller, one, reader);
    if (one.has_controller && used.empty()) used = id;
  }
  unsigned attached = 0;
  auto connectors = ecu.children_of("fx:CONNECTORS", "fx:CONNECTOR");
  bool elsewhere = !connectors.empty();
  for (XmlElement& connector : connectors) {
    if (!is_of_the_cluster(connector, controllers, used, channels, reader)) continue;
    elsewhere = false;
    read_attachment(connector, channels, attached, one, reader);
    const auto ports = [&](const char* list, const char* port, std::vector<std::string>& to) {
      for (XmlElement& item : connector.children_of(list, port)) {
        to.push_back(item.reference("fx:FRAME-TRIGGERING-REF"));
        item.ignore("fx:COMPLETE-FRAME");
        item.finish();
      }
    };
    ports("fx:INPUTS", "fx:INPUT-PORT", one.receives);
    ports("fx:OUTPUTS", "fx:OUTPUT-PORT", one.sends);
    connector.finish();
  }
  if (elsewhere) one.has_controller = false;  // on another cluster
  if (attached != 0) {
    one.parameters.pChannels = static_cast<model::Channels>(attached);
    one.given.insert("pChannels");
  }
  if (!one.given.contains("pWakeupChannel")) one.parameters.pWakeupChannel = default_wakeup(one.parameters.pChannels);
  ecu.finish();
  return one;
}

}  // namespace

std::vector<FibexEcu> read_ecus(XmlElement& elements, const ChannelIds& channels, FibexReader& reader) {
  std::vector<FibexEcu> ecus;
  for (XmlElement& ecu : elements.children_of("fx:ECUS", "fx:ECU")) ecus.push_back(read_ecu(ecu, channels, reader));
  return ecus;
}

}  // namespace ttf::schedules::exchange::fibex
