// Reads the signals that are to be packed from CSV (docs/schedules/packing.md lists the columns), and places that stand from CSV
// or FIBEX.
#pragma once

#include <string>
#include <vector>

#include "core/errors.h"
#include "core/time.h"
#include "schedules/packing/check.h"
#include "schedules/packing/instance.h"
#include "schedules/packing/slot_numbers.h"

namespace ttf::cli::schedule::packing {

// The times of a signal as they stand in the file.
struct SignalTimes {
  Duration period, release, deadline;
  int line = 0;
};

// The table that signals are packed into.
struct TableShape {
  Duration cycle = Duration::milliseconds(5);
  int payload_bits = 32;
  int cycles = schedules::packing::kMostCycles;
  bool shared_slots = false;
};

struct SignalFile {
  std::string name;
  TableShape shape;
  schedules::packing::Instance instance;  // nodes and variants in the order of the file
  std::vector<SignalTimes> times;         // by signal
  std::vector<Finding> impossible;        // the signals that no packing can have a place for
};

// Throws InputError with all mistakes of the file.
SignalFile read_signals(const std::string& path, const TableShape& shape);
SignalFile parse_signals(const std::string& text, const std::string& name, const TableShape& shape);

// Places that stand. Their bins are numbered from 0 without a gap.
struct StandingPlaces {
  schedules::packing::Places places;  // by signal of the signal file
  std::vector<schedules::packing::SlotNumber> numbers;
  std::vector<std::string> notes;  // places that are not kept, and why
};

// A text that begins with a tag is FIBEX. Several files may have the same signal, at one place. Both throw InputError
// with all mistakes: a signal that changed its node, period or length, places that break a rule, and a bus of another
// cycle or payload.
StandingPlaces read_standing(const std::vector<std::string>& paths, const SignalFile& signals,
                             schedules::packing::ChannelUse use);
StandingPlaces parse_standing(const std::string& text, const std::string& name, const SignalFile& signals,
                              schedules::packing::ChannelUse use);

// Returns the packing as a file that read_signals() and read_standing() take. It has a column for variants if the
// signals have them.
std::string packing_csv(const SignalFile& signals, const schedules::packing::Assignment& assignment);

}  // namespace ttf::cli::schedule::packing
