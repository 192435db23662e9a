// Draws the collected data of a timing diagram (report/timing/diagram.h describes the picture).
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
                         TrueTime to, TimingUse use, const drawing::Sheet& sheet);

// Returns legend entries only for things that occur in the window.
std::vector<drawing::LegendEntry> timing_legend(const TimingData& data, const drawing::Names& names,
                                                const std::vector<Way>& ways, bool images, TrueTime from, TrueTime to);

}  // namespace ttf::report::timing
