// The fate of the frames that faults touched, in a timing diagram.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "report/drawing/names.h"
#include "report/timing/data.h"

namespace ttf::report::timing {

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
