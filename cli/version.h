// What `ttfusion --version` says.
#pragma once

#include <string>

namespace ttf::cli {

// Returns version and commit, compiler and build type, and the libraries in it: a line each.
std::string version_text();

}  // namespace ttf::cli
