// A command as a user types it.
#pragma once

#include <string>
#include <vector>

namespace ttf::cli::supervision {

// Joins the arguments by blanks and quotes them for a POSIX shell where necessary.
std::string shell_text(const std::vector<std::string>& arguments);

}  // namespace ttf::cli::supervision
