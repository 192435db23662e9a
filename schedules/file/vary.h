// Gives a value to a key that a cluster file leaves out, for experiments that vary it.
#pragma once

#include <string>
#include <string_view>

#include "schedules/file/inherit.h"

namespace ttf::schedules::file {

// Returns whether the text leaves the key out and another key determines its value (schedules/file/derive.h), or another
// entry has it (schedules/file/likeness/inherit_alike.h). A parameter of a node may be one that all nodes leave out. False
// for a text with mistakes.
bool leaves_out(const ClusterText& text, std::string_view path);

// Returns the text with the key: what depends on it follows. Throws InputError where its mapping is missing.
ClusterText with_key(ClusterText text, std::string_view path, std::string_view value);

}  // namespace ttf::schedules::file
