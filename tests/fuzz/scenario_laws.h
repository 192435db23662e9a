// What must hold for any text that claims to be a scenario, up to the world it describes.
#pragma once

#include <string>

namespace ttf::fuzz {

// Whether it was accepted.
bool check_scenario(const std::string& text);

}  // namespace ttf::fuzz
