// Reads a cluster file. Every parameter of the FlexRay specification is required, under its own name and within
// its range of annex B (2.1 Rev. A), unless others determine it (schedules/file/derive.h). So are instants, slots, periods and
// deadlines, unless they follow (schedules/file/fill_in.h). Unknown, missing, duplicate and out-of-range keys are findings, all
// reported at once.
//
//   extends: OTHER.yaml                         the keys that this file does not have (schedules/file/inherit.h); optional
//   name: paper_synchronised
//   synchronisation: true
//   topology: bus|star                          the wiring of the nodes; bus if absent
//   guardian: true                              the star has a guardian; false if absent
//   real_time: {early: 100 us, late: 400 us}    arrival window; absent: virtual time only (real_time_rules.h)
//   flexray: {gColdStartAttempts: 8, ...}       global parameters; times in us, gdMaxMicrotick in ns
//             pChannels (A, B or AB) and pWakeupChannel may be absent: AB, and A where the node is attached to it
//   node_parameters: {pSamplesPerMicrotick: 2, ...}   defaults for all nodes
//   pdus:   {NAME: {like, sensor, fragment_bytes, max_elements, elements_per_fragment, header: [...], element: [...]}}
//             of signals {name, unit, bits, low, high, resolution}, all but name and bits optional
//   sensors: {NAME: {like, raw, objects, preprocessing, ...}}   like another one, but for its own keys (likeness/inherit_alike.h);
//             without device and host both are copied (likeness/sensor_copy.h)
//         or {NAME: {kind: laser|camera|..., device, host, measurement: free, period, phase}}   phase is optional;
//             model/sensor_kind.h has the kinds
//         or {NAME: {kind, device, host, measurement: scheduled, base_cycle, repetition, offset}}
//         or {NAME: {kind, device, host, measurement: completion, after: TASK_OF_HOST,
//                    shortest_period, longest_period, phase}}
//   nodes:  {NAME: {flexray: {pKeySlotId: 1, ...}, drift_ppm, max_drift_ppm, tasks: {NAME: {...}}}}
//           off FlexRay `microtick` in ns instead of `flexray`; without drift_ppm it is drawn within max_drift_ppm
//   frames: [{slot, channels: A|B|AB, sender, base_cycle, repetition, pdu, fragments, first_fragment, fragment_step,
//             network_management}]
//   can:    {NAME: {flexible_data_rate, nominal_bit_rate, data_bit_rate, other_load, messages:
//            [{pdu, identifier, sender, shortest_period}]}}   data_bit_rate with flexible_data_rate only
//
// A task is {step, activation, best_case, worst_case, draw: uniform|worst, deadline, reads: {...}, writes:
// {...}}. Its activation is one of {kind: time, base_cycle, repetition, offset}, {kind: message, port}, {kind:
// sensor, sensor} and {kind: completion, after}. Ports are bound as `port: PDU on flexray` or `port: PDU on
// NAME_OF_A_CAN`. Times carry their unit (`2.5 ms`), offsets are macroticks. A frame entry with `fragments: n`
// stands for n consecutive slots, with the fragments from first_fragment (0 if absent) on. With `fragment_step:
// 2` they carry every other fragment, and an entry of the other channel carries those between. Without `pdu` it
// is a status frame. Slots above gNumberOfStaticSlots are dynamic. With `network_management: true` each frame
// begins with the network management vector.
//
// At most 200 nodes, sensors and PDUs, 127 CANs, 16 tasks per node and 256 fragments per list: records can
// number no more.
#pragma once

#include <string>

#include "core/strict_yaml.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// All throw InputError. The result is complete but not yet checked: schedules/check proves it consistent. A text must not
// extend a file.
model::Cluster load_cluster(const std::string& path);
model::Cluster parse_cluster(std::string text, std::string name);
model::Cluster read_cluster(const StrictYaml& file);

}  // namespace ttf::schedules::file
