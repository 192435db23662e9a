// The health of a launch's nodes, from their messages on the control lines, beside the supervisor's view of
// their processes. One row per node, in the order of the cluster; unknown facts are "-".
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ttf::cli::supervision {

// A node's own report since its begin.
struct NodeHealth {
  std::optional<std::uint64_t> missed_slots;  // own slots without a frame
  std::optional<std::uint64_t> late_wakeups;  // the task began too late, beyond its allowance
  std::optional<double> lateness_p50_us;      // over all wake-ups
  std::optional<double> lateness_p99_us;
  std::optional<double> lateness_max_us;
  std::optional<double> sync_precision_us;  // the largest deviation in clock synchronisation
  // Frames lost or without room in its medium, and frames without room in its process; each counts once. A
  // mere gap does not count: its sender may have withheld the frame.
  std::optional<std::uint64_t> drops;
  std::string state;      // in the node's own words: "normal active"
  std::string can_state;  // the worst of its controllers on private CANs: "bus off"; empty before their first report
  bool is_active = true, is_can_active = true;  // by these words; true before the first ones
};

// The state of an external node (cli/supervision/supervisor.h), as the launch receives it.
struct ExternalHealth {
  bool received = false;  // at least once
  bool sending = false;   // now
  std::string words = "waiting";
  std::optional<std::uint64_t> missing;  // frames
};

class HealthTable {
 public:
  explicit HealthTable(const std::vector<std::string>& nodes);

  // Takes the facts of {"health": {...}}: any of missed_slots, late_wakeups, lateness_us {p50, p99, max},
  // sync_precision_us, drops, state, can_state. Missing facts keep their values. A message with an error is rejected
  // whole, and the error returned. Unknown keys appear only in the JSON form.
  std::optional<std::string> update(std::size_t node, const nlohmann::json& health);

  // Sets the supervisor's view: "running", "exit 3", "restart 2 of 5 in 1 s".
  void set_process(std::size_t node, std::string state);
  // Clears a node's facts for a new process, and counts it.
  void begin_process(std::size_t node);
  // A failed process has no state.
  void end_process(std::size_t node, std::string how, bool well);

  void set_external(std::size_t node, const ExternalHealth& health);

  const NodeHealth& of(std::size_t node) const { return rows_[node].health; }
  std::uint64_t restarts() const;  // the sum
  std::string text() const;
  // Returns "6 of 7 nodes up (gateway: integration listen)". An up node's process runs. Its controller, if it has one, is
  // normal active. An external node is up while it sends.
  std::string up() const;
  // Returns the table in one line: up(), then sums.
  std::string summary() const;
  nlohmann::ordered_json json() const;

 private:
  struct Row {
    std::string name;
    std::string process = "starting";
    std::uint64_t processes = 0;  // so far
    std::optional<bool> sending;  // an external node's
    NodeHealth health;
    nlohmann::json said = nlohmann::json::object();

    std::uint64_t restarts() const;
    bool up() const;
  };
  std::vector<Row> rows_;
};

}  // namespace ttf::cli::supervision
