// Draws what a start-up diagram has collected (report/startup/diagram.h says what it shows).
#pragma once

#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/startup/data.h"
#include "report/startup/states.h"

namespace ttf::report::startup {

inline constexpr std::string_view kStartupFrameFill = drawing::kBlue, kOtherFrameFill = drawing::kStatusFrame,
                                  kFaultFill = "#f2b8a0";

std::string paint_startup(const drawing::Names& names, const StartupData& data, Duration cycle, TrueTime from,
                          TrueTime to);

// What the picture explains: only what occurs in the window.
std::vector<drawing::LegendEntry> startup_legend(const StartupData& data, const std::vector<StateSpan>& spans,
                                                 TrueTime from, TrueTime to);

}  // namespace ttf::report::startup
