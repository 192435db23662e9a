#include "cli/launch/external/duties_text.h"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <utility>

#include "bus/ports/live_medium.h"
#include "bus/wire/flexray_frame.h"
#include "cli/live_media/live_media.h"
#include "report/drawing/tables.h"

namespace ttf::cli::launch::external {
namespace {

using live_media::Carriage;
using report::drawing::Table;
using schedules::model::Cluster;

std::string us(Duration d) { return fmt::format("{:.10g}", in_us(d)); }

std::string hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  return text;
}

// The interface or topic of a channel, empty without one, and that of a private CAN.
std::string channel_place(const DutyPlaces& places, const Carriage* carriage, std::size_t channel) {
  const auto& all = carriage != nullptr ? carriage->places : places.bus.interfaces;
  return channel < all.size() ? all[channel] : "";
}
std::string can_place(const DutyPlaces& places, const Carriage* carriage, std::size_t can_bus) {
  return carriage != nullptr ? carriage->places[bus::ports::line_of_can(can_bus)] : places.can_interfaces[can_bus];
}

std::optional<Carriage> carriage_of(const Duties& duties, const DutyPlaces& places) {
  if (places.bus.medium->carriage == nullptr) return std::nullopt;
  return places.bus.medium->carriage(places.cluster, *places.cluster.find_node(duties.node), places.session);
}

// "64", or "64+12" for fragments.
std::string lengths_text(const std::vector<std::size_t>& lengths) { return fmt::format("{}", fmt::join(lengths, "+")); }

std::string carried(const Cluster& cluster, const SlotDuty& slot) {
  if (slot.pdu != kNoPdu) return fmt::format("{}, fragment {}", cluster.pdu(slot.pdu).name, slot.fragment);
  return slot.startup ? "status, sync, startup" : slot.sync ? "status, sync" : "status";
}

// The number of bytes of a whole frame: header, payload, frame CRC.
std::size_t frame_bytes(const SlotDuty& slot) {
  return bus::wire::kHeaderBytes + static_cast<std::size_t>(slot.payload_bytes) + bus::wire::kTrailerBytes;
}

std::string slots_text(const Duties& duties, const DutyPlaces& places, const Carriage* carriage) {
  if (duties.slots.empty()) return "";
  const auto row = [&](std::vector<std::string> cells, std::vector<std::string> on_medium, std::string header,
                       std::string carries) {
    for (std::string& cell : on_medium) cells.push_back(std::move(cell));
    cells.insert(cells.end(), {std::move(header), std::move(carries)});
    return cells;
  };
  const auto columns = carriage != nullptr ? std::vector<std::string>{"all\n[bytes]"}
                                           : std::vector<std::string>{"CAN\nid", "data\n[bytes]"};
  Table table(row({"slot", "cycles", "ch", "due\n[us]", "window\n[us]"}, columns, "\nheader", "\ncarries"));
  for (const SlotDuty& slot : duties.slots)
    table.add(row({fmt::to_string(slot.slot), cycles_text(slot.base_cycle, slot.repetition),
                   std::string(channels_text(slot.channels)), us(slot.due),
                   fmt::format("{} to {}", us(slot.due - duties.window.early), us(slot.due + duties.window.late))},
                  carriage != nullptr
                      ? std::vector<std::string>{fmt::to_string(frame_bytes(slot))}
                      : std::vector<std::string>{fmt::format("{:03X}", slot.slot), lengths_text(slot.can_lengths)},
                  hex(slot.header), carried(places.cluster, slot)));
  std::string on;
  for (std::size_t c = 0; c < 2; ++c)
    if (const std::string place = channel_place(places, carriage, c); !place.empty())
      on += fmt::format("{}{} is channel {}", on.empty() ? "" : ", ", place, "AB"[c]);
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

// A topic has the CAN's name in its own.
std::string cans_text(const Duties& duties, const DutyPlaces& places, const Carriage* carriage) {
  if (duties.cans.empty()) return "";
  std::vector<std::string> head{"id", "form", "data\n[bytes]", "\ncarries", "\nwhen"};
  if (carriage != nullptr)
    head.insert(head.begin(), "topic");
  else
    head.insert(head.begin(), {"CAN", "interface"});
  Table table(std::move(head));
  for (const CanDuty& can : duties.cans) {
    std::vector<std::string> row{fmt::format("{:03X}", can.identifier), can.flexible_data_rate ? "FD" : "classic",
                                 fmt::to_string(can.length), what_text(places.cluster, can),
                                 when_text(places.cluster, can)};
    row.insert(row.begin(), can_place(places, carriage, can.can_bus));
    if (carriage == nullptr) row.insert(row.begin(), places.cluster.can_buses[can.can_bus].name);
    table.add(std::move(row));
  }
  return "on private CANs, one frame for each fragment:\n" + table.text();
}

std::string carriage_text(const Carriage& carriage) {
  Table properties({"samples", ""}), fields({"field", "type", "in a frame of a slot", "on a private CAN"});
  for (const auto& [name, value] : carriage.properties) properties.add({name, value});
  for (const Carriage::Field& field : carriage.fields)
    fields.add({field.name, field.type, field.of_slot, field.on_can});
  return fmt::format("each frame is a sample:\n{}{}", properties.text(), fields.text());
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

nlohmann::ordered_json slot_json(const Cluster& cluster, const Duties& duties, const SlotDuty& slot,
                                 const Carriage* carriage) {
  nlohmann::ordered_json json{{"slot", slot.slot},
                              {"base_cycle", slot.base_cycle},
                              {"repetition", slot.repetition},
                              {"channels", channels_text(slot.channels)},
                              {"due_us", in_us(slot.due)},
                              {"earliest_us", in_us(slot.due - duties.window.early)},
                              {"latest_us", in_us(slot.due + duties.window.late)}};
  if (carriage == nullptr) json.update({{"can_identifier", slot.slot}, {"can_lengths", slot.can_lengths}});
  json.update({{"payload_bytes", slot.payload_bytes},
               {"header", hex(slot.header)},
               {"sync", slot.sync},
               {"startup", slot.startup}});
  if (slot.pdu == kNoPdu) return json;
  json["list"] = cluster.pdu(slot.pdu).name;
  json["fragment"] = slot.fragment;
  return json;
}

nlohmann::ordered_json can_json(const DutyPlaces& places, const CanDuty& can, const Carriage* carriage) {
  nlohmann::ordered_json json{{"can", places.cluster.can_buses[can.can_bus].name},
                              {carriage != nullptr ? "topic" : "interface", can_place(places, carriage, can.can_bus)},
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

nlohmann::ordered_json carriage_json(const Carriage& carriage) {
  nlohmann::ordered_json json{{"topics", carriage.places}};
  for (const auto& [name, value] : carriage.properties) json[name] = value;
  for (const Carriage::Field& field : carriage.fields)
    json["fields"].push_back(
        {{"name", field.name}, {"type", field.type}, {"of_slot", field.of_slot}, {"on_can", field.on_can}});
  return json;
}

}  // namespace

std::string text_of(const Duties& duties, const DutyPlaces& places) {
  const std::optional<Carriage> carriage = carriage_of(duties, places);
  const Carriage* const samples = carriage ? &*carriage : nullptr;
  std::string text;
  const auto add = [&](const std::string& part) {
    if (!part.empty()) text += (text.empty() ? "" : "\n") + part;
  };
  add(slots_text(duties, places, samples));
  add(cans_text(duties, places, samples));
  if (carriage) add(carriage_text(*carriage));
  add(reads_text(duties, places));
  for (const PduId list : duties.lists) add(list_text(places.cluster.pdu(list)));
  return fmt::format("{} is a real node. It must send\n\n{}", duties.node, text);
}

nlohmann::ordered_json json_of(const Duties& duties, const DutyPlaces& places) {
  const std::optional<Carriage> carriage = carriage_of(duties, places);
  const Carriage* const samples = carriage ? &*carriage : nullptr;
  auto slots = nlohmann::ordered_json::array(), cans = slots, reads = slots, lists = slots;
  for (const SlotDuty& slot : duties.slots) slots.push_back(slot_json(places.cluster, duties, slot, samples));
  for (const CanDuty& can : duties.cans) cans.push_back(can_json(places, can, samples));
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
  nlohmann::ordered_json json{
      {"cycle_us", in_us(duties.cycle)},
      {"window_us", {{"early", in_us(duties.window.early)}, {"late", in_us(duties.window.late)}}},
      {"slots", std::move(slots)},
      {"can_frames", std::move(cans)},
      {"reads", std::move(reads)},
      {"lists", std::move(lists)}};
  if (carriage) json["samples"] = carriage_json(*carriage);
  return json;
}

}  // namespace ttf::cli::launch::external
