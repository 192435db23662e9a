// The limits of a cluster. Loaders and imports enforce them, and other code relies on them.
#pragma once

#include <cstddef>

namespace ttf::schedules::model {

inline constexpr std::size_t kMostNamed = 200;  // nodes, sensors, PDUs: ids are bytes, with one value reserved
inline constexpr std::size_t kMostCans = 127;   // numbered by signed bytes (schedules/model/medium_id.h)
inline constexpr std::size_t kMostTasks = 16;   // of a node
inline constexpr int kLastStaticSlot = 1023;    // cStaticSlotIDMax
inline constexpr int kLastSlot = 2047;          // cSlotIDMax
inline constexpr int kMostFragments = 256;      // a fragment's number is a byte in records
inline constexpr int kMostFragmentBytes = 254;  // cPayloadLengthMax, in two-byte words: 127

// CAN bit rates in bit/s: ISO 11898-1 and -2.
inline constexpr int kSlowestCan = 10'000, kFastestNominal = 1'000'000, kFastestData = 8'000'000;

// Limits of a signal, in its own unit.
inline constexpr int kMostSignalBits = 32;
inline constexpr double kFinestResolution = 1e-9, kCoarsestResolution = 1e9;
inline constexpr double kLargestLow = 1e9, kLargestHigh = 1e10;  // magnitudes

}  // namespace ttf::schedules::model
