// A page's style, scripts and uPlot, compiled in from report/page/ and uPlot's package.
#pragma once

#include <string_view>

namespace ttf::report::page {

extern const std::string_view kStyle;
extern const std::string_view kElementsScript, kInstantScript;  // before the others of ours
extern const std::string_view kPlotsScript;                     // plots, with uPlot
extern const std::string_view kTimingDrawingScript, kTimingWindowsScript,
    kTimingScript;  // for timing diagrams, in order
extern const std::string_view kSceneDataScript, kSceneDrawingScript, kSceneControlsScript, kSceneScript;  // for scenes
extern const std::string_view kUplot, kUplotStyle, kUplotLicence;

}  // namespace ttf::report::page
