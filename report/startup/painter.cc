#include "report/startup/painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "recording/records/enumerations.h"
#include "report/startup/cycles.h"

namespace ttf::report::startup {
namespace {

// A picture has little room for these words.
std::string_view symbol_name(recording::records::Symbol symbol) {
  using recording::records::Symbol;
  return symbol == Symbol::kCas ? "CAS" : symbol == Symbol::kMediaTest ? "media test symbol" : to_text(symbol);
}

// Everything needed to draw one picture; lives for one call of svg().
class StartupPainter {
  // The longest name of a state of one double cycle fits into that double cycle.
  static constexpr double kPixelsPerCycle = 78, kPixelsPerMs = 14, kLeastPlot = 900, kMostPlot = 5600;
  static constexpr double kTop = 74, kNodeLane = 62, kLaneOffFlexRay = 34, kText = 9.5;
  // Places within a node's lane, from its top.
  static constexpr double kNotes = 10, kBar = 14, kBarHeight = 16, kChannels[] = {38, 49}, kRowHeight = 8;

 public:
  StartupPainter(const drawing::Names& names, const StartupData& data, Duration cycle, TrueTime from, TrueTime to,
                 const drawing::Sheet& sheet)
      : names_(names), data_(data), sheet_(sheet), text_(sheet.text(kText)), from_(from), to_(to),
        spans_(state_spans(data, from, to)), faults_(data.faults, names, from, to), leader_(leading_node(data)),
        legend_(startup_legend(data, spans_, from, to)) {
    faults_.add_to(legend_);
    if (leader_) cycles_ = cycles_of(data, *leader_, cycle, to);
    for (const auto& c : data.changes) on_flexray_.insert(c.node);
    for (const auto& f : data.frames) on_flexray_.insert(f.node);
    for (const auto& s : data.symbols) on_flexray_.insert(s.stamp.node);
    std::set<NodeId> nodes = on_flexray_;
    for (const auto& p : data.power) nodes.insert(p.stamp.node);
    plot_.x = 40;
    write_head();
    double y = plot_.y + faults_.height();
    if (faults_.count() > 0) plot_.x = std::max(plot_.x, faults_.label_width() + 24);
    for (const NodeId node : nodes) {
      node_top_[node] = y;
      y += on_flexray_.count(node) != 0 ? kNodeLane : kLaneOffFlexRay;
      plot_.x = std::max(plot_.x, drawing::text_width(names.node(node), 11) + 24);
    }
    plot_.height = y - plot_.y;
    const double ms = (to - from).seconds() * 1e3;
    const double per_ms = cycle.ns > 0 ? kPixelsPerCycle / (cycle.seconds() * 1e3) : kPixelsPerMs;
    plot_.width = sheet.plot_width(std::clamp(ms * per_ms, kLeastPlot, kMostPlot), plot_.x + 24);
  }

  std::string picture() {
    const double legend_width = plot_.width + plot_.x - 24;
    const double legend_top = plot_.y + plot_.height + 46;
    drawing::Svg svg(plot_.x + plot_.width + 24, legend_top + legend_height(legend_, legend_width) + 12, title_,
                     sheet_);
    svg_ = &svg;
    svg.lines({24, 22}, title_lines_, {.size = 14, .bold = true});
    svg.lines({24, 42 + drawing::kLineHeight * static_cast<double>(title_lines_.size() - 1)}, leader_lines_,
              {.size = 11});
    grid();
    lanes();
    svg.open_group("events", plot_);
    faults_.draw(svg, plot_, [&](TrueTime t) { return x(t); });
    states();
    frames();
    symbols();
    power();
    svg.close_group();
    labels();
    svg.rect(plot_, {.stroke = drawing::kBlack, .width = 0.8});
    draw_time_axis(svg, plot_, {in_ms(from_), in_ms(to_)});
    draw_legend(svg, {24, legend_top}, legend_width, legend_);
    return svg.str();
  }

 private:
  // The words above the plot, and its top. A cluster that began integrated has no leader.
  void write_head() {
    const bool integrated = !leader_ && !active_from_the_start(data_).empty();
    const double room = sheet_.line(sheet_.width(0) - 48);
    title_ = fmt::format("{}: {}, {} ms to {} ms", names_.drive.empty() ? "Run" : names_.drive,
                         integrated ? "changes of state" : "start-up", drawing::number(in_ms(from_)),
                         drawing::number(in_ms(to_)));
    title_lines_ = drawing::broken(title_, sheet_.text(14), room, true);
    if (leader_)
      leader_lines_ =
          drawing::broken(fmt::format("Cycles count from the collision avoidance symbol of {}, which leads.",
                                      names_.node(leader_->node)),
                          11, room);
    const std::size_t more = title_lines_.size() - 1 + (leader_lines_.empty() ? 0 : leader_lines_.size() - 1);
    plot_.y = kTop + drawing::kLineHeight * static_cast<double>(more);
  }
  double x(TrueTime t) const {
    return plot_.x + static_cast<double>((t - from_).ns) / static_cast<double>((to_ - from_).ns) * plot_.width;
  }
  bool visible(TrueTime start, TrueTime end) const { return start < to_ && end >= from_; }
  double stay_inside(double px) const { return std::clamp(px, plot_.x, plot_.x + plot_.width); }
  double top(NodeId node) const { return node_top_.at(node); }

  // A cycle's number stands in its middle, if it fits.
  void grid() {
    svg_->open_group("grid");
    drawing::LabelSpace above;
    for (auto it = cycles_.begin(); it != cycles_.end(); ++it) {
      const auto next = std::next(it);
      if (next == cycles_.end() && it->second >= to_) break;
      const TrueTime end = next != cycles_.end() ? next->second : to_;
      if (!visible(it->second, end)) continue;
      const double left = stay_inside(x(it->second)), right = stay_inside(x(end));
      if (it->first % 2 != 0) svg_->rect({left, plot_.y, right - left, plot_.height}, {.fill = "#f4f4f4"}, {}, "cycle");
      if (it->second >= from_)
        svg_->line({left, plot_.y - 4}, {left, plot_.y + plot_.height}, {.stroke = "#b8b8b8", .width = 0.7}, "cycle");
      const std::string label = fmt::format("{}", it->first);
      const drawing::TextStyle style{.size = sheet_.text(10), .anchor = drawing::Anchor::kMiddle, .fill = "#444444"};
      const drawing::Point at{(left + right) / 2, plot_.y - 7};
      drawing::Area area = text_area(at, label, style);
      area.x -= 4, area.width += 8;
      if (area.x >= plot_.x && area.x + area.width <= plot_.x + plot_.width && above.claim(area))
        svg_->text(at, label, style);
    }
    if (!cycles_.empty())
      svg_->text({plot_.x - 10, plot_.y - 7}, "cycle",
                 {.size = 10, .anchor = drawing::Anchor::kEnd, .fill = "#444444"});
    svg_->close_group();
  }

  void lanes() {
    svg_->open_group("lanes");
    const auto line_at = [&](double y) {
      svg_->line({12, y}, {plot_.x + plot_.width, y}, {.stroke = "#999999", .width = 0.8});
    };
    faults_.draw_labels(*svg_, plot_);
    for (const auto& [node, y] : node_top_) {
      if (y > plot_.y) line_at(y);
      svg_->text({plot_.x - 10, y + kBar + 12}, names_.node(node), {.size = 11, .anchor = drawing::Anchor::kEnd});
      if (on_flexray_.count(node) == 0) continue;
      for (int c = 0; c < 2; ++c) {
        const double centre = y + kChannels[c];
        svg_->line({plot_.x, centre}, {plot_.x + plot_.width, centre}, {.stroke = "#e0e0e0", .width = 0.7});
        svg_->text({plot_.x - 10, centre + 3}, c == 0 ? "A" : "B",
                   {.size = 8.5, .anchor = drawing::Anchor::kEnd, .fill = "#444444"});
      }
    }
    svg_->close_group();
  }

  void states() {
    for (const StateSpan& s : spans_) {
      if (!visible(s.start, s.end)) continue;
      const double left = stay_inside(x(s.start)), right = stay_inside(x(s.end));
      const std::string hover =
          s.why.empty() ? s.name : fmt::format("{} from {} ms on: {}", s.name, drawing::number(in_ms(s.start)), s.why);
      svg_->rect({left, top(s.node) + kBar, right - left, kBarHeight},
                 {.fill = phase_of(s.state).colour, .stroke = "#444444", .width = 0.6}, hover, "state");
    }
  }

  drawing::Area row(NodeId node, std::uint8_t channel, TrueTime start, TrueTime end, double least) const {
    const double centre = top(node) + kChannels[channel == 0 ? 0 : 1];
    return {x(start), centre - kRowHeight / 2, std::max(least, x(end) - x(start)), kRowHeight};
  }

  void frames() {
    for (const auto& f : data_.frames) {
      if (!visible(f.start, f.end)) continue;
      const std::string hover =
          fmt::format("{}{}slot {}, cycle {}, {} ms", f.startup ? "startup frame, " : "",
                      f.null_frame ? "null frame, " : "", f.slot, f.cycle, drawing::number(in_ms(f.start)));
      if (f.null_frame && !f.startup)
        svg_->rect(row(f.node, f.channel, f.start, f.end, 1.5),
                   {.fill = "#ffffff", .stroke = drawing::kGrey, .width = 0.5}, hover, "null");
      else
        svg_->rect(row(f.node, f.channel, f.start, f.end, f.startup ? 2.0 : 1.2),
                   {.fill = f.startup ? kStartupFrameFill : kOtherFrameFill}, hover, f.startup ? "startup" : "frame");
    }
  }

  // A symbol is widened to its left, because the frame of cycle 0 follows at once.
  void symbols() {
    for (const auto& s : data_.symbols) {
      const TrueTime start = s.stamp.true_time, end = s.end.true_time;
      if (!visible(start, end)) continue;
      drawing::Area area = row(s.stamp.node, s.channel, start, end, 2.5);
      area.x = x(end) - area.width;
      svg_->rect(area, {.fill = drawing::kBlack},
                 fmt::format("{}, {} ms", symbol_name(s.kind), drawing::number(in_ms(start))), "symbol");
    }
  }

  void power() {
    for (const auto& p : data_.power) {
      const TrueTime at = p.stamp.true_time;
      if (!visible(at, at)) continue;
      svg_->marker(p.on ? drawing::Marker::kTriangle : drawing::Marker::kDownTriangle,
                   {x(at), top(p.stamp.node) + kNotes - 2}, 9,
                   {.fill = p.on ? drawing::kGreen : drawing::kVermilion, .stroke = "#ffffff", .width = 0.6},
                   fmt::format("{} {} at {} ms", names_.node(p.stamp.node), p.on ? "powered on" : "powered off",
                               drawing::number(in_ms(at))),
                   "power");
    }
  }

  // Labels bars in full or short, as they fit; notes appear only where space is free.
  void labels() {
    svg_->open_group("labels");
    for (const StateSpan& s : spans_) {
      if (!visible(s.start, s.end)) continue;
      const double left = stay_inside(x(s.start)), right = stay_inside(x(s.end));
      const std::string colour = phase_of(s.state).colour;
      for (const std::string_view text : {std::string_view(s.name), short_name(s.state)}) {
        if (text.empty() || right - left < drawing::text_width(text, text_) + 5) continue;
        note(text, {.size = text_, .anchor = drawing::Anchor::kMiddle, .fill = drawing::text_colour_on(colour)},
             {(left + right) / 2, top(s.node) + kBar + 11.5});
        break;
      }
    }
    for (const auto& p : data_.power) {  // keeps notes off the markers
      const TrueTime at = p.stamp.true_time;
      if (visible(at, at)) space_.take({x(at) - 5, top(p.stamp.node) + kNotes - 8, 10, 11});
    }
    std::optional<std::pair<NodeId, TrueTime>> noted;
    for (const auto& s : data_.symbols) {
      const NodeId node = s.stamp.node;
      const TrueTime start = s.stamp.true_time;
      if (!visible(start, s.end.true_time) || noted == std::pair(node, start)) continue;  // one note for both channels
      noted = std::pair(node, start);
      note(symbol_name(s.kind), {.size = text_}, {x(start), top(node) + kNotes});
    }
    svg_->close_group();
  }

  void note(std::string_view text, const drawing::TextStyle& style, drawing::Point at) {
    const std::array<drawing::Point, 1> candidates{at};
    if (const auto p = space_.place(text, style, candidates, plot_)) svg_->text(*p, text, style);
  }

  const drawing::Names& names_;
  const StartupData& data_;
  drawing::Sheet sheet_;
  double text_;  // size
  std::string title_;
  std::vector<std::string> title_lines_, leader_lines_;
  TrueTime from_, to_;
  std::vector<StateSpan> spans_;
  drawing::FaultLanes faults_;
  std::optional<LeadingNode> leader_;
  std::vector<drawing::LegendEntry> legend_;
  std::map<std::int64_t, TrueTime> cycles_;
  std::map<NodeId, double> node_top_;
  std::set<NodeId> on_flexray_;
  drawing::Area plot_;
  drawing::LabelSpace space_;
  drawing::Svg* svg_ = nullptr;
};

}  // namespace

std::string paint_startup(const drawing::Names& names, const StartupData& data, Duration cycle, TrueTime from,
                          TrueTime to, const drawing::Sheet& sheet) {
  return StartupPainter(names, data, cycle, from, to, sheet).picture();
}

}  // namespace ttf::report::startup
