// `schedule synthesize --fibex`: a packing as the FIBEX file of a bus, or of the bus of each variant of a vehicle.
#pragma once

#include <string>
#include <vector>

#include "cli/schedule/packing/signal_file.h"

namespace ttf::cli::schedule::packing {

struct BusFile {
  std::string path;
  std::string text;
  std::string content;  // for say_written()
};

// Returns the paths of the files: the given one, or with variants "bus_sport.xml" of "bus.xml" for each.
std::vector<std::string> bus_paths(const SignalFile& signals, const std::string& path);

// Returns the files. The buses of all variants have the same parameters and as many slots, and a node has the same key
// slot and the same role at startup in all. Throws InputError if the packing makes no consistent bus: it does not fit
// the cycle, or breaks a rule of a cluster.
std::vector<BusFile> bus_files(const SignalFile& signals, const schedules::packing::Assignment& assignment,
                               const std::string& path);

}  // namespace ttf::cli::schedule::packing
