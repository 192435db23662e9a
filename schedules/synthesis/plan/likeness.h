// Further sensors of a plan, said in a line each: plan.sensors.
//
//   NAME: {like: laser}                                 a sensor with all that its lists meet up to the fusion
//   NAME: {like: laser, kind: radar, raw: 32, objects: 12, preprocessing: 14 ms}
//
// The copy has a device and a host of its own, lists, CANs and slots, named alike: rear_laser's host is rear_laser_pre if the
// laser's is laser_pre. Where one task fuses the lists of several sensors it reads the new one's, too; else the copy has a
// task of its own there. The copy's host has the next free key slot, and is neither a sync nor a startup node. Its instants
// and slots are left out, and so is its repetition if that of the sensor is.
//
//   kind            another kind has that kind's steps and layouts (schedules/synthesis/plan/layouts.h)
//   raw, objects    most elements of the lists that the device and the host send
//   preprocessing   the longest execution of the host's task
#pragma once

#include <string>

#include "core/strict_yaml.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::plan {

// Adds the sensor to the plan, or findings.
void add_alike(const std::string& name, YamlMap& map, Plan& plan);

}  // namespace ttf::schedules::synthesis::plan
