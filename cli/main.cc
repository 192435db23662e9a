#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "cli/commands.h"
#include "cli/output.h"
#include "core/errors.h"

int main(int argc, char** argv) {
  CLI::App app{"ttfusion: time-triggered distributed fusion in virtual time", "ttfusion"};
  app.require_subcommand(1);
  app.set_version_flag("--version", TTF_VERSION);
  ttf::cli::Action action;
  ttf::cli::add_run(app, action);
  ttf::cli::add_diagram(app, action);
  ttf::cli::add_export(app, action);
  ttf::cli::add_schedule(app, action);
  ttf::cli::add_experiment(app, action);
  ttf::cli::add_launch(app, action);
  ttf::cli::add_node(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // --help and --version come this way too, with exit code 0.
    const int code = app.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    const int code = action();
    ttf::cli::finish_standard_output();
    return code;
  } catch (const ttf::InputError& error) {
    // A file of another kind is wrong in every line: nobody reads thousands of them.
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
