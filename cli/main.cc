#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/output.h"
#include "core/counted.h"
#include "core/errors.h"

namespace {

// Returns an error for an unknown command on the command line, or "".
std::string unknown_command(CLI::App& app, int argc, char** argv) {
  CLI::App* in = &app;
  for (int i = 1; i < argc && in->get_require_subcommand_min() > 0; ++i) {
    const std::string name = argv[i];
    if (name.empty() || name.front() == '-') return "";
    const std::vector<CLI::App*> commands = in->get_subcommands([](CLI::App*) { return true; });
    const auto command =
        std::find_if(commands.begin(), commands.end(), [&](CLI::App* one) { return one->get_name() == name; });
    if (command == commands.end()) {
      std::vector<std::string> names;
      for (const CLI::App* one : commands) names.push_back(one->get_name());
      return fmt::format("{} is no command{}: must be {}", name, in == &app ? "" : " of " + in->get_name(),
                         ttf::joined(names, " or "));
    }
    in = *command;
  }
  return "";
}

// Reports an error of the command line, in one line.
int refuse(const std::string& words) {
  std::string line = words;
  std::replace(line.begin(), line.end(), '\n', ' ');
  fmt::print(stderr, "error: {}\n", line);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"ttfusion: time-triggered distributed fusion in virtual time", "ttfusion"};
  app.require_subcommand(1);
  app.set_version_flag("--version", TTF_VERSION);
  ttf::cli::Action action;
  ttf::cli::drive::add_run(app, action);
  ttf::cli::logs::add_diagram(app, action);
  ttf::cli::logs::add_export(app, action);
  ttf::cli::schedule::add_schedule(app, action);
  ttf::cli::experiment::add_experiment(app, action);
  ttf::cli::keys::add_keys(app, action);
  ttf::cli::launch::add_launch(app, action);
  ttf::cli::node::add_node(app, action);
  ttf::cli::logs::add_report(app, action);
  ttf::cli::track::add_track(app, action);
  if (const std::string words = unknown_command(app, argc, argv); !words.empty()) return refuse(words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version also arrive here, with exit code 0.
    if (error.get_exit_code() == 0) return app.exit(error);
    return refuse(fmt::format("command line: {} (--help says more)", error.what()));
  }
  try {
    const int code = action();
    ttf::cli::finish_standard_output();
    return code;
  } catch (const ttf::InputError& error) {
    // A file of another kind is wrong in every line: a few hundred errors are enough.
    constexpr std::size_t kShown = 200;
    const auto& findings = error.findings();
    for (std::size_t i = 0; i < findings.size() && i < kShown; ++i)
      fmt::print(stderr, "error: {}\n", findings[i].sentence());
    if (findings.size() > kShown) fmt::print(stderr, "error: and {} more\n", findings.size() - kShown);
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
}
