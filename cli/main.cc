#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/version.h"
#include "core/errors.h"

namespace {

constexpr const char* kAbout =
    "ttfusion drives clusters whose nodes track objects together on a time-triggered schedule:\n"
    "simulated in virtual time, or as processes in real time on SocketCAN or DDS. It also checks\n"
    "schedules, injects faults, draws and reports drives, and compares strategies in experiments.";

constexpr std::size_t kWidest = 100;

// Breaks at blanks; lines of the text stay lines.
std::string broken(std::string_view text, std::size_t width) {
  std::string out;
  std::size_t used = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
    if (used > 0 && used + 1 + end > width) {
      out += '\n';
      used = 0;
    } else if (used > 0) {
      out += ' ';
      ++used;
    }
    out += text.substr(0, end);
    used += end;
    if (end < text.size() && text[end] == '\n') {
      out += '\n';
      used = 0;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

// Help for people: descriptions are broken into lines of at most 100 characters. CLI11 prints each on one line.
class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return broken(Formatter::make_option_desc(option), kWidest - get_column_width());
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::stringstream out;
    CLI::detail::format_help(out, command->get_name(), broken(command->get_description(), kWidest - get_column_width()),
                             get_column_width());
    return out.str();
  }
  std::string make_description(const CLI::App* command) const override {
    return broken(Formatter::make_description(command), kWidest);
  }
};

int refuse(const ttf::Finding& mistake) {
  fmt::print(stderr, "error: {}\n", mistake.sentence());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{kAbout, "ttfusion"};
  app.formatter(std::make_shared<HelpFormat>());  // first: commands inherit it
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
