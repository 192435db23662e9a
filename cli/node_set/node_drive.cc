#include "cli/node_set/node_drive.h"

#include <stdexcept>
#include <utility>

#include "sim/processes/turn_taking.h"

namespace ttf::cli::node_set {
namespace {

using nodes::host::ExecutiveCounts;
constexpr std::pair<const char*, std::uint64_t ExecutiveCounts::*> kCounts[] = {
    {"overruns", &ExecutiveCounts::overruns},
    {"deadlines_missed", &ExecutiveCounts::deadlines_missed},
    {"torn_lists", &ExecutiveCounts::torn_lists},
    {"overwritten_lists", &ExecutiveCounts::overwritten_lists},
    {"discarded_lists", &ExecutiveCounts::discarded_lists},
    {"slot_problems", &ExecutiveCounts::slot_problems},
    {"saturated_signals", &ExecutiveCounts::saturated_signals},
    {"refused_fragments", &ExecutiveCounts::refused_fragments},
    {"refused_can_frames", &ExecutiveCounts::refused_can_frames},
    {"unlisted_fates", &ExecutiveCounts::unlisted_fates},
};
static_assert(sizeof(ExecutiveCounts) == std::size(kCounts) * sizeof(std::uint64_t), "every count is told");

}  // namespace

sim::drives::DriveOutcome run_node_drive(const NodeDrive& drive, bus::ports::Exchange& exchange) {
  const auto log = drive::begin_log(
      drive.log_path,
      manifest_of(*drive.scenario, *drive.cluster, drive.strategy, drive.seed, *drive.recording, drive.steps),
      *drive.scenario, *drive.cluster);
  sim::processes::TurnTaking others(*drive.cluster, drive.node, exchange);
  sim::drives::DriveConfig config{drive.scenario,        drive.cluster, drive.strategy, drive.seed, 0,
                                  drive.recording->rows, &others};
  config.steps = drive.steps;
  sim::drives::DriveOutcome outcome = sim::drives::run_drive(config, *log);
  log->close();
  return outcome;
}

nlohmann::ordered_json counts_json(const ExecutiveCounts& counts) {
  nlohmann::ordered_json json;
  for (const auto& [name, member] : kCounts) json[name] = counts.*member;
  return json;
}

void add_counts(ExecutiveCounts& sum, const nlohmann::json& one) {
  try {
    for (const auto& [name, member] : kCounts) sum.*member += one.at(name).get<std::uint64_t>();
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("a node sent invalid counts: ") + error.what());
  }
}

nlohmann::ordered_json outcome_json(const sim::drives::DriveOutcome& outcome) {
  nlohmann::ordered_json json{{"counts", counts_json(outcome.counts)}};
  json["flexray_load"] = outcome.flexray_load;
  json["can_load"] = outcome.can_load;
  json["frames_sent"] = outcome.frames_sent;
  return json;
}

void add_outcome(sim::drives::DriveOutcome& sum, const nlohmann::json& one) {
  try {
    add_counts(sum.counts, one.at("counts"));
    sum.flexray_load = one.at("flexray_load").get<double>();
    sum.can_load = one.at("can_load").get<std::vector<double>>();
    sum.frames_sent = one.at("frames_sent").get<std::uint64_t>();
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(std::string("a node sent an invalid outcome: ") + error.what());
  }
}

}  // namespace ttf::cli::node_set
