// Laws for any text as a cluster file, up to the code of its nodes.
#pragma once

#include <string>

namespace ttf::fuzz {

void check_cluster(const std::string& text);

}  // namespace ttf::fuzz
