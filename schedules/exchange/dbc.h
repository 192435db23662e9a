// Writes a cluster's private CANs as a DBC file, for tools that decode CAN: cantools, SavvyCAN, CANdb++ and
// others.
//
// Each CAN message of the cluster file is one message: one fragment of a list per frame, as long as the frame,
// with CAN FD's padding. Its signals are those of the list's header, then those of each element, with the
// element's index in the frame appended (x_0, y_0, x_1, ...). All are unsigned and big-endian (Motorola),
// physical = offset + factor * raw. Receivers are the nodes with a task that reads the list from this CAN.
// Comments hold the fragments and the shortest period; attributes hold the CAN of a message, and its CAN FD
// format.
//
// Each sensor adds two messages on the CAN of its raw data, NAME_strobe and NAME_trigger: its wires in real time
// (sensor_lines.h). A message whose identifier the cluster already uses is left out.
//
// Identifier 0, if unused by the cluster's CANs, describes frames on FlexRay channels over CAN FD
// (docs/media/socketcan.md): symbols and follow-ups, distinguished by a multiplexor. Only files of all CANs have it.
//
// The format has no public standard; this is its common core. Its names are C identifiers: other characters
// become '_', and a repeated name gets a number.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange {

// Returns the same bytes for the same cluster. `can` selects one of its CANs; empty selects all of them. Throws
// InputError for a name of no CAN, and for two messages with one identifier, which a DBC file cannot have.
std::string dbc_text(const model::Cluster& cluster, const std::string& can = "");

}  // namespace ttf::schedules::exchange
