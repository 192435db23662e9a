// The names for a log's numbers, as pictures show them.
#pragma once

#include <string>
#include <vector>

#include "core/ids.h"
#include "recording/log/manifest.h"
#include "recording/log/sensor_style.h"
#include "report/drawing/svg.h"
#include "schedules/model/cluster.h"

namespace ttf::report::drawing {

// The index is the id's value (for tasks: node, then task). Ids beyond a list appear as numbers.
struct Names {
  std::string drive;  // for titles: "paper_scenario1, tt"
  std::vector<std::string> nodes, pdus, sensors, can_buses;
  std::vector<std::vector<std::string>> tasks;
  std::vector<recording::log::SensorStyle> sensor_styles;  // as the scenario says them
  // The sensor whose measurement each PDU's list descends from, kNoSensor if absent. If the vector is empty,
  // a PDU belongs to the sensor named within its own name.
  std::vector<SensorId> pdu_sensors;
  int cycles = schedules::model::kMostCycles;  // values of the cycle counter

  std::string node(NodeId id) const;
  std::string task(NodeId node, std::uint8_t task) const;
  std::string pdu(PduId id) const;
  std::string sensor(SensorId id) const;
  std::string can_bus(std::size_t index) const;
  SensorId sensor_of(PduId id) const;
};

Names names_of(const schedules::model::Cluster& cluster);
Names names_of(const recording::log::LogManifest& manifest);

// The kind of a sensor by its style, or else by its name, so that colours and markers stay the same in every picture.
enum class SensorLook : std::uint8_t { kLaser, kCamera, kRadar, kOther };
SensorLook look_of(const Names& names, SensorId sensor);
// Returns the colour or the marker of the sensor's style, or else that of its kind. The first laser is a vermilion
// cross, the first camera a blue triangle, the first radar a green diamond. Further ones of a kind differ from them.
// Other sensors take the rest of the palette by index.
std::string sensor_colour(const Names& names, SensorId sensor);
Marker sensor_marker(const Names& names, SensorId sensor);

// Returns the PDU's colour: its sensor's if it descends from one, grey for status frames.
std::string pdu_colour(const Names& names, PduId pdu);

}  // namespace ttf::report::drawing
