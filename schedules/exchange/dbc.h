// A cluster's private CANs as a DBC file, for the tools that decode CAN with one: cantools, SavvyCAN, CANdb++ and
// others.
//
// One message per CAN message of the cluster file, one frame of it being one fragment of a list; its length is the
// frame's, CAN FD's padding included. Signals are the list's header, then each element's with the element's place in
// the frame behind the name (x_0, y_0, x_1, ...); all unsigned and big-endian (Motorola), physical = offset + factor
// * raw. Receivers are the nodes with a task that reads the list from this CAN. What the format has no place for is
// in comments: fragments, and the shortest period; and in attributes: which CAN a message is on, and that it is a CAN
// FD frame.
//
// Two messages more per sensor, NAME_strobe and NAME_trigger on the CAN of its raw data, are its wires in real time
// (sensor_lines.h); those whose identifiers the cluster's messages have are left out.
//
// Identifier 0, if no CAN of the cluster uses it, is what has that identifier where the FlexRay channels are on CAN FD
// (docs/socketcan.md): symbols and follow-ups, told apart by a multiplexor. It is in files of all CANs only.
//
// The format has no public standard; what is written is its common core. Names are C identifiers there: other
// characters become '_', and a name that another has already gets a number.
#pragma once

#include <string>

#include "schedules/model/cluster.h"

namespace ttf::schedules::exchange {

// The same bytes for the same cluster. A DBC file has one message per identifier: without `can`, the name of one of
// its CANs, all of them are written, and two with messages of one identifier end in an InputError, as does a name
// that no CAN has.
std::string dbc_text(const model::Cluster& cluster, const std::string& can = "");

}  // namespace ttf::schedules::exchange
