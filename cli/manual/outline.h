// The program's commands and options as data, from the parser itself: man pages and completions cannot differ from --help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace ttf::cli::manual {

struct OptionOutline {
  std::vector<std::string> names;    // "-o", "--out"; a positional argument has one without dashes
  std::string value;                 // "TEXT", "1..1024"; empty for a flag
  std::vector<std::string> choices;  // the allowed words, if there are some
  std::string meaning;
  bool required = false, many = false;
};

struct CommandOutline {
  std::string name;   // "schedule check"; empty for the program itself
  std::string about;  // one sentence
  std::string notes;  // the end of --help: remarks and examples
  std::vector<OptionOutline> arguments, options;
  std::vector<std::string> shipped;  // names of shipped files that its file argument takes
  std::vector<CommandOutline> commands;
};

CommandOutline outline_of(const CLI::App& app);

// Returns the command and all commands in it, outermost first.
std::vector<const CommandOutline*> all_of(const CommandOutline& program);

// Returns the page of the program, or of one of its commands with the commands in it, in the macros of man(7).
std::string man_page(const CommandOutline& command, const std::string& version);

// Completion of the command line: commands, options, their words, names of shipped files, and files.
std::string bash_completion(const CommandOutline& program);
std::string zsh_completion(const CommandOutline& program);
std::string fish_completion(const CommandOutline& program);

}  // namespace ttf::cli::manual
