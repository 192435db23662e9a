// A shared library with a step's four functions (ttfusion_step.h).
#pragma once

#include <string>

#include "core/errors.h"
#include "nodes/foreign/call.h"
#include "nodes/foreign/ttfusion_step.h"

namespace ttf::nodes::foreign {

struct Library {
  decltype(&ttf_step_create) create = nullptr;
  decltype(&ttf_step_run) run = nullptr;
  decltype(&ttf_step_destroy) destroy = nullptr;
};

// Loads the file, which must be a library of this program's version. A process loads it once, and keeps it until its own
// end: threads and exit handlers of the library may outlive its steps. `place` names the task. Throws InputError.
Library load_library(const std::string& path, const Finding& place, const CallTerms& terms);

}  // namespace ttf::nodes::foreign
