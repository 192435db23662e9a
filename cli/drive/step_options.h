// The options of all commands that drive a cluster whose steps may be a library's: --steps and --step-limit.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nodes/foreign/libraries.h"

namespace ttf::cli::drive {

// The options as written.
struct StepOptions {
  std::optional<std::string> folder, limit;

  // Returns the options that give another process the same steps.
  std::vector<std::string> arguments() const;
};

void add_step_options(CLI::App& command, StepOptions& options);

// Returns no value without --steps. Throws InputError.
std::optional<nodes::foreign::StepFolder> step_folder(const StepOptions& options);

// Returns the folder as drives take it: null without a value.
inline const nodes::foreign::StepFolder* pointer_to(const std::optional<nodes::foreign::StepFolder>& folder) {
  return folder ? &*folder : nullptr;
}

}  // namespace ttf::cli::drive
