// Reads a plan: the keys of a cluster file (schedules/file/loader.h), of which these may be left out, and `plan`.
//
//   flexray           gdCycle and gMacroPerCycle with plan.cycle; gNumberOfStaticSlots, gdNIT, gOffsetCorrectionStart;
//                     gPayloadLengthStatic and gdStaticSlot with plan.payload
//   pdus              with plan.payload: fragment_bytes and elements_per_fragment of a list whose slots are left out
//   node_parameters   pMicroPerCycle, pRateCorrectionOut, pdListenTimeout, also in a node's own
//   sensors           base_cycle and offset of a scheduled one; its repetition with plan.rates
//   activation        base_cycle and offset of kind time; repetition
//   tasks             deadline
//   frames            slot and base_cycle of a list; repetition; channels (AB); fragments (all)
//   can               shortest_period of messages
//
// A list of one frame without a slot stands in its sender's key slot, if no other frame does.
//
//   plan:
//     cycle: {shortest: 5 ms, longest: 10 ms, step: 100 us}     lengths to choose from; instead of gdCycle
//     payload: {shortest: 32, longest: 96, step: 2}             of a static slot, in bytes; instead of gPayloadLengthStatic
//     rates: {SENSOR: {shortest: 34 ms, longest: 40 ms}}        allowed periods
//     sensors: {NAME: {like: SENSOR, ...}}                      further sensors (schedules/file/likeness/sensor_copy.h)
//     chains: {NAME: {from: SENSOR, to: NODE.TASK, largest_age: 60 ms}}   all sensors to their use, if absent
//     objective: [worst_age, data_age, slots, jitter, room, error, gap_error]   in this order; worst_age, if absent
//     error: {...}, gap_error: {...}                            for these objectives (plan/demands.h)
//     in_order: false                                           lists may wait for older ones; true if absent
//
// A plan may begin from another one by `extends: OTHER.yaml`, and change it key by key, as a cluster file may (schedules/file/inherit.h).
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::plan {

// Throws InputError with all findings, each with the file and line of the plan.
Plan load_plan(const std::string& path);
// The same from a text, which cannot extend a file.
Plan parse_plan(std::string text, std::string name);

// Asks a described file (StrictYaml::described()) for every key of a plan.
void ask_for_keys(const StrictYaml& described);

// Returns findings about the cluster of a plan with the files and lines that its values come from.
std::vector<Finding> in_the_files(const Plan& plan, std::vector<Finding> findings);

}  // namespace ttf::schedules::synthesis::plan
