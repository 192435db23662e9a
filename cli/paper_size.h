// The size of a picture on paper, from the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "report/drawing/sheet.h"

namespace ttf::cli {

// --width and --font-size as typed.
struct PaperSizeOptions {
  std::optional<std::string> width, font_size;
};

// Adds both options to the command.
void add_paper_size(CLI::App& command, PaperSizeOptions& options);

// Returns paper if there is a width, else a screen. Throws InputError for a size out of range, an unknown unit, and a font's
// size without a width.
report::drawing::Sheet sheet_of(const PaperSizeOptions& options);

}  // namespace ttf::cli
