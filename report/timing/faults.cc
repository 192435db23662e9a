#include "report/timing/faults.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/records/records.h"

namespace ttf::report::timing {
namespace {

std::string state_words(std::uint8_t state) {
  struct Word {
    std::uint8_t bit;
    const char* words;
  };
  static constexpr Word kWords[] = {{recording::records::kChannelHeaderCrc, "header CRC wrong"},
                                    {recording::records::kChannelFrameCrc, "frame CRC wrong"},
                                    {recording::records::kChannelCoding, "undecodable"},
                                    {recording::records::kChannelCut, "cut off"}};
  std::string text;
  for (const Word& one : kWords)
    if ((state & one.bit) != 0) text += fmt::format("{}{}", text.empty() ? "" : ", ", one.words);
  return text.empty() ? "sound" : text;
}

}  // namespace

ChannelMark channel_mark(const TimingData::OnChannel& r, const drawing::Names& names) {
  ChannelMark mark{r.start, r.end, r.channel, (r.state & recording::records::kChannelNothing) != 0, {}};
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
  mark.words = mark.missing ? fmt::format("{}: it reached no receiver", whose)
                            : fmt::format("{}: {}", whose, state_words(r.state));
  return mark;
}

}  // namespace ttf::report::timing
