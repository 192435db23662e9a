// `schedule synthesize --signals`: packs signals into frames of the static segment.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ttf::cli::schedule::packing {

struct PackingOptions {
  std::string signals;  // empty: not given
  std::vector<std::string> fixed;
  std::string fibex;
  std::string cycle = "5ms", payload = "32bit", channels = "one";
  int cycles = 64;
  bool slot_multiplexing = false;
  int first_slot = 1;
  std::optional<int> slots;
  int steps = 200;
  std::uint32_t seed = 1;
  int room_bits = 8;
};

// Adds --signals and the options that go with it alone.
void add_packing_options(CLI::App& command, PackingOptions& options);

// Writes the packing to `out` and the bus to `options.fibex`, if they are not empty, and sums it up. Returns 1 if a
// signal has no place, or if the slots do not suffice, in which case nothing is written.
int pack_signals(const PackingOptions& options, const std::string& out, bool json);

}  // namespace ttf::cli::schedule::packing
