#include "report/timing/problems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "recording/records/enumerations.h"

namespace ttf::report::timing {
namespace {

std::optional<LaneKey> lane_of(const recording::records::TimingProblem& p, const std::vector<Lane>& lanes) {
  const auto found = std::ranges::find_if(lanes, [&](const Lane& lane) {
    if (p.slot != 0) return lane.key.kind == LaneKey::Kind::kChannel && lane.key.index == p.channel;
    return lane.key.kind == LaneKey::Kind::kTask && lane.key.index == index_of(p.stamp.node);
  });
  return found == lanes.end() ? std::nullopt : std::optional(found->key);
}

std::string words_of(const recording::records::TimingProblem& p, const drawing::Names& names) {
  std::string words = fmt::format("{}: {}", names.node(p.stamp.node), to_text(p.what));
  if (p.what == recording::records::TimingFault::kFramesLost)
    return words + fmt::format(", {} of slot {}", p.count, p.slot);
  if (p.slot != 0) words += fmt::format(", slot {} of cycle {}", p.slot, p.cycle);
  return words + fmt::format(", by {} us", drawing::number(std::abs(static_cast<double>(p.late.ns) * 1e-3)));
}

}  // namespace

ProblemMarks::ProblemMarks(const TimingData& data, const drawing::Names& names, const std::vector<Lane>& lanes,
                           TrueTime from, TrueTime to) {
  for (const recording::records::TimingProblem& p : data.problems) {
    const TrueTime at = p.stamp.true_time;
    if (at < from || at >= to) continue;
    if (const auto lane = lane_of(p, lanes)) marks_.push_back({*lane, at, words_of(p, names)});
  }
}

void ProblemMarks::draw(drawing::Svg& svg,
                        const std::function<drawing::Point(const ttf::report::timing::LaneKey&, ttf::TrueTime)>& place,
                        const TimingTags& tags) const {
  for (const Mark& mark : marks_) {
    svg.tag_next(tags.at(mark.at));
    svg.marker(drawing::Marker::kDiamond, place(mark.lane, mark.at), 9,
               {.fill = drawing::kVermilion, .stroke = "#ffffff", .width = 0.8}, mark.words, "problem");
  }
}

void ProblemMarks::add_to(std::vector<drawing::LegendEntry>& legend) const {
  if (!marks_.empty())
    legend.push_back({drawing::LegendEntry::Kind::kMarker, "late, early or lost in real time",
                      std::string(drawing::kVermilion), drawing::Marker::kDiamond, true});
}

}  // namespace ttf::report::timing
