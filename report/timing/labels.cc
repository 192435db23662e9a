#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/drawing/axes.h"
#include "report/drawing/svg.h"
#include "report/timing/canvas.h"
#include "report/timing/transfers.h"

namespace ttf::report::timing {
namespace {

class LabelPainter {
 public:
  LabelPainter(drawing::Svg& svg, const TimingCanvas& canvas)
      : svg_(svg), canvas_(canvas), text_(canvas.sheet.text(TimingCanvas::kText)) {}

  void draw(const std::vector<Transfer>& transfers) {
    svg_.open_group("labels");
    for (const auto& m : canvas_.data.measurements) {
      if (!canvas_.visible(m.at, m.at)) continue;
      const double px = canvas_.x(m.at), py = canvas_.y({LaneKey::Kind::kSensor, index_of(m.id.sensor), 0});
      const std::string text = fmt::format("{}", m.id.sequence);
      const std::array<drawing::Point, 2> at{drawing::Point{px + 7, py + 4},
                                             drawing::Point{px - 7 - drawing::text_width(text, text_), py + 4}};
      label(text, {.size = text_, .halo = true}, at, m.at);
    }
    for (const auto& s : canvas_.data.steps) {
      const recording::records::TaskRun* box = nullptr;
      const std::int64_t at = s.stamp.true_time.ns;
      for (const auto& r : canvas_.data.executions)
        if (r.start.node == s.stamp.node && r.start.true_time.ns <= at + 2000 && at <= r.end.true_time.ns + 2000 &&
            (box == nullptr || r.start.true_time > box->start.true_time))
          box = &r;
      if (box == nullptr) continue;
      in_box(fmt::format("{}", s.step), box->start.true_time, box->end.true_time,
             canvas_.y({LaneKey::Kind::kTask, index_of(box->start.node), box->task}), "#c9d7e6");
    }
    // A number alone does not name its list. On a screen pointing at it does.
    const bool brief_counts = !canvas_.tags.on() && !canvas_.sheet.on_paper();
    for (const Transfer& t : transfers) {
      if (!canvas_.visible(t.start, t.end)) continue;
      const std::string full = fmt::format("{} {}", canvas_.names.pdu(t.pdu), t.sequence),
                        brief = fmt::format("{}", t.sequence);
      if (t.lane.kind == LaneKey::Kind::kCan) {
        const std::string behind = drawing::tint(pdu_colour(canvas_.names, t.pdu), 0.55);
        if (!in_box(full, t.start, t.end, canvas_.y(t.lane), behind) && brief_counts)
          in_box(brief, t.start, t.end, canvas_.y(t.lane), behind);
        continue;
      }
      // If channel A carries the same list, B needs no label.
      if (t.lane.index == 1 && std::ranges::any_of(transfers, [&](const Transfer& o) {
            return o.lane.kind == t.lane.kind && o.lane.index == 0 && o.pdu == t.pdu && o.sequence == t.sequence &&
                   o.start == t.start;
          }))
        continue;
      const double baseline = canvas_.y(t.lane) + 4 - kBox / 2 - 4;
      const std::array<drawing::Point, 1> at{drawing::Point{canvas_.inside(canvas_.x(t.start)), baseline}};
      const drawing::TextStyle style{.size = canvas_.sheet.text(9), .halo = true};
      if (canvas_.tags.on())
        label(full, style, at, t.start);
      else if (const auto p = space_.place(full, style, at, canvas_.plot))
        svg_.text(*p, full, style);
      else if (brief_counts)
        label(brief, style, at, t.start);
    }
    svg_.close_group();
  }

 private:
  static constexpr double kBox = TimingCanvas::kBox;

  void label(const std::string& text, const drawing::TextStyle& style, std::span<const drawing::Point> candidates,
             TrueTime at) {
    const auto p = space_.place(text, style, candidates, canvas_.plot);
    if (!p && !canvas_.tags.on()) return;
    svg_.tag_next(canvas_.tags.at(at) + canvas_.tags.label(drawing::text_width(text, style.size), p.has_value()));
    svg_.text(p.value_or(candidates.front()), text, style);
  }

  bool in_box(const std::string& text, TrueTime start, TrueTime end, double centre, std::string_view behind) {
    const double left = canvas_.inside(canvas_.x(start)), right = canvas_.inside(canvas_.x(end));
    const bool fits = right - left >= drawing::text_width(text, text_) + 5;
    if (!fits && !canvas_.tags.on()) return false;
    const drawing::TextStyle style{
        .size = text_, .anchor = drawing::Anchor::kMiddle, .fill = drawing::text_colour_on(behind)};
    const std::array<drawing::Point, 1> at{drawing::Point{(left + right) / 2, centre + 3.5}};
    const auto p = fits ? space_.place(text, style, at, canvas_.plot) : std::nullopt;
    if (!p && !canvas_.tags.on()) return false;
    svg_.tag_next(canvas_.tags.span(start, end) + canvas_.tags.label(drawing::text_width(text, text_), p.has_value()));
    svg_.text(at.front(), text, style);
    return p.has_value();
  }

  drawing::Svg& svg_;
  const TimingCanvas& canvas_;
  const double text_;  // size
  drawing::LabelSpace space_;
};

}  // namespace

void draw_labels(drawing::Svg& svg, const TimingCanvas& canvas, const std::vector<Transfer>& transfers) {
  LabelPainter(svg, canvas).draw(transfers);
}

}  // namespace ttf::report::timing
