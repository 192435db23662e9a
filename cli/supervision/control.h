// The control line between a supervisor and a node's process: one JSON object per message, one message per packet.
//
//   node -> supervisor   {"ready": true}       the node is set up and waits for the start
//                        {"health": {...}}     its health, from time to time (cli/supervision/health_table.h)
//                        {"done": {...}}       the drive is over without a failure, with its result
//   supervisor -> node   {"start": {...}}      all nodes are ready: begin, with these facts
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

// The node's end. A process without a supervisor has no line.
class ControlLine {
 public:
  // Takes the descriptor from the environment and removes the variable; child processes do not inherit the
  // descriptor. Throws std::runtime_error if the variable names no descriptor of a control line.
  static std::optional<ControlLine> from_environment();
  explicit ControlLine(Descriptor line) : line_(std::move(line)) {}

  void ready();
  // Never waits: drops and counts messages that the supervisor has no room for.
  void health(const nlohmann::json& facts);
  void done(const nlohmann::json& facts);
  std::uint64_t dropped() const { return dropped_; }

  // Sleeps until the supervisor's start and returns its facts. No value: the supervisor is gone.
  std::optional<nlohmann::json> wait_for_start();

 private:
  void send(std::string_view key, const nlohmann::json& value, bool wait);

  Descriptor line_;
  std::uint64_t dropped_ = 0;
};

}  // namespace ttf::cli::supervision
