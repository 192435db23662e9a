#include "report/plots/trade_off_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/drawing/axes.h"

namespace ttf::report::plots {
namespace {

namespace trade = schedules::synthesis::trade;
using drawing::Area;
using drawing::Extent;
using drawing::Marker;
using drawing::Point;
using trade::TradeOffPoint;
using trade::WayPiece;

constexpr double kTradeMargin = 12, kTradeTitle = 38, kYNumbersRoom = 62, kXLabelsRoom = 40;
constexpr double kTradeWidth = 250, kTradeHeight = 210, kWayBarHeight = 18;
constexpr std::string_view kWork = drawing::kSkyBlue, kRest = drawing::kOrange, kClocks = drawing::kGrey;

double age_ms(const TradeOffPoint& point) { return in_ms(point.worst_age); }
double cycle_ms(const TradeOffPoint& point) { return in_ms(point.candidate.cycle); }

std::string words(const TradeOffPoint& point) {
  std::string text = fmt::format("a cycle of {:g} ms, worst age {:.3f} ms", cycle_ms(point), age_ms(point));
  text += point.proven() ? "" : fmt::format(" (not below {:.3f} ms)", in_ms(point.bound));
  return text + fmt::format(", {} of {} slots", point.slots, point.static_slots);
}

class TradeOffPainter {
 public:
  TradeOffPainter(const TradeOffView& view, const drawing::Sheet& sheet)
      : view_(view), panels_(view.judged.empty() ? 2 : 3), svg_(width(), height(), view.title, sheet) {}

  std::string draw() {
    svg_.text({kTradeMargin, 20}, view_.title, {.size = 14, .bold = true});
    draw_cycles(panel(0));
    draw_slots(panel(1));
    if (panels_ == 3) draw_judged(panel(2));
    double top = kTradeTitle + kTradeHeight + kXLabelsRoom + 24;
    draw_legend({kTradeMargin, top});
    top += 30;
    for (const trade::BindingWay& way : view_.ways) top = draw_way(way, top);
    return svg_.str();
  }

 private:
  double width() const { return panels_ * (kTradeWidth + kYNumbersRoom) + 2 * kTradeMargin; }
  double height() const {
    double all = kTradeTitle + kTradeHeight + kXLabelsRoom + 54 + kTradeMargin;
    for (const trade::BindingWay& way : view_.ways) all += way_height(way);
    return all;
  }
  static double way_height(const trade::BindingWay& way) {
    return kWayBarHeight + 24 + drawing::kLineHeight * static_cast<double>((way.pieces.size() + 1) / 2) + 10;
  }
  Area panel(int i) const {
    return {kTradeMargin + kYNumbersRoom + i * (kTradeWidth + kYNumbersRoom), kTradeTitle, kTradeWidth - 10,
            kTradeHeight};
  }
  static Extent extent(const std::vector<TradeOffPoint>& points, double (*of)(const TradeOffPoint&), double least) {
    Extent found;
    for (const TradeOffPoint& point : points) found.add(of(point));
    return found.padded(0.06, least);
  }
  const TradeOffPoint* youngest() const {
    const auto& all = view_.trade_off.candidates;
    const auto least = std::min_element(all.begin(), all.end(),
                                        [](const auto& a, const auto& b) { return a.worst_age < b.worst_age; });
    return least == all.end() ? nullptr : &*least;
  }
  void mark(const drawing::PlotFrame& frame, const TradeOffPoint& point, double x, double y) {
    const bool best = &point == youngest();
    svg_.marker(best ? Marker::kDiamond : Marker::kCircle, frame.at(x, y), best ? 6 : 2.2,
                {.fill = best ? drawing::kVermilion : drawing::kBlue}, words(point), "candidate");
  }

  void draw_cycles(const Area& area) {
    const auto& points = view_.trade_off.candidates;
    const drawing::PlotFrame frame(area, extent(points, cycle_ms, 0.1), extent(points, age_ms, 0.1));
    frame.draw(svg_, "length of the cycle [ms]", "least worst age [ms]");
    for (const TradeOffPoint& point : points) mark(frame, point, cycle_ms(point), age_ms(point));
  }

  void draw_slots(const Area& area) {
    const auto& front = view_.trade_off.front;
    const drawing::PlotFrame frame(area,
                                   extent(
                                       front, [](const TradeOffPoint& p) { return static_cast<double>(p.slots); }, 2),
                                   extent(front, age_ms, 0.1));
    frame.draw(svg_, "static slots in use", "least worst age [ms]");
    std::vector<Point> steps;
    for (const TradeOffPoint& point : front) {
      const Point at = frame.at(point.slots, age_ms(point));
      if (!steps.empty()) steps.push_back({at.x, steps.back().y});
      steps.push_back(at);
    }
    if (steps.size() > 1) svg_.polyline(steps, {.stroke = drawing::kBlue, .width = 1.5}, false, {}, "front");
    for (const TradeOffPoint& point : front)
      svg_.marker(Marker::kSquare, frame.at(point.slots, age_ms(point)), 4,
                  {.fill = point.proven() ? drawing::kBlue : "#ffffff", .stroke = drawing::kBlue}, words(point),
                  "step");
  }

  void draw_judged(const Area& area) {
    std::vector<TradeOffPoint> judged;
    for (const TradeOffPoint& point : view_.trade_off.candidates)
      if (point.judged) judged.push_back(point);
    const drawing::PlotFrame frame(area, extent(judged, age_ms, 0.1),
                                   extent(
                                       judged, [](const TradeOffPoint& p) { return *p.judged; }, 1e-6));
    frame.draw(svg_, "least worst age [ms]", view_.judged);
    for (const TradeOffPoint& point : view_.trade_off.candidates)
      if (point.judged) mark(frame, point, age_ms(point), *point.judged);
  }

  void draw_legend(Point at) {
    using Kind = drawing::LegendEntry::Kind;
    const std::vector<drawing::LegendEntry> entries{
        {Kind::kMarker, "a length of the cycle, and rates", std::string(drawing::kBlue), Marker::kCircle, true},
        {Kind::kMarker, "the least age of all", std::string(drawing::kVermilion), Marker::kDiamond, true},
        {Kind::kMarker, "proven best with so many slots; else empty", std::string(drawing::kBlue), Marker::kSquare,
         true},
        {Kind::kBox, "work", std::string(kWork)},
        {Kind::kBox, "rest", std::string(kRest)}};
    drawing::draw_legend(svg_, at, width() - 2 * kTradeMargin, entries);
  }

  static std::string_view colour(WayPiece::Kind kind) {
    if (kind == WayPiece::Kind::kWorks) return kWork;
    return kind == WayPiece::Kind::kRests ? kRest : kClocks;
  }

  // All bars have one scale.
  double longest_ms() const {
    double longest = 1e-9;
    for (const trade::BindingWay& way : view_.ways) longest = std::max(longest, in_ms(way.worst_age));
    return longest;
  }

  // Draws a bar of numbered pieces, and below it what they are. Returns where the next one begins.
  double draw_way(const trade::BindingWay& way, double top) {
    const double across = width() - 2 * kTradeMargin;
    svg_.text({kTradeMargin, top + 12}, fmt::format("{}: {:.3f} ms at most", way.chain, in_ms(way.worst_age)),
              {.bold = true});
    const double bar = top + 18, per_ms = across / longest_ms();
    const double list = bar + kWayBarHeight + 16;
    const std::size_t rows = (way.pieces.size() + 1) / 2;
    double x = kTradeMargin;
    for (std::size_t i = 0; i < way.pieces.size(); ++i) {
      const WayPiece& piece = way.pieces[i];
      const double wide = std::max(0.0, in_ms(piece.time) * per_ms);
      const std::string label = fmt::format("{} {:.3f}", piece.name, in_ms(piece.time));
      svg_.rect({x, bar, wide, kWayBarHeight}, {.fill = colour(piece.kind), .stroke = "#000000", .width = 0.5}, label,
                "piece");
      if (wide > 16)
        svg_.text({x + wide / 2, bar + 13}, fmt::format("{}", i + 1), {.anchor = drawing::Anchor::kMiddle});
      x += wide;
      const Point at{kTradeMargin + (i < rows ? 0 : across / 2),
                     list + drawing::kLineHeight * static_cast<double>(i < rows ? i : i - rows)};
      svg_.text(at, fmt::format("{:>2}  {}{}", i + 1, piece.kind == WayPiece::Kind::kRests ? "rests: " : "", label));
    }
    return top + way_height(way);
  }

  const TradeOffView& view_;
  int panels_;
  drawing::Svg svg_;
};

}  // namespace

std::string trade_off_svg(const TradeOffView& view, const drawing::Sheet& sheet) {
  if (view.trade_off.candidates.empty())
    return drawing::empty_picture(view.title, "no candidate has a schedule", sheet);
  return TradeOffPainter(view, sheet).draw();
}

}  // namespace ttf::report::plots
