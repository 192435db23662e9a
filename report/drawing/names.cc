#include "report/drawing/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>

#include "report/drawing/axes.h"

namespace ttf::report::drawing {
namespace {

std::string at(const std::vector<std::string>& list, std::size_t i, const char* what) {
  return i < list.size() && !list[i].empty() ? list[i] : fmt::format("{} {}", what, i);
}

std::string lower(std::string s) {
  std::ranges::transform(s, s.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return s;
}

// By the places of their words in recording/log/sensor_style.h.
constexpr std::array<std::string_view, recording::log::kSensorColours.size()> kColours{
    kVermilion, kBlue, kGreen, kOrange, kSkyBlue, kPurple, kGrey};
constexpr std::array<Marker, recording::log::kSensorMarkers.size()> kMarkers{
    Marker::kCross, Marker::kPlus, Marker::kTriangle, Marker::kDownTriangle, Marker::kDiamond};

// By SensorLook. Colours and markers take turns among the sensors of a look.
struct LookRow {
  std::array<std::string_view, 3> words;  // one of them is in the kind or the name
  std::array<std::string_view, 2> colours;
  std::array<Marker, 2> markers;
};
constexpr std::array<LookRow, static_cast<std::size_t>(SensorLook::kOther)> kSensorLooks{
    {{{"laser", "lidar", "lsc"}, {kVermilion, kOrange}, {Marker::kCross, Marker::kPlus}},
     {{"camera", "stereo", "scabor"}, {kBlue, kSkyBlue}, {Marker::kTriangle, Marker::kDownTriangle}},
     {{"radar"}, {kGreen, kOrange}, {Marker::kDiamond, Marker::kDiamond}}}};

const LookRow* row_of(SensorLook look) {
  return look == SensorLook::kOther ? nullptr : &kSensorLooks[static_cast<std::size_t>(look)];
}

// A word that a later version of the program wrote has no place here.
template <std::size_t kCount>
std::optional<std::size_t> place_of(std::string_view word, const std::array<std::string_view, kCount>& words) {
  const auto found = std::ranges::find(words, word);
  return found == words.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - words.begin()));
}

const recording::log::SensorStyle* style_of(const Names& names, SensorId sensor) {
  return index_of(sensor) < names.sensor_styles.size() ? &names.sensor_styles[index_of(sensor)] : nullptr;
}

// Returns the number of sensors of the same kind before this one.
std::size_t place_in_kind(const Names& names, SensorId sensor) {
  std::size_t before = 0;
  for (std::size_t s = 0; s < index_of(sensor); ++s)
    before += look_of(names, SensorId(s)) == look_of(names, sensor) ? 1u : 0u;
  return before;
}

// The two colours in turn, lighter with every turn.
std::string one_of_kind(const std::array<std::string_view, 2>& colours, std::size_t place) {
  return tint(colours[place % 2], std::min(0.3 * static_cast<double>(place / 2), 0.6));
}

}  // namespace

std::string Names::node(NodeId id) const { return at(nodes, index_of(id), "node"); }
std::string Names::pdu(PduId id) const { return id == kNoPdu ? "status" : at(pdus, index_of(id), "pdu"); }
std::string Names::sensor(SensorId id) const { return at(sensors, index_of(id), "sensor"); }
std::string Names::can_bus(std::size_t index) const { return at(can_buses, index, "CAN"); }

std::string Names::task(NodeId node, std::uint8_t task) const {
  return index_of(node) < tasks.size() ? at(tasks[index_of(node)], task, "task") : fmt::format("task {}", task);
}

SensorId Names::sensor_of(PduId id) const {
  if (id == kNoPdu) return kNoSensor;
  if (!pdu_sensors.empty()) return index_of(id) < pdu_sensors.size() ? pdu_sensors[index_of(id)] : kNoSensor;
  const std::string name = lower(pdu(id));
  for (std::size_t s = 0; s < sensors.size(); ++s)
    if (!sensors[s].empty() && name.find(lower(sensors[s])) != std::string::npos) return SensorId(s);
  return kNoSensor;
}

Names names_of(const schedules::model::Cluster& cluster) {
  Names names;
  for (const auto& node : cluster.nodes) {
    names.nodes.push_back(node.name);
    names.tasks.emplace_back();
    for (const auto& task : node.tasks) names.tasks.back().push_back(task.name);
  }
  for (const auto& pdu : cluster.pdus) {
    names.pdus.push_back(pdu.name);
    names.pdu_sensors.push_back(pdu.sensor);
  }
  for (const auto& sensor : cluster.sensors) names.sensors.push_back(sensor.name);
  for (const auto& bus : cluster.can_buses) names.can_buses.push_back(bus.name);
  names.cycles = cycles_per_round(cluster.flexray);
  return names;
}

Names names_of(const recording::log::LogManifest& manifest) {
  Names names;
  names.drive = fmt::format("{}, {}", manifest.scenario_name, manifest.strategy);
  names.nodes = manifest.node_names;
  names.tasks = manifest.task_names;
  names.pdus = manifest.pdu_names;
  names.sensors = manifest.sensor_names;
  names.can_buses = manifest.can_bus_names;
  names.pdu_sensors = manifest.pdu_sensors;
  names.sensor_styles = manifest.sensor_styles;
  names.cycles = manifest.cycles;
  return names;
}

SensorLook look_of(const Names& names, SensorId sensor) {
  const recording::log::SensorStyle* style = style_of(names, sensor);
  const std::string name = lower(style != nullptr && !style->kind.empty() ? style->kind : names.sensor(sensor));
  const auto is_there = [&](std::string_view word) { return !word.empty() && name.find(word) != std::string::npos; };
  const auto row =
      std::ranges::find_if(kSensorLooks, [&](const LookRow& one) { return std::ranges::any_of(one.words, is_there); });
  return static_cast<SensorLook>(row - kSensorLooks.begin());
}

std::string sensor_colour(const Names& names, SensorId sensor) {
  if (const recording::log::SensorStyle* style = style_of(names, sensor))
    if (const auto place = place_of(style->colour, recording::log::kSensorColours))
      return std::string(kColours[*place]);
  if (const LookRow* row = row_of(look_of(names, sensor)))
    return one_of_kind(row->colours, place_in_kind(names, sensor));
  const std::string others[] = {std::string(kPurple), std::string(kSkyBlue), std::string(kOrange)};
  return others[index_of(sensor) % 3];
}

Marker sensor_marker(const Names& names, SensorId sensor) {
  if (const recording::log::SensorStyle* style = style_of(names, sensor))
    if (const auto place = place_of(style->marker, recording::log::kSensorMarkers)) return kMarkers[*place];
  const LookRow* row = row_of(look_of(names, sensor));
  return row ? row->markers[place_in_kind(names, sensor) % 2] : Marker::kDownTriangle;
}

// A PDU without a sensor gets a colour that the sensors leave free.
std::string pdu_colour(const Names& names, PduId pdu) {
  if (pdu == kNoPdu) return std::string(kStatusFrame);
  if (const SensorId sensor = names.sensor_of(pdu); sensor != kNoSensor) return sensor_colour(names, sensor);
  constexpr std::array<std::string_view, 3> rest{kPurple, kSkyBlue, kOrange};
  std::size_t nth = 0;
  for (std::size_t p = 0; p < index_of(pdu); ++p) nth += names.sensor_of(PduId(p)) == kNoSensor ? 1u : 0u;
  return tint(rest[nth % rest.size()], nth >= rest.size() ? 0.4 : 0.0);
}

}  // namespace ttf::report::drawing
