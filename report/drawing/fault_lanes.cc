#include "report/drawing/fault_lanes.h"

#include <fmt/format.h>

#include <algorithm>

namespace ttf::report::drawing {
namespace {

constexpr std::string_view kFaultSpan = "#f2b8a0";

}  // namespace

FaultLanes::FaultLanes(const std::vector<FaultEvent>& events, const Names& names, TrueTime from, TrueTime to)
    : from_(from), to_(to) {
  for (const FaultEvent& f : events) {
    if (f.what == recording::records::FaultAct::kBegins)
      lanes_.try_emplace(f.fault, Lane{f.node == kNoNode ? f.kind : fmt::format("{}, {}", f.kind, names.node(f.node)),
                                       f.text,
                                       f.at,
                                       to,
                                       false,
                                       {}});
    const auto lane = lanes_.find(f.fault);
    if (lane == lanes_.end()) continue;  // its begin is missing from the log
    if (f.what == recording::records::FaultAct::kEnds) {
      lane->second.end = f.at;
      lane->second.ends = true;
    }
    if (f.what == recording::records::FaultAct::kActs && f.at >= from && f.at < to) lane->second.acts.push_back(&f);
  }
  std::erase_if(lanes_, [&](const auto& one) {
    return one.second.acts.empty() && (one.second.start >= to || one.second.end < from);
  });
}

double FaultLanes::label_width() const {
  double width = 0;
  for (const auto& [fault, lane] : lanes_) width = std::max(width, text_width(lane.label, 11));
  return width;
}

void FaultLanes::draw_labels(Svg& svg, const Area& plot) const {
  double y = plot.y;
  for (const auto& [fault, lane] : lanes_) {
    svg.text({plot.x - 10, y + 15}, lane.label, {.size = 11, .anchor = Anchor::kEnd});
    y += kHeight;
  }
}

void FaultLanes::draw(Svg& svg, const Area& plot, const std::function<double(TrueTime)>& x, const Tag& tag) const {
  double y = plot.y;
  for (const auto& [fault, lane] : lanes_) {
    const double left = x(std::max(lane.start, from_)), right = x(std::min(lane.end, to_));
    if (lane.start < to_ && lane.end >= from_) {
      if (tag) svg.tag_next(tag(lane.start, lane.end, !lane.ends));
      svg.rect({left, y + 4, std::max(1.5, right - left), 14}, {.fill = kFaultSpan, .stroke = kVermilion, .width = 0.7},
               lane.text, "fault");
    }
    for (const FaultEvent* const act : lane.acts) {
      if (tag) svg.tag_next(tag(act->at, std::nullopt, false));
      svg.rect({x(act->at) - 0.7, y + 4, 1.4, 14}, {.fill = kVermilion}, act->text, "acts");
    }
    y += kHeight;
  }
}

void FaultLanes::add_to(std::vector<LegendEntry>& legend) const {
  using K = LegendEntry::Kind;
  if (lanes_.empty()) return;
  legend.push_back({K::kBox, "fault, from begin to end", std::string(kFaultSpan), {}, true});
  if (std::ranges::any_of(lanes_, [](const auto& one) { return !one.second.acts.empty(); }))
    legend.push_back({K::kLine, "the fault acts", std::string(kVermilion)});
}

}  // namespace ttf::report::drawing
