// Writes an SVG picture to a file: .svg as it is, .png and .pdf drawn by librsvg and cairo.
#pragma once

#include <string>

namespace ttf::report::drawing {

// The extension of `path` chooses the format. PNG has two pixels per SVG unit up to 2600 units' width and one
// beyond; PDF has one CSS pixel (1/96 inch) per SVG unit. Equal input gives equal bytes. Throws InputError
// for an unknown extension or bytes that are no SVG, std::runtime_error for a path that cannot be written.
void write_picture(const std::string& svg, const std::string& path);

// Throws InputError now rather than after a long computation if `path` names no known format.
void check_picture_path(const std::string& path);

}  // namespace ttf::report::drawing
