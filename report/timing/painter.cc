#include "report/timing/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recording/records/enumerations.h"
#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/timing/canvas.h"
#include "report/timing/cycles.h"
#include "report/timing/data.h"
#include "report/timing/lanes.h"
#include "report/timing/problems.h"
#include "report/timing/transfers.h"
#include "report/timing/ways.h"

namespace ttf::report::timing {
namespace {

// A frame that differs on a channel from the sent one, at its place in the drawing: over its own box if it
// never arrived.
struct ChannelMark {
  TrueTime start, end;
  std::uint8_t channel = 0;
  bool missing = false;  // no part of it reached a receiver
  std::string words;
};

constexpr std::string_view kChangedFrameWords = "frame damaged, displaced or sent by no controller",
                           kMissingFrameWords = "frame that reached no receiver";

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

// Everything needed to draw one picture; lives for one call of svg().
class TimingPainter : TimingCanvas {
  static constexpr double kPixelsPerMs = 14, kLeastPlot = 1000, kMostPlot = 5600;
  static constexpr double kPageWidth = 940, kLeastPlotInPage = 480;  // it fits into a window of 1,000 px
  static constexpr double kTop = 62, kTopInPage = 28;

 public:
  TimingPainter(const TimingCanvas& empty, Duration cycle)
      : TimingCanvas(empty), cycle_(cycle), transfers_(transfers_of(data)), ways_(ways_of(data)),
        faults_(data.faults, names, from, to) {
    lanes_ = lanes_of(data, names, ways_);
    const double ms = (to - from).seconds() * 1e3;
    plot.x = faults_.label_width() > 0 ? faults_.label_width() + 24 : 24;
    for (const Lane& lane : lanes_)
      for (const std::string& line : label_lines(lane)) plot.x = std::max(plot.x, drawing::text_width(line, 11) + 24);
    // A page's script widens it to the available space.
    plot.width = sheet.plot_width(tags.on() ? std::max(kLeastPlotInPage, kPageWidth - plot.x - 24)
                                            : std::clamp(ms * kPixelsPerMs, kLeastPlot, kMostPlot),
                                  plot.x + 24);
    title_ = fmt::format("{}: {} ms to {} ms", names.drive.empty() ? "Timing diagram" : names.drive,
                         drawing::number(in_ms(from)), drawing::number(in_ms(to)));
    title_lines_ = drawing::broken(title_, sheet.text(14), sheet.line(plot.x + plot.width - 24), true);
    plot.y = tags.on() ? kTopInPage : kTop + drawing::kLineHeight * static_cast<double>(title_lines_.size() - 1);
    double y = plot.y + faults_.height();
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      if (i > 0 && lanes_[i].section != lanes_[i - 1].section) y += 10;
      centres[lanes_[i].key] = y + lane_height(lanes_[i]) / 2;
      y += lane_height(lanes_[i]);
    }
    plot.height = y - plot.y;
    legend_ = timing_legend(data, names, ways_.measurements, !ways_.images.empty(), from, to);
    for (const auto& r : data.on_channel)
      if (const ChannelMark mark = channel_mark(r, names);
          visible(mark.start, mark.end) && centres.contains({LaneKey::Kind::kChannel, mark.channel, 0}))
        marks_.push_back(mark);
    problems_.emplace(data, names, lanes_, from, to);
    mark_legend();
  }

  std::string picture() {
    const double legend_width = plot.width + plot.x - 24;
    const double legend_top = plot.y + plot.height + 46;
    const double height = legend_top + legend_height(legend_, legend_width) + 12;
    drawing::Svg svg(plot.x + plot.width + 24, height, title_, sheet);
    svg_ = &svg;
    if (!tags.on()) svg.lines({24, 22}, title_lines_, {.size = 14, .bold = true});
    grid();
    faults_.draw_labels(svg, plot);
    if (const double y = plot.y + faults_.height(); faults_.count() > 0)
      svg.line({12, y}, {plot.x + plot.width, y}, {.stroke = "#999999", .width = 0.8});
    svg.open_group("events", plot);
    faults_.draw(
        svg, plot, [&](TrueTime t) { return x(t); },
        [&](TrueTime start, std::optional<TrueTime> end, bool beyond) {
          return end ? tags.span(start, *end) + (beyond ? tags.beyond() : "") : tags.at(start);
        });
    slots();
    channel_marks();
    can();
    tasks();
    svg.close_group();
    svg.open_group("ways", plot);
    for (const Way& way : ways_.images) draw_way(svg, *this, way);
    for (const Way& way : ways_.measurements) draw_way(svg, *this, way);
    svg.close_group();
    svg.open_group("events", plot);
    instants();
    problems_->draw(
        svg,
        [&](const LaneKey& lane, TrueTime at) {
          return drawing::Point{x(at), y(lane)};
        },
        tags);
    svg.close_group();
    draw_labels(svg, *this, transfers_);
    svg.tag_next(tags.span(from, to));
    svg.rect(plot, {.stroke = drawing::kBlack, .width = 0.8}, {}, tags.on() ? "plot" : "");
    draw_legend(svg, {24, legend_top}, legend_width, legend_);
    return svg.str();
  }

 private:
  void grid() {
    svg_->open_group("grid");
    const auto starts = cycle_starts(data, cycle_, names.cycles, from, to);
    drawing::LabelSpace above;
    for (auto it = starts.begin(); it != starts.end(); ++it) {
      const auto next = std::next(it);
      const TrueTime end = next != starts.end() ? next->second : it->second + cycle_;
      if (!visible(it->second, end)) continue;
      const double left = inside(x(it->second)), right = inside(x(end));
      if (it->first % 2 != 0) {
        svg_->tag_next(tags.span(it->second, end));
        svg_->rect({left, plot.y, right - left, plot.height}, {.fill = "#f4f4f4"}, {}, "cycle");
      }
      if (it->second >= from) {
        svg_->tag_next(tags.at(it->second));
        svg_->line({left, plot.y - 4}, {left, plot.y + plot.height}, {.stroke = "#b8b8b8", .width = 0.7}, "cycle");
      }
      const std::string label = fmt::format("{}", it->first);
      const drawing::TextStyle style{.size = sheet.text(10), .anchor = drawing::Anchor::kMiddle, .fill = "#444444"};
      drawing::Area area = text_area({(left + right) / 2, plot.y - 7}, label, style);
      area.x -= 4, area.width += 8;
      if (it->first < 0) continue;
      const bool room = area.x >= plot.x && area.x + area.width <= plot.x + plot.width && above.claim(area);
      if (!room && !tags.on()) continue;
      svg_->tag_next(tags.span(it->second, end) + tags.label(area.width, room));
      svg_->text({(left + right) / 2, plot.y - 7}, label, style);
    }
    if (!starts.empty())
      svg_->text({plot.x - 10, plot.y - 7}, "cycle", {.size = 10, .anchor = drawing::Anchor::kEnd, .fill = "#444444"});
    int section = lanes_.front().section;
    for (const Lane& lane : lanes_) {
      const double centre = y(lane.key), half = lane_height(lane) / 2;
      if (lane.section != section) {
        section = lane.section;
        svg_->line({12, centre - half - 5}, {plot.x + plot.width, centre - half - 5},
                   {.stroke = "#999999", .width = 0.8});
      }
      svg_->line({plot.x, centre}, {plot.x + plot.width, centre}, {.stroke = "#e0e0e0", .width = 0.7});
      const std::vector<std::string> lines = label_lines(lane);
      svg_->lines({plot.x - 10, centre + 4 - drawing::kLineHeight / 2 * static_cast<double>(lines.size() - 1)}, lines,
                  {.size = 11, .anchor = drawing::Anchor::kEnd});
    }
    if (tags.on()) {  // a group of its own: the script draws another axis
      svg_->close_group();
      svg_->open_group("time");
    }
    draw_time_axis(*svg_, plot, {in_ms(from), in_ms(to)});
    svg_->close_group();
  }

  void slots() {
    for (const auto& f : data.slot_frames) {
      if (!visible(f.start, f.end)) continue;
      const double centre = y({LaneKey::Kind::kChannel, f.channel, 0}) + 4;
      const double width = std::max(1.0, x(f.end) - x(f.start));
      const std::string colour = pdu_colour(names, f.pdu);
      const std::string hover =
          fmt::format("slot {}, cycle {}, {}{} #{} fragment {}, from {}", f.slot, f.cycle,
                      f.null_frame ? "null frame, " : "", names.pdu(f.pdu), f.sequence, f.fragment, names.node(f.node));
      const drawing::Area area{x(f.start), centre - kBox / 2, width, kBox};
      svg_->tag_next(tags.span(f.start, f.end) + (f.pdu == kNoPdu ? "" : tags.list(f.sensor, f.sequence)));
      if (f.null_frame && tags.on()) {
        svg_->rect(area, {.fill = "#ffffff", .stroke = drawing::kGrey, .width = 0.3}, hover, "null");
      } else if (f.null_frame && width > 3) {
        svg_->rect(area, {.fill = "#ffffff", .stroke = drawing::kGrey, .width = 0.5}, hover, "null");
      } else if (f.null_frame) {
        // The side walls of neighbours would fill a narrow box, so it has only top and bottom.
        svg_->rect(area, {.fill = "#ffffff"}, hover, "null");
        for (const double edge : {area.y, area.y + kBox})
          svg_->line({area.x, edge}, {area.x + width, edge}, {.stroke = drawing::kGrey, .width = 0.6});
      } else {
        svg_->rect(area, {.fill = colour, .stroke = width > 4 ? "#444444" : "none", .width = 0.5}, hover,
                   f.pdu == kNoPdu ? "status" : "frame");
      }
    }
  }

  // Draws the frames' fates over them.
  void channel_marks() {
    for (const ChannelMark& mark : marks_) {
      const double centre = y({LaneKey::Kind::kChannel, mark.channel, 0}) + 4;
      const double width = std::max(2.0, x(mark.end) - x(mark.start));
      svg_->tag_next(mark.missing ? tags.at(mark.start) : tags.span(mark.start, mark.end));
      if (mark.missing)
        svg_->marker(drawing::Marker::kCross, {x(mark.start) + width / 2, centre}, 9,
                     {.stroke = drawing::kVermilion, .width = 1.6}, mark.words, "missing");
      else
        svg_->rect({x(mark.start), centre - kBox / 2 - 1.5, width, kBox + 3},
                   {.fill = "none", .stroke = drawing::kVermilion, .width = 1.4}, mark.words, "changed");
    }
  }

  void mark_legend() {
    using K = drawing::LegendEntry::Kind;
    faults_.add_to(legend_);
    const auto any = [&](bool missing) {
      return std::ranges::any_of(marks_, [&](const ChannelMark& mark) { return mark.missing == missing; });
    };
    if (any(false))
      legend_.push_back({K::kBox, std::string(kChangedFrameWords), std::string(drawing::kVermilion), {}, false});
    if (any(true))
      legend_.push_back(
          {K::kMarker, std::string(kMissingFrameWords), std::string(drawing::kVermilion), drawing::Marker::kCross});
    problems_->add_to(legend_);
  }

  void can() {
    for (const Transfer& t : transfers_) {
      if (t.lane.kind != LaneKey::Kind::kCan || !visible(t.start, t.end)) continue;
      const std::string colour = pdu_colour(names, t.pdu);
      svg_->tag_next(tags.span(t.start, t.end) + tags.list(names.sensor_of(t.pdu), t.sequence));
      svg_->rect({x(t.start), y(t.lane) - kBox / 2, std::max(1.5, x(t.end) - x(t.start)), kBox},
                 {.fill = drawing::tint(colour, 0.55), .stroke = colour, .width = 0.9},
                 fmt::format("{} #{}{}", names.pdu(t.pdu), t.sequence, times(t.start, t.end)), "transfer");
    }
  }

  void tasks() {
    for (const auto& r : data.executions) {
      const TrueTime activated = r.activated.true_time, start = r.start.true_time, end = r.end.true_time;
      if (!visible(activated, end)) continue;
      const NodeId node = r.start.node;
      const double centre = y({LaneKey::Kind::kTask, index_of(node), r.task});
      if (activated < start) {
        svg_->tag_next(tags.span(activated, start));
        svg_->line({x(activated), centre}, {x(start), centre}, {.stroke = "#666666", .width = 1.5});
        svg_->tag_next(tags.at(activated));
        svg_->line({x(activated), centre - 4}, {x(activated), centre + 4}, {.stroke = "#666666", .width = 1.0});
      }
      const double width = std::max(1.5, x(end) - x(start));
      svg_->tag_next(tags.span(start, end));
      svg_->rect({x(start), centre - kBox / 2, width, kBox},
                 {.fill = r.deadline_met ? "#c9d7e6" : kDeadlineMissed,
                  .stroke = r.deadline_met ? "#5b7083" : drawing::kBlack,
                  .width = r.deadline_met ? 0.6 : 1.6},
                 fmt::format("{}: {}{}{}", names.node(node), names.task(node, r.task), times(start, end),
                             r.deadline_met ? "" : ", deadline missed"),
                 r.deadline_met ? "task" : "task missed");
    }
  }

  void instants() {
    for (const auto& m : data.measurements) {
      if (!visible(m.at, m.at)) continue;
      svg_->tag_next(tags.at(m.at) + tags.list(m.id.sensor, m.id.sequence));
      const std::string colour = sensor_colour(names, m.id.sensor);
      svg_->marker(sensor_marker(names, m.id.sensor), {x(m.at), y({LaneKey::Kind::kSensor, index_of(m.id.sensor), 0})},
                   8, {.fill = colour, .stroke = colour, .width = 1.6},
                   fmt::format("{} #{}{}", names.sensor(m.id.sensor), m.id.sequence,
                               tags.on() ? " is measured" : fmt::format(" at {} ms", drawing::number(in_ms(m.at)))),
                   "measured");
    }
    for (const Way& way : ways_.measurements) {
      if (!way.dropped || !visible(way.last.at, way.last.at)) continue;
      svg_->tag_next(tags.at(way.last.at) + tags.list(way.id.sensor, way.id.sequence));
      svg_->marker(drawing::Marker::kCross, {x(way.last.at), y(way.last.lane)}, 11,
                   {.stroke = drawing::kBlack, .width = 2.2}, "dropped", "dropped");
    }
  }

  // On paper a node and its task have a line each.
  std::vector<std::string> label_lines(const Lane& lane) const {
    const std::size_t colon = sheet.on_paper() ? lane.label.find(": ") : std::string::npos;
    if (colon == std::string::npos) return {lane.label};
    return {lane.label.substr(0, colon + 1), lane.label.substr(colon + 2)};
  }

  Duration cycle_;
  std::string title_;
  std::vector<std::string> title_lines_;
  std::vector<Transfer> transfers_;
  Ways ways_;
  drawing::FaultLanes faults_;
  std::vector<ChannelMark> marks_;
  std::optional<ProblemMarks> problems_;  // set once the lanes are known
  std::vector<Lane> lanes_;
  std::vector<drawing::LegendEntry> legend_;
  drawing::Svg* svg_ = nullptr;
};

}  // namespace

std::string paint_timing(const drawing::Names& names, const TimingData& data, Duration cycle, TrueTime from,
                         TrueTime to, TimingUse use, const drawing::Sheet& sheet) {
  return TimingPainter({names, data, from, to, TimingTags(use), {}, {}, sheet}, cycle).picture();
}

}  // namespace ttf::report::timing
