// Draws the collected data of a start-up diagram (report/startup/diagram.h describes the picture).
#pragma once

#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/startup/data.h"
#include "report/startup/states.h"

namespace ttf::report::startup {

inline constexpr std::string_view kStartupFrameFill = drawing::kBlue, kOtherFrameFill = drawing::kStatusFrame;

std::string paint_startup(const drawing::Names& names, const StartupData& data, Duration cycle, TrueTime from,
                          TrueTime to, const drawing::Sheet& sheet);

// Returns legend entries only for things that occur in the window.
std::vector<drawing::LegendEntry> startup_legend(const StartupData& data, const std::vector<StateSpan>& spans,
                                                 TrueTime from, TrueTime to);

}  // namespace ttf::report::startup
