// Man pages, in the macros of man(7).
#pragma once

#include <string>

#include "cli/manual/outline.h"

namespace ttf::cli::manual {

// Returns the page of the program, or of one of its commands with the commands in it.
std::string man_page(const CommandOutline& command, const std::string& version);

}  // namespace ttf::cli::manual
