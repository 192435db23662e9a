// How the nodes of a launch are, as they say it themselves on their control lines, beside what the supervisor knows of
// their processes. One row per node, in the order of the cluster; every fact may be unknown ("-").
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ttf::cli::supervision {

// What a node says of itself, since it began.
struct NodeHealth {
  std::optional<std::uint64_t> missed_slots;  // own slots without a frame
  std::optional<std::uint64_t> late_wakeups;  // the task began after its instant by more than its allowance
  std::optional<double> lateness_p50_us;      // of all wake-ups
  std::optional<double> lateness_p99_us;
  std::optional<double> lateness_max_us;
  std::optional<double> sync_precision_us;  // largest deviation that clock synchronisation has seen
  // Frames that its medium lost on their way in or had no room to send, and those that had no room in its process: each
  // once. What is known by its gap alone is not among them: its sender may have withheld it.
  std::optional<std::uint64_t> drops;
  std::string state;  // in the node's own words: "normal active"
};

class HealthTable {
 public:
  explicit HealthTable(const std::vector<std::string>& nodes);

  // Takes what {"health": {...}} carries: any of missed_slots, late_wakeups, lateness_us {p50, p99, max},
  // sync_precision_us, drops, state; what is not given stays as it was. Nothing of the message is taken where anything
  // is wrong with it: then the answer says what. Keys that are not known are kept for the JSON form only.
  std::optional<std::string> update(std::size_t node, const nlohmann::json& health);

  // What the supervisor knows: "running", "exit 3", "restart 2 of 5 in 1 s".
  void set_process(std::size_t node, std::string state);
  // A new process has said nothing yet.
  void forget(std::size_t node);

  const NodeHealth& of(std::size_t node) const { return rows_[node].health; }
  bool anything_said() const;
  std::string text() const;
  nlohmann::ordered_json json() const;

 private:
  struct Row {
    std::string name;
    std::string process = "starting";
    NodeHealth health;
    nlohmann::json said = nlohmann::json::object();
  };
  std::vector<Row> rows_;
};

}  // namespace ttf::cli::supervision
