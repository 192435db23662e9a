// How a node's run in real time ended, told to whoever started it.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/supervision/control.h"

namespace ttf::cli::node {

struct NodeEnding {
  nlohmann::ordered_json counts;  // counts_json()
  nlohmann::ordered_json health;  // the last
  std::string failure;            // why the run failed; empty: it did not
};

// A supervisor is told the last health; that the node is done, only if it is. With `as_json` what came of it, failed
// or not, is printed on standard output. Throws std::runtime_error with the failure.
void tell_ending(const NodeEnding& ending, std::optional<supervision::ControlLine>& supervisor, bool as_json);

}  // namespace ttf::cli::node
