// Laws for any text as a scenario file, up to the world it describes.
#pragma once

#include <string>

namespace ttf::fuzz {

// Whether it was accepted.
bool check_scenario(const std::string& text);

}  // namespace ttf::fuzz
