// A file that another process has locked.
#pragma once

#include <functional>
#include <stdexcept>

namespace ttf::experiments::results {

// The file is locked, and waiting did not help.
class Locked : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Called while the file is locked, with the number of calls before. Returns whether to try again.
using Waiting = std::function<bool(int calls)>;

}  // namespace ttf::experiments::results
