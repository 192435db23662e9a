// Draws scans of a recording for `diagram --kind boxes`.
#pragma once

#include <string>

#include "report/drawing/sheet.h"

namespace ttf::cli::logs {

// Draws a recorded laser scan and the vehicles that preprocessing finds in it. Returns the exit code: without any
// vehicle there is a picture, and the reasons.
int draw_boxes(const std::string& file, int frame, const report::drawing::Sheet& sheet, const std::string& out);

}  // namespace ttf::cli::logs
