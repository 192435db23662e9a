// Small strongly typed identifiers. Each indexes a list of its cluster or scenario, in file order. It is
// therefore the same in every process and every drive of the same files.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace ttf {

enum class NodeId : std::uint8_t {};     // index in Cluster::nodes
enum class PduId : std::uint8_t {};      // index in Cluster::pdus
enum class SensorId : std::uint8_t {};   // index in Cluster::sensors
enum class ObjectId : std::uint16_t {};  // index in the world's objects; truth, never on a bus
enum class TrackId : std::uint16_t {};   // given when a track is first confirmed (fusion/tracks/identities.h)

inline constexpr NodeId kNoNode{0xff};
inline constexpr PduId kNoPdu{0xff};
inline constexpr SensorId kNoSensor{0xff};
inline constexpr TrackId kNoTrack{0xffff};

// Identifies one measurement: the sequence-th of its sensor, counted from 0. Every list derived from it (raw
// data, observations) carries the same sequence number.
struct MeasurementId {
  SensorId sensor{};
  std::uint32_t sequence = 0;
  constexpr auto operator<=>(const MeasurementId&) const = default;
};

template <class Id> constexpr std::size_t index_of(Id id) { return static_cast<std::size_t>(id); }

}  // namespace ttf
