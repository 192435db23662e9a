// Draws what a timing diagram has collected (report/timing/diagram.h says what it shows).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/timing/data.h"
#include "report/timing/diagram.h"
#include "report/timing/ways.h"

namespace ttf::report::timing {

inline constexpr std::string_view kDeadlineMissed = drawing::kYellow, kTaskFill = "#c9d7e6";

std::string paint_timing(const drawing::Names& names, const TimingData& data, Duration cycle, TrueTime from,
                         TrueTime to, TimingUse use);

// What the picture explains: only what occurs in the window.
std::vector<drawing::LegendEntry> timing_legend(const TimingData& data, const drawing::Names& names,
                                                const std::vector<Way>& ways, bool images, TrueTime from, TrueTime to);

}  // namespace ttf::report::timing
