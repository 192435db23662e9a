// The commands of the program. Each registers itself and runs when the command line names it. Exit codes: 0
// done, 1 failed, did nothing, or a stated condition does not hold, 2 bad usage or input.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace ttf::cli {

// Set by the chosen command; run after parsing.
using Action = std::function<int()>;

}  // namespace ttf::cli

// The folder of each command.
namespace ttf::cli::drive {
void add_run(CLI::App& app, Action& action);
}  // namespace ttf::cli::drive
namespace ttf::cli::exports {
void add_export(CLI::App& app, Action& action);
}  // namespace ttf::cli::exports
namespace ttf::cli::logs {
void add_diagram(CLI::App& app, Action& action);
void add_report(CLI::App& app, Action& action);
}  // namespace ttf::cli::logs
namespace ttf::cli::schedule {
void add_schedule(CLI::App& app, Action& action);
void add_sequence(CLI::App& schedule, Action& action);    // below `schedule`
void add_synthesize(CLI::App& schedule, Action& action);  // below `schedule`
}  // namespace ttf::cli::schedule
namespace ttf::cli::experiment {
void add_experiment(CLI::App& app, Action& action);
}  // namespace ttf::cli::experiment
namespace ttf::cli::keys {
void add_keys(CLI::App& app, Action& action);
}  // namespace ttf::cli::keys
namespace ttf::cli::launch {
void add_launch(CLI::App& app, Action& action);
}  // namespace ttf::cli::launch
namespace ttf::cli::manual {
void add_manual(CLI::App& app, Action& action);
}  // namespace ttf::cli::manual
namespace ttf::cli::node {
void add_node(CLI::App& app, Action& action);
}  // namespace ttf::cli::node
namespace ttf::cli::track {
void add_track(CLI::App& app, Action& action);
}  // namespace ttf::cli::track
