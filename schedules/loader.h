// Reads a cluster file. Every parameter of the FlexRay specification is required, under its own name and within its
// range of annex B (2.1 Rev. A); unknown, missing, duplicate and out-of-range keys are findings, all reported at once.
//
//   name: paper_synchronised
//   synchronisation: true
//   flexray: {gColdStartAttempts: 8, ...}       global parameters; times in us, gdMaxMicrotick in ns
//   node_parameters: {pSamplesPerMicrotick: 2, ...}   what holds in every node that does not say otherwise
//   pdus:   {NAME: {sensor, fragment_bytes, max_elements, elements_per_fragment, header: [...], element: [...]}}
//   sensors: {NAME: {kind, device, host, measurement: free|scheduled, ...}}
//   nodes:  {NAME: {flexray: {pKeySlotId: 1, ...}, drift_ppm, max_drift_ppm, tasks: {NAME: {...}}}}
//   frames: [{slot, channels, sender, base_cycle, repetition, pdu, fragments}]
//   can:    {NAME: {flexible_data_rate, nominal_bit_rate, data_bit_rate, other_load, messages: [...]}}
//
// A frame entry with `fragments: n` stands for n consecutive slots with the fragments 0..n-1. Ports are bound as
// `port: PDU on flexray` or `port: PDU on NAME_OF_A_CAN`.
#pragma once

#include <string>

#include "schedules/cluster.h"

namespace ttf::schedules {

// Both throw InputError. The result is complete, but not yet proved consistent: that is check()'s part.
Cluster load_cluster(const std::string& path);
Cluster parse_cluster(std::string text, std::string name);

// Loads and checks (schedules/checker.h): throws InputError with the findings of either.
Cluster load_checked_cluster(const std::string& path);

}  // namespace ttf::schedules
