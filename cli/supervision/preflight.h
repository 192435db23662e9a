// What a launch looks at before it starts anything: whether the bus is there, and if not, the commands that make it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ttf::cli::supervision {

enum class BusKind : std::uint8_t { kDds, kSocketCan };

// --bus: "dds", or "socketcan:IF[,IF]": the interface of channel A, and of channel B.
struct Bus {
  BusKind kind = BusKind::kDds;
  std::vector<std::string> interfaces;  // of SocketCAN

  // Throws InputError naming --bus.
  static Bus parse(const std::string& text);
  std::string text() const;
};

// As the kernel takes it (dev_valid_name), and without the commas that --bus puts between two: 1..15 bytes, no '/', ':'
// or white space, and neither "." nor "..".
bool is_interface_name(std::string_view name);
inline constexpr const char* kInterfaceNames = "1..15 characters without white space, '/', ':' and ','";  // in words

// A CAN between sensors and hosts, on SocketCAN.
struct PrivateCan {
  std::string name;  // in the cluster file
  std::string interface;
  bool flexible_data_rate = false;  // it must carry CAN FD
};

// One thing that was looked at.
struct PreflightItem {
  std::string what;  // "vcan0"
  bool good = true;
  std::string how;                    // "is not there"
  std::vector<std::string> commands;  // that mend it, to be given as root; none where none is known
};

// The interfaces that a bus runs over, and on SocketCAN the private CANs', as the kernel has them now.
std::vector<PreflightItem> look_at(const Bus& bus, const std::vector<PrivateCan>& cans);

bool all_good(const std::vector<PreflightItem>& items);
// One line per item, its commands below it.
std::string text_of(const std::vector<PreflightItem>& items);
nlohmann::ordered_json json_of(const std::vector<PreflightItem>& items);

}  // namespace ttf::cli::supervision
