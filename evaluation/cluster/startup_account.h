// The account of start-up, node by node, from a drive's records alone. It has the instants at which a node was
// powered on and became active, the cycle of the latter, and the reason for its present state.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"

namespace ttf::evaluation::cluster {

struct NodeStartup {
  NodeId node{};
  std::optional<TrueTime> powered;  // for the first time
  struct Active {
    TrueTime at{};
    std::int64_t cycle = 0;  // begins then, by the node's own count
    std::string from, why;   // the state before, and why it was left
  };
  std::optional<Active> active;  // for the first time
  // The present state, and the reason of the change to it.
  std::string state, why;
};

class StartupAccount final : public recording::records::Sink {
 public:
  // `cycle`: nominal length of the communication cycle.
  explicit StartupAccount(Duration cycle) : cycle_(cycle) {}

  // Returns nodes that were powered on or changed their state, by id; empty for a drive without a fault that
  // began integrated.
  std::vector<NodeStartup> nodes() const;

  using recording::records::Sink::on;
  void on(const recording::records::PowerChanged&) override;
  void on(const recording::records::StateChanged&) override;

 private:
  NodeStartup& of(NodeId node);

  Duration cycle_;
  std::map<NodeId, NodeStartup> nodes_;
};

}  // namespace ttf::evaluation::cluster
