// `schedule synthesize --fibex`: a packing as the FIBEX file of a bus.
#pragma once

#include <string>

#include "cli/schedule/packing/signal_file.h"

namespace ttf::cli::schedule::packing {

struct BusFile {
  std::string text;
  std::string content;  // for say_written()
};

// Throws InputError if the packing makes no consistent bus: it does not fit the cycle, or breaks a rule of a cluster.
BusFile bus_file(const SignalFile& signals, const schedules::synthesis::packing::Assignment& assignment);

}  // namespace ttf::cli::schedule::packing
