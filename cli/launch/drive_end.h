// Who was in operation when a launched drive ended, and who was not: a drive may go to its end, every process ending
// well, with nodes that never got into the cluster, or fell out of it and have not come back.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/supervision/supervisor.h"
#include "evaluation/cluster/startup_account.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch {

struct NodeAtEnd {
  std::string name;
  bool on_flexray = false;
  std::optional<supervision::Ending> ending;  // of its last process; nothing: it had none
  std::string state;                          // of its controller, the last that is known; off FlexRay nobody asks
};

struct DriveEnd {
  struct Absent {
    std::string name, state;  // or how its process ended, where that was not well
  };
  // Those whose process did not end well, and those on FlexRay that were not normal active. In the order given.
  std::vector<Absent> absent;
  bool nobody = false;  // of those on FlexRay was in operation

  // "a, b were not in operation at the end: integration listen"; empty where all were.
  std::string sentence() const;
  nlohmann::ordered_json json() const;
};
DriveEnd drive_end(const std::vector<NodeAtEnd>& nodes);

// What a virtual drive's records say, by node: who never changed its state is as it began. Empty off FlexRay.
std::vector<std::string> states_at_end(const schedules::model::Cluster& cluster, bool cold,
                                       const std::vector<evaluation::cluster::NodeStartup>& changes);

// Listens to what becomes of the processes.
class EndWatch {
 public:
  explicit EndWatch(std::size_t nodes) : endings_(nodes) {}

  supervision::Hooks around(supervision::Hooks hooks);  // which are called as ever; outlives them
  bool begun() const { return begun_; }                 // all were ready, or all that had to be
  // With the states of their controllers.
  std::vector<NodeAtEnd> nodes(const schedules::model::Cluster& cluster, const std::vector<std::string>& states) const;

 private:
  std::vector<std::optional<supervision::Ending>> endings_;
  bool begun_ = false;
};

}  // namespace ttf::cli::launch
