#include "cli/launch/external/duties_text.h"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "report/drawing/tables.h"

namespace ttf::cli::launch::external {
namespace {

using report::drawing::Table;
using schedules::model::Cluster;

std::string us(Duration d) { return fmt::format("{:.10g}", in_us(d)); }

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  return text;
}

// "64", or "64+12" for fragments.
std::string lengths_text(const std::vector<std::size_t>& lengths) { return fmt::format("{}", fmt::join(lengths, "+")); }

std::string carried(const Cluster& cluster, const SlotDuty& slot) {
  if (slot.pdu != kNoPdu) return fmt::format("{}, fragment {}", cluster.pdu(slot.pdu).name, slot.fragment);
  return slot.startup ? "status, sync, startup" : slot.sync ? "status, sync" : "status";
}

std::string slots_text(const Duties& duties, const DutyPlaces& places) {
  if (duties.slots.empty()) return "";
  Table table(
      {"slot", "cycles", "ch", "due\n[us]", "window\n[us]", "CAN\nid", "data\n[bytes]", "\nheader", "\ncarries"});
  for (const SlotDuty& slot : duties.slots)
    table.add({fmt::to_string(slot.slot), cycles_text(slot.base_cycle, slot.repetition),
               std::string(channels_text(slot.channels)), us(slot.due),
               fmt::format("{} to {}", us(slot.due - duties.window.early), us(slot.due + duties.window.late)),
               fmt::format("{:03X}", slot.slot), lengths_text(slot.can_lengths), hex(slot.header),
               carried(places.cluster, slot)});
  std::string on;
  for (std::size_t c = 0; c < places.bus.interfaces.size(); ++c)
    on += fmt::format("{}{} is channel {}", c == 0 ? "" : ", ", places.bus.interfaces[c], "AB"[c]);
  return fmt::format(
      "on FlexRay, from the begin of each cycle of {} us; the header's last six bits count the cycles;\n"
      "the payload is {} bytes; {}:\n{}",
      us(duties.cycle), duties.slots.front().payload_bytes, on, table.text());
}

std::string what_text(const Cluster& cluster, const CanDuty& can) {
  switch (can.kind) {
    case CanDutyKind::kList: return cluster.pdu(can.pdu).name;
    case CanDutyKind::kTrigger: return cluster.sensor(can.sensor).name + " trigger";
    case CanDutyKind::kStrobe: return cluster.sensor(can.sensor).name + " strobe";
  }
  return "";
}

std::string when_text(const Cluster& cluster, const CanDuty& can) {
  switch (can.kind) {
    case CanDutyKind::kList: return fmt::format("at least {} us apart", us(*can.shortest));
    case CanDutyKind::kTrigger:
      return can.at
                 ? fmt::format("{} us into cycles {}", us(can.due), cycles_text(can.at->base_cycle, can.at->repetition))
                 : fmt::format("at each end of {}", cluster.sensor(can.sensor).after);
    case CanDutyKind::kStrobe: return "at each measurement";
  }
  return "";
}

std::string cans_text(const Duties& duties, const DutyPlaces& places) {
  if (duties.cans.empty()) return "";
  Table table({"CAN", "interface", "id", "form", "data\n[bytes]", "\ncarries", "\nwhen"});
  for (const CanDuty& can : duties.cans)
    table.add({places.cluster.can_buses[can.can_bus].name, places.can_interfaces[can.can_bus],
               fmt::format("{:03X}", can.identifier), can.flexible_data_rate ? "FD" : "classic",
               fmt::to_string(can.length), what_text(places.cluster, can), when_text(places.cluster, can)});
  return "on private CANs, one frame for each fragment:\n" + table.text();
}

std::string reads_text(const Duties& duties, const DutyPlaces& places) {
  std::string text;
  for (const Reading& read : duties.reads)
    text += fmt::format("  {}{}{}\n", read.pdu == kNoPdu ? "" : places.cluster.pdu(read.pdu).name,
                        read.pdu == kNoPdu ? "" : ", ", read.from);
  return text.empty() ? "" : "it may read:\n" + text;
}

void add_signals(Table& table, const std::vector<schedules::model::Signal>& signals, int from) {
  for (const schedules::model::Signal& signal : signals)
    table.add({"  " + signal.name, fmt::to_string(from + signal.bit_offset), fmt::to_string(signal.bits),
               fmt::format("{:.7g}", signal.low), fmt::format("{:.10g}", signal.high),
               fmt::format("{:.10g}", signal.resolution), signal.unit});
}

std::string list_text(const schedules::model::PduLayout& layout) {
  Table table({layout.name, "bit", "bits", "low", "high", "resolution", "unit"});
  add_signals(table, layout.header, 0);
  add_signals(table, layout.element, layout.header_bits);
  return fmt::format("{}Elements begin at bit {}, {} bits each: {} to a fragment of {} bytes, {} to a list.\n",
                     table.text(), layout.header_bits, layout.element_bits, layout.elements_per_fragment,
                     layout.fragment_bytes, layout.max_elements);
}

nlohmann::ordered_json signals_json(const std::vector<schedules::model::Signal>& signals, int from) {
  auto list = nlohmann::ordered_json::array();
  for (const schedules::model::Signal& signal : signals)
    list.push_back({{"name", signal.name},
                    {"bit", from + signal.bit_offset},
                    {"bits", signal.bits},
                    {"low", signal.low},
                    {"high", signal.high},
                    {"resolution", signal.resolution},
                    {"unit", signal.unit}});
  return list;
}

nlohmann::ordered_json slot_json(const Cluster& cluster, const Duties& duties, const SlotDuty& slot) {
  nlohmann::ordered_json json{{"slot", slot.slot},
                              {"base_cycle", slot.base_cycle},
                              {"repetition", slot.repetition},
                              {"channels", channels_text(slot.channels)},
                              {"due_us", in_us(slot.due)},
                              {"earliest_us", in_us(slot.due - duties.window.early)},
                              {"latest_us", in_us(slot.due + duties.window.late)},
                              {"can_identifier", slot.slot},
                              {"can_lengths", slot.can_lengths},
                              {"payload_bytes", slot.payload_bytes},
                              {"header", hex(slot.header)},
                              {"sync", slot.sync},
                              {"startup", slot.startup}};
  if (slot.pdu == kNoPdu) return json;
  json["list"] = cluster.pdu(slot.pdu).name;
  json["fragment"] = slot.fragment;
  return json;
}

nlohmann::ordered_json can_json(const DutyPlaces& places, const CanDuty& can) {
  nlohmann::ordered_json json{{"can", places.cluster.can_buses[can.can_bus].name},
                              {"interface", places.can_interfaces[can.can_bus]},
                              {"identifier", can.identifier},
                              {"flexible_data_rate", can.flexible_data_rate},
                              {"length", can.length},
                              {"carries", what_text(places.cluster, can)}};
  if (can.shortest) json["shortest_period_us"] = in_us(*can.shortest);
  if (!can.at) return json;
  json["base_cycle"] = can.at->base_cycle;
  json["repetition"] = can.at->repetition;
  json["due_us"] = in_us(can.due);
  return json;
}

}  // namespace

std::string text_of(const Duties& duties, const DutyPlaces& places) {
  std::string text;
  const auto add = [&](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : "\n") + part;
  };
  add(slots_text(duties, places));
  add(cans_text(duties, places));
  add(reads_text(duties, places));
  for (const PduId list : duties.lists) add(list_text(places.cluster.pdu(list)));
  return fmt::format("{} is a real node. It must send\n\n{}", duties.node, text);
}

nlohmann::ordered_json json_of(const Duties& duties, const DutyPlaces& places) {
  auto slots = nlohmann::ordered_json::array(), cans = slots, reads = slots, lists = slots;
  for (const SlotDuty& slot : duties.slots) slots.push_back(slot_json(places.cluster, duties, slot));
  for (const CanDuty& can : duties.cans) cans.push_back(can_json(places, can));
  for (const Reading& read : duties.reads) {
    nlohmann::ordered_json one{{"from", read.from}};
    if (read.pdu != kNoPdu) one["list"] = places.cluster.pdu(read.pdu).name;
    reads.push_back(std::move(one));
  }
  for (const PduId list : duties.lists) {
    const schedules::model::PduLayout& layout = places.cluster.pdu(list);
    lists.push_back({{"name", layout.name},
                     {"fragment_bytes", layout.fragment_bytes},
                     {"max_elements", layout.max_elements},
                     {"elements_per_fragment", layout.elements_per_fragment},
                     {"element_bits", layout.element_bits},
                     {"header", signals_json(layout.header, 0)},
                     {"element", signals_json(layout.element, layout.header_bits)}});
  }
  return {{"cycle_us", in_us(duties.cycle)},
          {"window_us", {{"early", in_us(duties.window.early)}, {"late", in_us(duties.window.late)}}},
          {"slots", std::move(slots)},
          {"can_frames", std::move(cans)},
          {"reads", std::move(reads)},
          {"lists", std::move(lists)}};
}

}  // namespace ttf::cli::launch::external
