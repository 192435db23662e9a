#include "report/timing_painter.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "report/axes.h"
#include "report/timing_cycles.h"
#include "report/timing_faults.h"
#include "report/timing_problems.h"
#include "report/timing_tags.h"
#include "report/timing_ways.h"

namespace ttf::report {
namespace {

double lane_height(const Lane& lane) {
  switch (lane.key.kind) {
    case LaneKey::Kind::kSensor:
      return 28;
    case LaneKey::Kind::kChannel:
      return 40;
    case LaneKey::Kind::kCan:
    case LaneKey::Kind::kTask:
      break;
  }
  return 30;
}

// Everything needed to draw one picture; lives for one call of svg().
class TimingPainter {
  static constexpr double kPixelsPerMs = 14, kLeastPlot = 1000, kMostPlot = 5600;
  static constexpr double kTop = 62, kTopInPage = 28, kBox = 14, kText = 9.5;

 public:
  TimingPainter(const Names& names, const TimingData& data, Duration cycle, TrueTime from, TrueTime to, TimingUse use)
      : names_(names),
        data_(data),
        cycle_(cycle),
        from_(from),
        to_(to),
        tags_(use),
        transfers_(transfers_of(data)),
        ways_(measurement_ways(data, names, transfers_)),
        images_(image_ways(data, names, transfers_)),
        faults_(data, names, from, to) {
    std::vector<Way> all = ways_;
    all.insert(all.end(), images_.begin(), images_.end());
    lanes_ = lanes_of(data, names, all);
    const double ms = (to - from).seconds() * 1e3;
    plot_.x = faults_.label_width() > 0 ? faults_.label_width() + 24 : 24;
    for (const Lane& lane : lanes_) plot_.x = std::max(plot_.x, text_width(lane.label, 11) + 24);
    // A page's script makes it as wide as there is room.
    plot_.width = tags_.on() ? kLeastPlot : std::clamp(ms * kPixelsPerMs, kLeastPlot, kMostPlot);
    plot_.y = tags_.on() ? kTopInPage : kTop;
    double y = plot_.y + faults_.height();
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      if (i > 0 && lanes_[i].section != lanes_[i - 1].section) y += 10;
      centre_[lanes_[i].key] = y + lane_height(lanes_[i]) / 2;
      y += lane_height(lanes_[i]);
    }
    plot_.height = y - plot_.y;
    legend_ = timing_legend(data_, names_, ways_, !images_.empty(), from_, to_);
    for (const auto& r : data_.on_channel)
      if (const ChannelMark mark = channel_mark(r, names_);
          visible(mark.start, mark.end) && centre_.contains({LaneKey::Kind::kChannel, mark.channel, 0}))
        marks_.push_back(mark);
    problems_.emplace(data_, names_, lanes_, from_, to_);
    mark_legend();
  }

  std::string picture() {
    const double legend_width = plot_.width + plot_.x - 24;
    const double legend_top = plot_.y + plot_.height + 46;
    const double height = legend_top + legend_height(legend_, legend_width) + 12;
    const std::string title = fmt::format("{}: {} ms to {} ms", names_.run.empty() ? "Timing diagram" : names_.run,
                                          number(in_ms(from_)), number(in_ms(to_)));
    Svg svg(plot_.x + plot_.width + 24, height, title);
    svg_ = &svg;
    if (!tags_.on()) svg.text({24, 22}, title, {.size = 14, .bold = true});
    grid();
    faults_.draw_labels(svg, plot_);
    svg.open_group("events", plot_);
    faults_.draw(svg, plot_, [&](TrueTime t) { return x(t); }, tags_);
    slots();
    channel_marks();
    can();
    tasks();
    svg.close_group();
    svg.open_group("ways", plot_);
    for (const Way& way : images_) draw(way);
    for (const Way& way : ways_) draw(way);
    svg.close_group();
    svg.open_group("events", plot_);
    instants();
    problems_->draw(svg, [&](const LaneKey& lane, TrueTime at) { return Point{x(at), y(lane)}; }, tags_);
    svg.close_group();
    labels();
    svg.tag_next(tags_.span(from_, to_));
    svg.rect(plot_, {.stroke = kBlack, .width = 0.8}, {}, tags_.on() ? "plot" : "");
    draw_legend(svg, {24, legend_top}, legend_width, legend_);
    return svg.str();
  }

 private:
  double x(TrueTime t) const {
    return plot_.x +
           static_cast<double>((t - from_).ns) / static_cast<double>((to_ - from_).ns) * plot_.width;
  }
  double y(const LaneKey& lane) const { return centre_.at(lane); }
  bool visible(TrueTime start, TrueTime end) const { return start < to_ && end >= from_; }
  // In a hover's words, which a page's script adds itself.
  std::string times(TrueTime start, TrueTime end) const {
    return tags_.on() ? "" : fmt::format(", {} ms to {} ms", number(in_ms(start)), number(in_ms(end)));
  }
  double stay_inside(double px) const { return std::clamp(px, plot_.x, plot_.x + plot_.width); }

  void grid() {
    svg_->open_group("grid");
    const auto starts = cycle_starts(data_, cycle_, from_, to_);
    LabelSpace above;
    for (auto it = starts.begin(); it != starts.end(); ++it) {
      const auto next = std::next(it);
      const TrueTime end = next != starts.end() ? next->second : it->second + cycle_;
      if (!visible(it->second, end)) continue;
      const double left = stay_inside(x(it->second)), right = stay_inside(x(end));
      if (it->first % 2 != 0) {
        svg_->tag_next(tags_.span(it->second, end));
        svg_->rect({left, plot_.y, right - left, plot_.height}, {.fill = "#f4f4f4"}, {}, "cycle");
      }
      if (it->second >= from_) {
        svg_->tag_next(tags_.at(it->second));
        svg_->line({left, plot_.y - 4}, {left, plot_.y + plot_.height}, {.stroke = "#b8b8b8", .width = 0.7},
                   "cycle");
      }
      const std::string label = fmt::format("{}", it->first);
      const TextStyle style{.size = 10, .anchor = Anchor::kMiddle, .fill = "#444444"};
      Area area = text_area({(left + right) / 2, plot_.y - 7}, label, style);
      area.x -= 4, area.width += 8;
      if (it->first < 0) continue;
      const bool room = area.x >= plot_.x && area.x + area.width <= plot_.x + plot_.width && above.claim(area);
      if (!room && !tags_.on()) continue;
      svg_->tag_next(tags_.span(it->second, end) + tags_.label(area.width, room));
      svg_->text({(left + right) / 2, plot_.y - 7}, label, style);
    }
    if (!starts.empty())
      svg_->text({plot_.x - 10, plot_.y - 7}, "cycle",
                 {.size = 10, .anchor = Anchor::kEnd, .fill = "#444444"});
    int section = lanes_.front().section;
    for (const Lane& lane : lanes_) {
      const double centre = y(lane.key), half = lane_height(lane) / 2;
      if (lane.section != section) {
        section = lane.section;
        svg_->line({12, centre - half - 5}, {plot_.x + plot_.width, centre - half - 5},
                   {.stroke = "#999999", .width = 0.8});
      }
      svg_->line({plot_.x, centre}, {plot_.x + plot_.width, centre}, {.stroke = "#e0e0e0", .width = 0.7});
      svg_->text({plot_.x - 10, centre + 4}, lane.label, {.size = 11, .anchor = Anchor::kEnd});
    }
    if (tags_.on()) {   // of its own: the script draws another
      svg_->close_group();
      svg_->open_group("time");
    }
    draw_time_axis(*svg_, plot_, {in_ms(from_), in_ms(to_)});
    svg_->close_group();
  }

  void slots() {
    for (const auto& f : data_.slot_frames) {
      if (!visible(f.start, f.end)) continue;
      const double centre = y({LaneKey::Kind::kChannel, f.channel, 0}) + 4;
      const double width = std::max(1.0, x(f.end) - x(f.start));
      const std::string colour = pdu_colour(names_, f.pdu);
      const std::string hover = fmt::format("slot {}, cycle {}, {}{} #{} fragment {}, from {}", f.slot,
                                            f.cycle, f.null_frame ? "null frame, " : "", names_.pdu(f.pdu),
                                            f.sequence, f.fragment, names_.node(f.node));
      const Area area{x(f.start), centre - kBox / 2, width, kBox};
      svg_->tag_next(tags_.span(f.start, f.end) +
                     (f.pdu == kNoPdu ? "" : tags_.list(names_.sensor_of(f.pdu), f.sequence)));
      if (f.null_frame && tags_.on()) {
        svg_->rect(area, {.fill = "#ffffff", .stroke = kGrey, .width = 0.3}, hover, "null");
      } else if (f.null_frame && width > 3) {
        svg_->rect(area, {.fill = "#ffffff", .stroke = kGrey, .width = 0.5}, hover, "null");
      } else if (f.null_frame) {
        // Side walls of neighbours would fill a narrow box: only its top and bottom then.
        svg_->rect(area, {.fill = "#ffffff"}, hover, "null");
        for (const double edge : {area.y, area.y + kBox})
          svg_->line({area.x, edge}, {area.x + width, edge}, {.stroke = kGrey, .width = 0.6});
      } else {
        svg_->rect(area, {.fill = colour, .stroke = width > 4 ? "#444444" : "none", .width = 0.5}, hover,
                   f.pdu == kNoPdu ? "status" : "frame");
      }
    }
  }

  // Over the frames: what came of them.
  void channel_marks() {
    for (const ChannelMark& mark : marks_) {
      const double centre = y({LaneKey::Kind::kChannel, mark.channel, 0}) + 4;
      const double width = std::max(2.0, x(mark.end) - x(mark.start));
      svg_->tag_next(mark.missing ? tags_.at(mark.start) : tags_.span(mark.start, mark.end));
      if (mark.missing)
        svg_->marker(Marker::kCross, {x(mark.start) + width / 2, centre}, 9, {.stroke = kVermilion, .width = 1.6}, mark.words,
                     "missing");
      else
        svg_->rect({x(mark.start), centre - kBox / 2 - 1.5, width, kBox + 3},
                   {.fill = "none", .stroke = kVermilion, .width = 1.4}, mark.words, "changed");
    }
  }

  void mark_legend() {
    using K = LegendEntry::Kind;
    faults_.add_to(legend_);
    const auto any = [&](bool missing) {
      return std::ranges::any_of(marks_, [&](const ChannelMark& mark) { return mark.missing == missing; });
    };
    if (any(false)) legend_.push_back({K::kBox, std::string(kChangedFrameWords), std::string(kVermilion), {}, false});
    if (any(true)) legend_.push_back({K::kMarker, std::string(kMissingFrameWords), std::string(kVermilion), Marker::kCross});
    problems_->add_to(legend_);
  }

  void can() {
    for (const Transfer& t : transfers_) {
      if (t.lane.kind != LaneKey::Kind::kCan || !visible(t.start, t.end)) continue;
      const std::string colour = pdu_colour(names_, t.pdu);
      svg_->tag_next(tags_.span(t.start, t.end) + tags_.list(names_.sensor_of(t.pdu), t.sequence));
      svg_->rect({x(t.start), y(t.lane) - kBox / 2, std::max(1.5, x(t.end) - x(t.start)), kBox},
                 {.fill = tint(colour, 0.55), .stroke = colour, .width = 0.9},
                 fmt::format("{} #{}{}", names_.pdu(t.pdu), t.sequence, times(t.start, t.end)),
                 "transfer");
    }
  }

  void tasks() {
    for (const auto& r : data_.runs) {
      if (!visible(r.activated, r.end)) continue;
      const double centre = y({LaneKey::Kind::kTask, index_of(r.node), r.task});
      if (r.activated < r.start) {
        svg_->tag_next(tags_.span(r.activated, r.start));
        svg_->line({x(r.activated), centre}, {x(r.start), centre}, {.stroke = "#666666", .width = 1.5});
        svg_->tag_next(tags_.at(r.activated));
        svg_->line({x(r.activated), centre - 4}, {x(r.activated), centre + 4},
                   {.stroke = "#666666", .width = 1.0});
      }
      const double width = std::max(1.5, x(r.end) - x(r.start));
      svg_->tag_next(tags_.span(r.start, r.end));
      svg_->rect(
          {x(r.start), centre - kBox / 2, width, kBox},
          {.fill = r.deadline_met ? "#c9d7e6" : kDeadlineMissed,
           .stroke = r.deadline_met ? "#5b7083" : kBlack,
           .width = r.deadline_met ? 0.6 : 1.6},
          fmt::format("{}: {}{}{}", names_.node(r.node), names_.task(r.node, r.task), times(r.start, r.end),
                      r.deadline_met ? "" : ", deadline missed"),
          r.deadline_met ? "task" : "task missed");
    }
  }

  void instants() {
    for (const auto& m : data_.measurements) {
      if (!visible(m.at, m.at)) continue;
      svg_->tag_next(tags_.at(m.at) + tags_.list(m.id.sensor, m.id.sequence));
      svg_->marker(Marker::kDownTriangle, {x(m.at), y({LaneKey::Kind::kSensor, index_of(m.id.sensor), 0})}, 10,
                   {.fill = sensor_colour(names_, m.id.sensor), .stroke = "#ffffff", .width = 0.8},
                   fmt::format("{} #{}{}", names_.sensor(m.id.sensor), m.id.sequence,
                               tags_.on() ? " is measured" : fmt::format(" at {} ms", number(in_ms(m.at)))),
                   "measured");
    }
    for (const Way& way : ways_) {
      if (!way.dropped || !visible(way.last.at, way.last.at)) continue;
      svg_->tag_next(tags_.at(way.last.at) + tags_.list(way.id.sensor, way.id.sequence));
      svg_->marker(Marker::kCross, {x(way.last.at), y(way.last.lane)}, 11, {.stroke = kBlack, .width = 2.2}, "dropped",
                   "dropped");
    }
  }

  void draw(const Way& way) {
    const bool image = way.id.sensor == kNoSensor;
    const std::string colour = image ? std::string(kBlack) : sensor_colour(names_, way.id.sensor);
    const std::string hover = image ? fmt::format("image #{}", way.id.sequence)
                                    : fmt::format("{} #{}{}", names_.sensor(way.id.sensor), way.id.sequence,
                                                  way.out_of_sequence ? ", out of sequence" : "");
    for (const Leg& leg : way.legs) {
      if (!visible(leg.from.at, leg.to.at)) continue;
      svg_->tag_next(tags_.span(leg.from.at, leg.to.at) + tags_.list(way.id.sensor, way.id.sequence) +
                     tags_.since(way.legs.front().from.at));
      if (leg.kind == Leg::Kind::kStored) {
        svg_->arrow({x(leg.from.at), y(leg.from.lane)}, {x(leg.to.at), y(leg.to.lane)}, {.stroke = colour},
                    hover, "arrow image");
        continue;
      }
      const bool same = leg.from.lane == leg.to.lane;
      const double a = y(leg.from.lane), b = y(leg.to.lane), down = same ? 0 : b > a ? 1 : -1;
      const auto edge = [&](const LaneKey& lane) {
        return lane.kind == LaneKey::Kind::kSensor ? 5.0 : kBox / 2;
      };
      const auto shift = [](const LaneKey& lane) { return lane.kind == LaneKey::Kind::kChannel ? 4.0 : 0.0; };
      const Point p{x(leg.from.at),
                    a + shift(leg.from.lane) + (same ? kBox / 2 + 3 : down * edge(leg.from.lane))};
      const Point q{x(leg.to.at), b + shift(leg.to.lane) + (same ? kBox / 2 + 3 : -down * edge(leg.to.lane))};
      svg_->arrow(p, q,
                  {.stroke = colour,
                   .width = way.out_of_sequence ? 2.0
                            : image             ? 1.0
                                                : 1.2,
                   .dash = leg.kind == Leg::Kind::kHeld ? "1.5 2.5"
                           : way.out_of_sequence        ? "5 3"
                                                        : ""},
                  hover,
                  image                 ? "arrow image"
                  : way.out_of_sequence ? "arrow late"
                                        : "arrow");
    }
  }

  // Labels come last and only where nothing is in the way.
  void label(const std::string& text, const TextStyle& style, std::span<const Point> candidates, TrueTime at) {
    const auto p = space_.place(text, style, candidates, plot_);
    if (!p && !tags_.on()) return;
    svg_->tag_next(tags_.at(at) + tags_.label(text_width(text, style.size), p.has_value()));
    svg_->text(p.value_or(candidates.front()), text, style);
  }

  void labels() {
    svg_->open_group("labels");
    for (const auto& m : data_.measurements) {
      if (!visible(m.at, m.at)) continue;
      const double px = x(m.at), py = y({LaneKey::Kind::kSensor, index_of(m.id.sensor), 0});
      const std::string text = fmt::format("{}", m.id.sequence);
      const std::array<Point, 2> at{Point{px + 7, py + 4}, Point{px - 7 - text_width(text, kText), py + 4}};
      label(text, {.size = kText, .halo = true}, at, m.at);
    }
    for (const auto& s : data_.steps) {
      const TimingData::Run* box = nullptr;
      for (const auto& r : data_.runs)
        if (r.node == s.node && r.start.ns <= s.at.ns + 2000 && s.at.ns <= r.end.ns + 2000 &&
            (box == nullptr || r.start > box->start))
          box = &r;
      if (box == nullptr) continue;
      in_box(fmt::format("{}", s.step), box->start, box->end,
             y({LaneKey::Kind::kTask, index_of(box->node), box->task}), "#c9d7e6");
    }
    for (const Transfer& t : transfers_) {
      if (!visible(t.start, t.end)) continue;
      const std::string full = fmt::format("{} {}", names_.pdu(t.pdu), t.sequence),
                        brief = fmt::format("{}", t.sequence);
      if (t.lane.kind == LaneKey::Kind::kCan) {
        if (!in_box(full, t.start, t.end, y(t.lane), tint(pdu_colour(names_, t.pdu), 0.55)) && !tags_.on())
          in_box(brief, t.start, t.end, y(t.lane), tint(pdu_colour(names_, t.pdu), 0.55));
        continue;
      }
      // Where channel A carries the same list, B needs no label of its own.
      if (t.lane.index == 1 && std::ranges::any_of(transfers_, [&](const Transfer& o) {
            return o.lane.kind == t.lane.kind && o.lane.index == 0 && o.pdu == t.pdu &&
                   o.sequence == t.sequence && o.start == t.start;
          }))
        continue;
      const double baseline = y(t.lane) + 4 - kBox / 2 - 4;
      const std::array<Point, 1> at{Point{stay_inside(x(t.start)), baseline}};
      const TextStyle style{.size = 9, .halo = true};
      if (tags_.on())
        label(full, style, at, t.start);
      else if (const auto p = space_.place(full, style, at, plot_))
        svg_->text(*p, full, style);
      else
        label(brief, style, at, t.start);
    }
    svg_->close_group();
  }

  bool in_box(const std::string& text, TrueTime start, TrueTime end, double centre, std::string_view behind) {
    const double left = stay_inside(x(start)), right = stay_inside(x(end));
    const bool fits = right - left >= text_width(text, kText) + 5;
    if (!fits && !tags_.on()) return false;
    const TextStyle style{.size = kText, .anchor = Anchor::kMiddle, .fill = text_colour_on(behind)};
    const std::array<Point, 1> at{Point{(left + right) / 2, centre + 3.5}};
    const auto p = fits ? space_.place(text, style, at, plot_) : std::nullopt;
    if (!p && !tags_.on()) return false;
    svg_->tag_next(tags_.span(start, end) + tags_.label(text_width(text, kText), p.has_value()));
    svg_->text(at.front(), text, style);
    return p.has_value();
  }

  const Names& names_;
  const TimingData& data_;
  Duration cycle_;
  TrueTime from_, to_;
  TimingTags tags_;
  std::vector<Transfer> transfers_;
  std::vector<Way> ways_, images_;
  FaultLanes faults_;
  std::vector<ChannelMark> marks_;
  std::optional<ProblemMarks> problems_;   // when the lanes are known
  std::vector<Lane> lanes_;
  std::vector<LegendEntry> legend_;
  std::map<LaneKey, double> centre_;
  Area plot_;
  LabelSpace space_;
  Svg* svg_ = nullptr;
};

}  // namespace

std::string paint_timing(const Names& names, const TimingData& data, Duration cycle, TrueTime from, TrueTime to,
                         TimingUse use) {
  return TimingPainter(names, data, cycle, from, to, use).picture();
}

}  // namespace ttf::report
