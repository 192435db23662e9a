// Mistakes on the command line, as findings. CLI11 finds them; its exceptions have a text only, so the facts come from the
// state in which the parser stopped.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "core/errors.h"

namespace ttf::cli {

// Returns a mistake for the first word that is no command where a command must be. CLI11 would report a missing one.
std::optional<Finding> unknown_command(const CLI::App& app, int argc, const char* const* argv);

// Returns the mistake for which parse() of `app` threw `error`. An unknown option goes first: it may be why another one is
// missing. `app` is the whole program, and `error` is no CLI::Success.
Finding mistake_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace ttf::cli
