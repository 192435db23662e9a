#include "report/plots/lateness_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/drawing/axes.h"

namespace ttf::report::plots {
namespace {

using recording::records::BinnedDurations;

constexpr drawing::Area kPlot{112, 0, 860, 420};  // its top is below the legend
constexpr std::string_view kFloorDash = "6 3";

// The distribution of the wake-ups of one node, or of the floor.
struct Curve {
  std::string name, colour, dash;
  double width = 1.4;
  BinnedDurations late;

  double share_from(std::size_t bin) const {
    return static_cast<double>(late.count_from(bin)) / static_cast<double>(late.count());
  }
  // Returns points (microseconds, share of wake-ups at least so late), both as logarithms of base 10,
  // wherever the share changes. Empty if every wake-up was less than a microsecond late.
  std::vector<drawing::Point> points() const {
    std::vector<drawing::Point> points;
    const auto counts = late.counts();
    for (std::size_t bin = 1; bin < counts.size(); ++bin)
      if (bin == 1 || counts[bin - 1] > 0 || counts[bin] > 0)
        points.push_back({std::log10(in_us(recording::records::lateness_from(bin))), std::log10(share_from(bin))});
    if (!points.empty())
      points.push_back({std::max(points.back().x, std::log10(std::max(1.0, in_us(late.longest())))),
                        -std::log10(static_cast<double>(late.count()))});
    return points;
  }
  std::string words() const {
    return fmt::format("{}: {} wake-ups, half of them later than {} us, one in 1000 than {} us, the latest by {} us",
                       name, late.count(), drawing::number(in_us(late.quantile(500))),
                       drawing::number(in_us(late.quantile(999))), drawing::number(in_us(late.longest())));
  }
};

std::vector<Curve> curves_of(const std::map<NodeId, recording::exports::NodeLateness>& nodes,
                             const drawing::Names& names) {
  std::vector<Curve> curves;
  Curve floor{
      "the machine's floor: a plain periodic thread", std::string(drawing::kBlack), std::string(kFloorDash), 2.0, {}};
  for (const auto& [node, late] : nodes) {
    floor.late.add(late.floor);
    if (!late.wake_ups.empty())
      curves.push_back({names.node(node), drawing::palette(curves.size()), "", 1.4, late.wake_ups});
  }
  if (!floor.late.empty()) curves.push_back(std::move(floor));
  return curves;
}

std::string power_of_ten(int exponent) {
  return exponent <= 6 ? fmt::format("{:.0f}", std::pow(10.0, exponent)) : fmt::format("1e{}", exponent);
}

// The axes in decades: microseconds from 1 to the right, shares from 1 downwards.
struct LogFrame {
  drawing::Area area;
  int decades_x = 3, decades_y = 3;

  drawing::Point at(drawing::Point log) const {
    return {area.x + log.x / decades_x * area.width, area.y - log.y / decades_y * area.height};
  }
  void draw(drawing::Svg& svg) const {
    const double bottom = area.y + area.height;
    drawing::LabelSpace numbers;
    svg.open_group("axes");
    svg.rect(area, {.fill = "#ffffff"});
    for (int d = 0; d <= decades_x; ++d) {
      const double x = at({static_cast<double>(d), 0}).x;
      svg.line({x, area.y}, {x, bottom + 4}, {.stroke = "#dddddd", .width = 0.8}, "decade");
      const drawing::TextStyle style{.size = 11, .anchor = drawing::Anchor::kMiddle};
      const std::string text = power_of_ten(d);
      drawing::Area room = text_area({x, bottom + 17}, text, style);
      room.x -= 3, room.width += 6;
      if (numbers.claim(room)) svg.text({x, bottom + 17}, text, style);
      for (int step = 2; d < decades_x && step < 10; ++step) {
        const double minor = at({d + std::log10(step), 0}).x;
        svg.line({minor, bottom}, {minor, bottom + 2.5}, {.stroke = drawing::kBlack, .width = 0.5});
      }
    }
    for (int d = 0; d <= decades_y; ++d) {
      const double y = at({0, -static_cast<double>(d)}).y;
      svg.line({area.x - 4, y}, {area.x + area.width, y}, {.stroke = "#dddddd", .width = 0.8}, "decade");
      svg.text({area.x - 7, y + 4}, d == 0 ? "all" : "1 in " + power_of_ten(d),
               {.size = 11, .anchor = drawing::Anchor::kEnd});
    }
    svg.rect(area, {.stroke = drawing::kBlack, .width = 0.8});
    svg.text({area.x + area.width / 2, bottom + 36}, "late by this or more, in real time [us]",
             {.size = 12, .anchor = drawing::Anchor::kMiddle});
    svg.text({22, area.y + area.height / 2}, "share of the wake-ups",
             {.size = 12, .anchor = drawing::Anchor::kMiddle, .rotate = -90});
    svg.close_group();
  }
};

LogFrame frame_around(const std::vector<Curve>& curves, const drawing::Area& area) {
  LogFrame frame{area};
  for (const Curve& curve : curves)
    for (const drawing::Point& p : curve.points()) {
      frame.decades_x = std::max(frame.decades_x, static_cast<int>(std::ceil(p.x - 1e-9)));
      frame.decades_y = std::max(frame.decades_y, static_cast<int>(std::ceil(-p.y - 1e-9)));
    }
  return frame;
}

}  // namespace

std::string lateness_svg(const std::map<NodeId, recording::exports::NodeLateness>& nodes, const drawing::Names& names,
                         const drawing::Sheet& sheet) {
  const std::string title = names.drive.empty() ? "Lateness of wake-ups" : names.drive + ": lateness of wake-ups";
  const std::vector<Curve> curves = curves_of(nodes, names);
  if (curves.empty())
    return drawing::empty_picture(title, "No node recorded its lateness: this run was not in real time.", sheet);
  std::vector<drawing::LegendEntry> legend;
  for (const Curve& curve : curves) {
    const std::string never = curve.points().empty() ? ", never late by 1 us" : "";
    legend.push_back({drawing::LegendEntry::Kind::kLine, curve.name + never, curve.colour, {}, false, curve.dash});
  }
  const double width = sheet.plot_width(kPlot.width, kPlot.x + 28), room = width + kPlot.x - 24;
  const double legend_width = sheet.on_paper() ? room : room - 24;
  const std::vector<std::string> titles = drawing::broken(title, sheet.text(14), sheet.line(room), true);
  const double legend_top = 34 + drawing::kLineHeight * static_cast<double>(titles.size() - 1);
  const LogFrame frame = frame_around(curves, {kPlot.x, legend_top + legend_height(legend, legend_width) + 10, width,
                                               sheet.on_paper() ? std::max(160.0, 0.6 * width) : kPlot.height});
  drawing::Svg svg(kPlot.x + width + 28, frame.area.y + frame.area.height + 50, title, sheet);
  svg.lines({24, 22}, titles, {.size = 14, .bold = true});
  draw_legend(svg, {24, legend_top}, legend_width, legend);
  frame.draw(svg);
  svg.open_group("curves", frame.area);
  for (const Curve& curve : curves) {
    std::vector<drawing::Point> drawn;
    for (const drawing::Point& p : curve.points()) drawn.push_back(frame.at(p));
    if (drawn.empty()) continue;
    const std::string words = curve.words();
    svg.polyline(drawn, {.stroke = curve.colour, .width = curve.width, .dash = curve.dash}, false, words, "curve");
    svg.marker(drawing::Marker::kCircle, drawn.back(), 6, {.fill = curve.colour}, words, "longest");
  }
  svg.close_group();
  return svg.str();
}

}  // namespace ttf::report::plots
