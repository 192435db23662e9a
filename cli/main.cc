#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/help_format.h"
#include "cli/output.h"
#include "cli/version.h"
#include "core/errors.h"

namespace {

constexpr const char* kAbout =
    "ttfusion drives clusters whose nodes track objects together on a time-triggered schedule:\n"
    "simulated in virtual time, or as processes in real time on SocketCAN or DDS. It also checks\n"
    "schedules, injects faults, draws and reports drives, and compares strategies in experiments.";

int refuse(const ttf::Finding& mistake) {
  fmt::print(stderr, "error: {}\n", mistake.sentence());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kAbout, "ttfusion"};
  app.formatter(std::make_shared<ttf::cli::HelpFormat>());  // first: commands inherit it
  app.require_subcommand(1);
  app.set_version_flag("-V,--version", ttf::cli::version_text());
  ttf::cli::Action action;
  ttf::cli::drive::add_run(app, action);
  ttf::cli::logs::add_diagram(app, action);
  ttf::cli::exports::add_export(app, action);
  ttf::cli::schedule::add_schedule(app, action);
  ttf::cli::experiment::add_experiment(app, action);
  ttf::cli::keys::add_keys(app, action);
  ttf::cli::launch::add_launch(app, action);
  ttf::cli::node::add_node(app, action);
  ttf::cli::logs::add_report(app, action);
  ttf::cli::track::add_track(app, action);
  ttf::cli::manual::add_manual(app, action);
  app.footer("`ttfusion COMMAND --help` has a command's options and an example.");  // last: commands would inherit it
  if (argc == 1) {
    fmt::print("{}", app.help());
    return 0;
  }
  if (const auto mistake = ttf::cli::unknown_command(app, argc, argv)) return refuse(*mistake);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version also arrive here, with exit code 0.
    if (error.get_exit_code() == 0) return app.exit(error);
    return refuse(ttf::cli::mistake_of(app, error));
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
