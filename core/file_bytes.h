// The bytes of a file: all reading from disk goes through here.
#pragma once

#include <cstddef>
#include <string>

namespace ttf {

// Returns the whole file, or its first `most` bytes. Throws InputError with the path and the system's message
// when the file cannot be read.
std::string read_file(const std::string& path, std::size_t most = static_cast<std::size_t>(-1));

}  // namespace ttf
