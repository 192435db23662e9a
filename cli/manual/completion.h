// Completion of the command line for three shells: commands, options, their words, names of shipped files, and files.
#pragma once

#include <string>

#include "cli/manual/outline.h"

namespace ttf::cli::manual {

std::string bash_completion(const CommandOutline& program);
std::string zsh_completion(const CommandOutline& program);
std::string fish_completion(const CommandOutline& program);

}  // namespace ttf::cli::manual
