#include "cli/node/node_ending.h"

#include <fmt/format.h>

#include <stdexcept>

namespace ttf::cli::node {

void report_ending(const NodeEnding& ending, std::optional<supervision::ControlLine>& supervisor, bool as_json) {
  const nlohmann::ordered_json json{{"counts", ending.counts}, {"real_time", ending.health}};
  if (supervisor) supervisor->health(ending.health);
  if (supervisor && ending.failure.empty()) supervisor->done(json);
  if (as_json) fmt::print("{}\n", json.dump(2));
  if (!ending.failure.empty()) throw std::runtime_error(ending.failure);
}

}  // namespace ttf::cli::node
