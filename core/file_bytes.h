// The bytes of a file: all reading from disk goes through here.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/errors.h"

namespace ttf {

// Returns the whole file, or its first `most` bytes. Throws InputError with the path and the system's message
// when the file cannot be read.
std::string read_file(const std::string& path, std::size_t most = static_cast<std::size_t>(-1));

// Does the same for a file that an entry of another file names. An unreadable file is a mistake of that entry: `entry` has
// its file, line and key. `what` names the wanted file: "a cluster file".
std::string read_named_file(const std::string& path, Finding entry, std::string_view what);

}  // namespace ttf
