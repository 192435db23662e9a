// What a launch looks at before it starts anything: whether the bus is there, and if not, the commands that make it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::launch {

enum class BusKind : std::uint8_t { kDds, kSocketCan };

// --bus: "dds", or "socketcan:IF[,IF]": the interface of channel A, and of channel B.
struct Bus {
  BusKind kind = BusKind::kDds;
  std::vector<std::string> interfaces;   // of SocketCAN

  // Throws InputError naming --bus.
  static Bus parse(const std::string& text);
  std::string text() const;
};

// One thing that was looked at.
struct PreflightItem {
  std::string what;                    // "vcan0"
  bool good = true;
  std::string how;                     // "is not there"
  std::vector<std::string> commands;   // that mend it, to be given as root; none where none is known
};

// The interfaces that a bus runs over, as the kernel has them now.
std::vector<PreflightItem> look_at(const Bus& bus);

bool all_good(const std::vector<PreflightItem>& items);
// One line per item, its commands below it.
std::string text_of(const std::vector<PreflightItem>& items);
nlohmann::ordered_json json_of(const std::vector<PreflightItem>& items);

}  // namespace ttf::launch
