// A command as one types it.
#pragma once

#include <string>
#include <vector>

namespace ttf::cli::supervision {

// The arguments, each quoted where a POSIX shell would read it otherwise, with blanks between.
std::string shell_text(const std::vector<std::string>& arguments);

}  // namespace ttf::cli::supervision
