// The faults in a timing diagram: a lane for each, above the others, and the fate of the frames they touched.
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

inline constexpr std::string_view kFaultSpan = "#f2b8a0";  // same as in start-up diagrams

// One bar per fault, from its begin to its end or the window's, with a mark at each of its acts.
class FaultLanes {
 public:
  static constexpr double kHeight = 22;

  // Takes the faults that last into the window or act in it.
  FaultLanes(const TimingData& data, const drawing::Names& names, TrueTime from, TrueTime to);

  double height() const { return static_cast<double>(lanes_.size()) * kHeight; }
  double label_width() const;
  // `plot` starts with these lanes at its top; `x` maps an instant to its place.
  void draw_labels(drawing::Svg& svg, const drawing::Area& plot) const;
  void draw(drawing::Svg& svg, const drawing::Area& plot, const std::function<double(ttf::TrueTime)>& x,
            const TimingTags& tags) const;
  void add_to(std::vector<drawing::LegendEntry>& legend) const;

 private:
  struct Lane {
    std::string label, text;
    TrueTime start, end;
    bool ends;                                   // within the window
    std::vector<const TimingData::Fault*> acts;  // within the window
  };
  TrueTime from_, to_;
  std::map<std::uint32_t, Lane> lanes_;  // by fault
};

// A frame that differs on a channel from the sent one, at its place in the drawing: over its own box if it
// never arrived.
struct ChannelMark {
  TrueTime start, end;
  std::uint8_t channel = 0;
  bool missing = false;  // no part of it reached a receiver
  std::string words;
};
ChannelMark channel_mark(const TimingData::OnChannel& r, const drawing::Names& names);

inline constexpr std::string_view kChangedFrameWords = "frame damaged, displaced or sent by no controller",
                                  kMissingFrameWords = "frame that reached no receiver";

}  // namespace ttf::report::timing
