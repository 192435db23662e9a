// Reports the end of a node's drive in real time to its supervisor or its user.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/supervision/control.h"

namespace ttf::cli::node {

struct NodeEnding {
  nlohmann::ordered_json counts;  // counts_json()
  nlohmann::ordered_json health;  // the last one
  std::string failure;            // the reason of a failure; empty after success
};

// Sends a supervisor the last health, and "done" only after success. With `as_json` prints the result, failed
// or not, on standard output. Throws std::runtime_error with the failure.
void report_ending(const NodeEnding& ending, std::optional<supervision::ControlLine>& supervisor, bool as_json);

}  // namespace ttf::cli::node
