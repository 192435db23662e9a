// The control line between a supervisor and a node's process: one JSON object per message, one message per packet.
//
//   node -> supervisor   {"ready": true}       everything is set up; waiting for the start
//                        {"health": {...}}     how it goes, now and then (cli/supervision/health_table.h)
//                        {"done": {...}}       the drive is over, and nothing failed; what came of it
//   supervisor -> node   {"start": {...}}      all are ready: begin, as it says
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

inline constexpr std::string_view kControlVariable = "TTF_CONTROL_FD";
inline constexpr std::size_t kLongestMessage = 65'536;  // bytes

// The node's end. A process that nobody supervises has none.
class ControlLine {
 public:
  // The descriptor that the environment names, if it is one of a control line. It is taken out of the environment and
  // is not inherited further. Throws std::runtime_error where the variable is set but is no such descriptor.
  static std::optional<ControlLine> from_environment();
  explicit ControlLine(Descriptor line) : line_(std::move(line)) {}

  void ready();
  // Never waits: what the supervisor has no room for is dropped, and counted.
  void health(const nlohmann::json& facts);
  void done(const nlohmann::json& facts);
  std::uint64_t dropped() const { return dropped_; }

  // Sleeps until the supervisor says start; what it says. Nothing: the supervisor is gone.
  std::optional<nlohmann::json> wait_for_start();

 private:
  void send(std::string_view key, const nlohmann::json& value, bool wait);

  Descriptor line_;
  std::uint64_t dropped_ = 0;
};

}  // namespace ttf::cli::supervision
