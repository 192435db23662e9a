// Writes an SVG picture to a file: .svg unchanged, .png and .pdf drawn by librsvg and cairo.
#pragma once

#include <string>

namespace ttf::report::drawing {

// Writes the picture in the format of the extension of `path`. A PNG has two pixels per CSS pixel (1/96
// inch) up to a width of 2600, and one beyond. A picture with a size on paper has 300 pixels an inch. A PDF has the size
// of the SVG. Equal input gives equal bytes. Throws
// InputError for an unknown extension or bytes that are no SVG, std::runtime_error for an unwritable path.
void write_picture(const std::string& svg, const std::string& path);

// Throws InputError if `path` has no known format: before a long computation, not after it.
void check_picture_path(const std::string& path);

}  // namespace ttf::report::drawing
