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

FaultLanes::FaultLanes(const TimingData& data, const drawing::Names& names, TrueTime from, TrueTime to)
    : from_(from), to_(to) {
  for (const auto& f : data.faults) {
    if (f.what == recording::records::kFaultBegins)
      lanes_.try_emplace(f.fault, Lane{f.node == kNoNode ? f.kind : fmt::format("{}, {}", f.kind, names.node(f.node)),
                                       f.text,
                                       f.at,
                                       to,
                                       false,
                                       {}});
    const auto lane = lanes_.find(f.fault);
    if (lane == lanes_.end()) continue;  // its begin is missing from the log
    if (f.what == recording::records::kFaultEnds) {
      lane->second.end = f.at;
      lane->second.ends = true;
    }
    if (f.what == recording::records::kFaultActs && f.at >= from && f.at < to) lane->second.acts.push_back(&f);
  }
  std::erase_if(lanes_, [&](const auto& one) {
    return one.second.acts.empty() && (one.second.start >= to || one.second.end < from);
  });
}

double FaultLanes::label_width() const {
  double width = 0;
  for (const auto& [fault, lane] : lanes_) width = std::max(width, drawing::text_width(lane.label, 11));
  return width;
}

void FaultLanes::draw_labels(drawing::Svg& svg, const drawing::Area& plot) const {
  double y = plot.y;
  for (const auto& [fault, lane] : lanes_) {
    svg.text({plot.x - 10, y + 15}, lane.label, {.size = 11, .anchor = drawing::Anchor::kEnd});
    y += kHeight;
  }
  if (!lanes_.empty()) svg.line({12, y}, {plot.x + plot.width, y}, {.stroke = "#999999", .width = 0.8});
}

void FaultLanes::draw(drawing::Svg& svg, const drawing::Area& plot, const std::function<double(ttf::TrueTime)>& x,
                      const TimingTags& tags) const {
  double y = plot.y;
  for (const auto& [fault, lane] : lanes_) {
    const double left = x(std::max(lane.start, from_)), right = x(std::min(lane.end, to_));
    if (lane.start < to_ && lane.end >= from_) {
      svg.tag_next(tags.span(lane.start, lane.end) + (lane.ends ? "" : tags.beyond()));
      svg.rect({left, y + 4, std::max(1.5, right - left), 14},
               {.fill = kFaultSpan, .stroke = drawing::kVermilion, .width = 0.7}, lane.text, "fault");
    }
    for (const auto* act : lane.acts) {
      svg.tag_next(tags.at(act->at));
      svg.rect({x(act->at) - 0.7, y + 4, 1.4, 14}, {.fill = drawing::kVermilion}, act->text, "acts");
    }
    y += kHeight;
  }
}

void FaultLanes::add_to(std::vector<drawing::LegendEntry>& legend) const {
  using K = drawing::LegendEntry::Kind;
  if (lanes_.empty()) return;
  legend.push_back({K::kBox, "fault, from begin to end", std::string(kFaultSpan), {}, true});
  if (std::ranges::any_of(lanes_, [](const auto& one) { return !one.second.acts.empty(); }))
    legend.push_back({K::kLine, "the fault acts", std::string(drawing::kVermilion)});
}

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
