// What a timing diagram shows of a run's faults: a lane for each, above the others, and what became of the frames they
// touched.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/timing/data.h"
#include "report/timing/tags.h"

namespace ttf::report::timing {

inline constexpr std::string_view kFaultSpan = "#f2b8a0";  // as in start-up diagrams

// One bar per fault, from its begin to its end or to that of the window, and a mark where it acts.
class FaultLanes {
 public:
  static constexpr double kHeight = 22;

  // Those that last into the window, or act in it.
  FaultLanes(const TimingData& data, const drawing::Names& names, TrueTime from, TrueTime to);

  double height() const { return static_cast<double>(lanes_.size()) * kHeight; }
  double label_width() const;
  // `plot`: the lanes begin at its top; `x`: where an instant stands.
  void draw_labels(drawing::Svg& svg, const drawing::Area& plot) const;
  void draw(drawing::Svg& svg, const drawing::Area& plot, const std::function<double(ttf::TrueTime)>& x,
            const TimingTags& tags) const;
  void add_to(std::vector<drawing::LegendEntry>& legend) const;

 private:
  struct Lane {
    std::string label, text;
    TrueTime start, end;
    bool ends;                                   // in the window
    std::vector<const TimingData::Fault*> acts;  // in the window
  };
  TrueTime from_, to_;
  std::map<std::uint32_t, Lane> lanes_;  // by fault
};

// What was on a channel otherwise than it was sent, where it is to be drawn: over its own box if it never arrived.
struct ChannelMark {
  TrueTime start, end;
  std::uint8_t channel = 0;
  bool missing = false;  // nothing of it reached anybody
  std::string words;
};
ChannelMark channel_mark(const TimingData::OnChannel& r, const drawing::Names& names);

inline constexpr std::string_view kChangedFrameWords = "frame damaged, displaced or sent by no controller",
                                  kMissingFrameWords = "frame that reached nobody";

}  // namespace ttf::report::timing
