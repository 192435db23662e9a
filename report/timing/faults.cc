#include "report/timing/faults.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/records/enumerations.h"

namespace ttf::report::timing {
ChannelMark channel_mark(const TimingData::OnChannel& r, const drawing::Names& names) {
  ChannelMark mark{r.start, r.end, r.channel, has(r.state, recording::records::ChannelState::kNothing), {}};
  if (mark.missing) {
    mark.start = r.sent;
    mark.end = r.sent + std::max(r.end - r.start, Duration{});
    mark.channel = r.sent_channel;
  }
  std::string whose = "sent by no node";
  if (r.slot != 0)
    whose = fmt::format("slot {} of {}", r.slot, names.node(r.sender));
  else if (r.sender != kNoNode)
    whose = fmt::format("{}, but its controller did not send it", names.node(r.sender));
  const std::string state = mark.missing ? "it reached no receiver" : to_text(r.state);
  mark.words = fmt::format("{}: {}", whose, state.empty() ? "sound" : state);
  return mark;
}

}  // namespace ttf::report::timing
