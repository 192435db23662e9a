// The places of signals on a bus that a FIBEX file describes, as a packing that stands. It reads what bus.h writes.
//
// A file's frames of the static segment have PDUs with signals; a frame without a PDU is passed over, as a key slot may
// be one. So are frames of the dynamic segment. A signal has its bits at the same place in every cycle of its series.
#pragma once

#include <string>
#include <vector>

#include "core/time.h"
#include "schedules/packing/check.h"

namespace ttf::schedules::packing::imported {

struct BusSignal {
  std::string name, node;
  int repetition = 1;  // in cycles
  int bits = 1;
  Assigned place;
  int line = 0;  // where its first bits stand in the file
};

struct BusSignals {
  Duration cycle;
  int payload_words = 0;  // in a static frame, 16 bits each
  int cycles = 0;         // in a round
  int cluster_line = 0;
  std::vector<BusSignal> signals;  // in the order of their lines
};

// Throws InputError with all mistakes, each with its line: those that the FIBEX reader finds, and content that a
// packing cannot have. This is a multiplexed PDU, a PDU without signals, a signal of unknown length or not contiguous
// from the most significant bit on, a frame without one sender, and a signal with several places or without a
// repetition of 1, 2, 4, ... cycles.
BusSignals parse_bus_signals(std::string text, std::string name);

}  // namespace ttf::schedules::packing::imported
