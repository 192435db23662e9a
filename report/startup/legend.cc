#include <algorithm>
#include <set>

#include "recording/records/records.h"
#include "report/startup/painter.h"

namespace ttf::report::startup {

std::vector<drawing::LegendEntry> startup_legend(const StartupData& data, const std::vector<StateSpan>& spans,
                                                 TrueTime from, TrueTime to) {
  using K = drawing::LegendEntry::Kind;
  const auto visible = [&](TrueTime start, TrueTime end) { return start < to && end >= from; };
  std::vector<drawing::LegendEntry> legend;
  std::set<std::string_view> phases;
  for (const StateSpan& span : spans)
    if (const StatePhase phase = phase_of(span.state);
        visible(span.start, span.end) && phases.insert(phase.words).second)
      legend.push_back({K::kBox, std::string(phase.words), phase.colour, {}, true});
  bool startup = false, null = false, other = false;
  for (const auto& f : data.frames) {
    if (!visible(f.start, f.end)) continue;
    (f.startup ? startup : f.null_frame ? null : other) = true;
  }
  if (startup) legend.push_back({K::kBox, "startup frame", std::string(kStartupFrameFill), {}, true});
  if (null) legend.push_back({K::kBox, "null frame", std::string(drawing::kGrey), {}, false});
  if (other) legend.push_back({K::kBox, "other frame", std::string(kOtherFrameFill), {}, true});
  if (std::ranges::any_of(data.symbols, [&](const auto& s) { return visible(s.stamp.true_time, s.end.true_time); }))
    legend.push_back({K::kBox, "symbol", std::string(drawing::kBlack), {}, true});
  const auto power = [&](bool on) {
    return std::ranges::any_of(
        data.power, [&](const auto& p) { return p.on == on && visible(p.stamp.true_time, p.stamp.true_time); });
  };
  if (power(true))
    legend.push_back({K::kMarker, "power on", std::string(drawing::kGreen), drawing::Marker::kTriangle, true});
  if (power(false))
    legend.push_back({K::kMarker, "power off", std::string(drawing::kVermilion), drawing::Marker::kDownTriangle, true});
  return legend;
}

}  // namespace ttf::report::startup
