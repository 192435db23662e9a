// Gathers places that stand, from files of either kind: CSV (standing_csv.cc) and FIBEX (standing_bus.cc).
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/schedule/packing/signal_file.h"

namespace ttf::cli::schedule::packing {

// A signal as a file of places has it. The texts are those of the file, for messages.
struct StandingSignal {
  std::string name, node, period_ms, bits, channel;  // channel: empty for the one that belongs to the use
  int line = 0;
};

class StandingGatherer {
 public:
  StandingGatherer(const SignalFile& signals, schedules::packing::ChannelUse use);

  // Begins a file: within one, a name occurs once.
  void begin(const std::string& file);
  // Returns the signal's index, or none: with a finding for a name that occurs twice, or for another node, period or
  // length than the signal file has; with a note for a signal that the signal file does not have.
  std::optional<std::size_t> find(const StandingSignal& signal, Findings& findings);
  // Keeps the place, which gets its channels from the signal. A further file may have the signal at the same place. A
  // signal that cannot meet its own window has no place, but a note.
  void place(std::size_t index, const StandingSignal& signal, schedules::packing::Assigned place, Findings& findings);
  // Numbers the bins by slot and channel. Throws InputError with the findings, or with the rules that the places break.
  StandingPlaces finish(Findings& findings);

 private:
  struct From {
    std::string file;
    int line = 0;
  };

  void note(const StandingSignal& signal, const std::string& why);
  bool keeps_its_kind(const StandingSignal& signal, std::size_t index, Findings& findings) const;
  std::optional<schedules::model::Channels> channels_of(const StandingSignal& signal, Findings& findings) const;

  const SignalFile& signals_;
  schedules::packing::ChannelUse use_;
  std::string file_;
  std::map<std::string, std::size_t> index_of_;
  std::set<std::string> names_;  // in this file
  std::vector<From> from_;
  schedules::packing::Assignment assignment_;
  std::vector<std::string> notes_;
};

// Read one file's text into the gatherer.
void gather_csv(const std::string& text, const std::string& name, StandingGatherer& standing, Findings& findings);
void gather_bus(std::string text, const std::string& name, const TableShape& shape, StandingGatherer& standing,
                Findings& findings);

}  // namespace ttf::cli::schedule::packing
