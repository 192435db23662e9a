// The texts of a timing diagram.
#pragma once

#include <vector>

#include "report/drawing/svg.h"
#include "report/timing/canvas.h"
#include "report/timing/transfers.h"

namespace ttf::report::timing {

// Draws labels where space is free; called last.
void draw_labels(drawing::Svg& svg, const TimingCanvas& canvas, const std::vector<Transfer>& transfers);

}  // namespace ttf::report::timing
