// A file's bytes, whole. Private to the room.
#pragma once

#include <string>

namespace ttf::recording {

// Throws InputError, naming the path, if it cannot be read.
std::string read_file(const std::string& path);

}  // namespace ttf::recording
