// A file's bytes: the one way in for everything that is read from disk.
#pragma once

#include <cstddef>
#include <string>

namespace ttf {

// All of them, or the first `most`. Throws InputError, naming the path and what the system says, if it cannot be read.
std::string read_file(const std::string& path, std::size_t most = static_cast<std::size_t>(-1));

}  // namespace ttf
