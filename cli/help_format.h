// Help for people: descriptions are broken into lines of at most 100 characters. CLI11 prints each on one line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace ttf::cli {

class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* command) const override;
};

}  // namespace ttf::cli
