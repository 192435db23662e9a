// The names that a log's numbers stand for, as pictures show them.
#pragma once

#include <string>
#include <vector>

#include "core/ids.h"
#include "recording/log/manifest.h"
#include "schedules/model/cluster.h"

namespace ttf::report::drawing {

// Index = the id's value (tasks: node, then task). Pictures of ids beyond a list show the number.
struct Names {
  std::string run;  // which drive, for titles: "paper_scenario1, tt"
  std::vector<std::string> nodes, pdus, sensors, can_buses;
  std::vector<std::vector<std::string>> tasks;
  // Per PDU the sensor whose measurement the list descends from, kNoSensor for none. May be left empty: then
  // a PDU belongs to the sensor whose name its own name contains.
  std::vector<SensorId> pdu_sensors;

  std::string node(NodeId id) const;
  std::string task(NodeId node, std::uint8_t task) const;
  std::string pdu(PduId id) const;
  std::string sensor(SensorId id) const;
  std::string can_bus(std::size_t index) const;
  SensorId sensor_of(PduId id) const;
};

Names names_of(const schedules::model::Cluster& cluster);
Names names_of(const recording::log::LogManifest& manifest);

// What a sensor's name says about its kind, for colours and markers that stay the same in every picture.
enum class SensorLook : std::uint8_t { kLaser, kCamera, kRadar, kOther };
SensorLook look_of(const std::string& sensor_name);
// Laser vermilion, camera blue, radar green; others from the rest of the palette by index.
std::string sensor_colour(const Names& names, SensorId sensor);

// Of a PDU: its sensor's colour if it descends from one; grey for status frames.
std::string pdu_colour(const Names& names, PduId pdu);

}  // namespace ttf::report::drawing
