#include "report/drawing/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace ttf::report::drawing {
namespace {

constexpr double kLegendRow = 18, kLegendSample = 26, kLegendGap = 18, kLegendText = 11;

int channel_of(std::string_view colour, std::size_t i) {
  return static_cast<int>(std::strtol(std::string(colour.substr(1 + 2 * i, 2)).c_str(), nullptr, 16));
}

// An entry's place in its legend, and the lines of its text.
struct Placed {
  double x = 0, y = 0;  // the middle of its first line
  std::vector<std::string> lines;
};
struct LegendLayout {
  std::vector<Placed> entries;
  double height = 0;
};

LegendLayout layout_of(std::span<const LegendEntry> entries, double width) {
  LegendLayout layout;
  double x = 0, top = 0, row = kLegendRow;
  for (const LegendEntry& e : entries) {
    Placed placed;
    placed.lines = broken(e.text, kLegendText, std::max(1.0, width - kLegendSample));
    double text = 0;
    for (const std::string& line : placed.lines) text = std::max(text, text_width(line, kLegendText));
    const double taken = kLegendSample + text + kLegendGap;
    if (x > 0 && x + taken > width) {
      x = 0;
      top += row;
      row = kLegendRow;
    }
    placed.x = x;
    placed.y = top + kLegendRow / 2;
    row = std::max(row, kLegendRow + kLineHeight * static_cast<double>(placed.lines.size() - 1));
    x += taken;
    layout.entries.push_back(std::move(placed));
  }
  layout.height = entries.empty() ? 0 : top + row;
  return layout;
}

}  // namespace

std::string palette(std::size_t i) {
  constexpr std::array<std::string_view, 7> colours{kBlue, kOrange, kGreen, kPurple, kSkyBlue, kVermilion, kYellow};
  const std::size_t round = i / colours.size();
  return tint(colours[i % colours.size()], std::min(0.75, 0.4 * static_cast<double>(round)));
}

std::string tint(std::string_view colour, double amount) {
  std::string out = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = channel_of(colour, i);
    out += fmt::format("{:02x}", static_cast<int>(std::lround(c + (255.0 - c) * amount)));
  }
  return out;
}

std::string darker(std::string_view colour, double amount) {
  std::string out = "#";
  for (std::size_t i = 0; i < 3; ++i)
    out += fmt::format("{:02x}", static_cast<int>(std::lround(channel_of(colour, i) * (1 - amount))));
  return out;
}

std::string_view text_colour_on(std::string_view colour) {
  // Relative luminance weights of ITU-R BT.709; 140 separates blue, green and vermilion from the light colours.
  const double y = 0.2126 * channel_of(colour, 0) + 0.7152 * channel_of(colour, 1) + 0.0722 * channel_of(colour, 2);
  return y < 140 ? "#ffffff" : "#000000";
}

void Extent::add(double v) {
  if (!std::isfinite(v)) return;
  low = std::min(low, v);
  high = std::max(high, v);
}

void Extent::add(const Extent& other) {
  if (other.empty()) return;
  add(other.low);
  add(other.high);
}

Extent Extent::padded(double fraction, double least) const {
  if (empty()) return {0, 1};
  const double margin = std::max(size() * fraction, (least - size()) / 2);
  return {low - margin, high + margin};
}

Ticks nice_ticks(const Extent& extent, int about) {
  const double size = extent.size();
  if (!(size > 0) || !std::isfinite(size)) return {1, {extent.low}};
  const double raw = size / std::max(1, about);
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double m = raw / decade;
  Ticks ticks{decade * (m <= 1.0 ? 1 : m <= 2.0 ? 2 : m <= 5.0 ? 5 : 10), {}};
  const double first = std::ceil(extent.low / ticks.step - 1e-9);
  const double last = std::floor(extent.high / ticks.step + 1e-9);
  // The values are too large, or too close together, for a distinct step.
  if (!(ticks.step > 0) || !(std::abs(first) < 1e15) || !(std::abs(last) < 1e15)) return {1, {extent.low}};
  for (double k = first; k <= last; ++k) ticks.at.push_back(k * ticks.step);
  return ticks;
}

Ticks readable_ticks(const Extent& extent, int about, const std::function<bool(const Ticks&)>& fits) {
  Ticks ticks = nice_ticks(extent, about);
  for (int more = 1; more <= 4 && ticks.at.size() < 3; ++more) {
    Ticks finer = nice_ticks(extent, about + more);
    if (!fits(finer)) break;
    ticks = std::move(finer);
  }
  return ticks;
}

std::string tick_label(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  std::string s = fmt::format("{:.{}f}", std::abs(value) < step * 1e-6 ? 0.0 : value, decimals);
  if (s.front() == '-') s.replace(0, 1, "\xe2\x88\x92");  // a minus sign, not a hyphen
  return s;
}

PlotFrame::PlotFrame(const Area& area, const Extent& x, const Extent& y)
    : area_(area), x_{x, area.x, area.x + area.width}, y_{y, area.y + area.height, area.y} {}

void PlotFrame::draw(Svg& svg, std::string_view x_label, std::string_view y_label) const {
  const double bottom = area_.y + area_.height;
  svg.open_group("axes");
  svg.rect(area_, {.fill = "#ffffff"});
  const Ticks tx = readable_ticks(x_.data, std::max(2, static_cast<int>(area_.width / 80)), [&](const Ticks& ticks) {
    double room = 0;
    for (const double v : ticks.at) room = std::max(room, text_width(tick_label(v, ticks.step), 11) + 12);
    return room <= area_.width * ticks.step / x_.data.size();
  });
  for (const double v : tx.at) {
    svg.line({x_(v), area_.y}, {x_(v), bottom}, {.stroke = "#ececec", .width = 0.8});
    svg.line({x_(v), bottom}, {x_(v), bottom + 4}, {.stroke = kBlack, .width = 0.8});
    if (!x_label.empty())
      svg.text({x_(v), bottom + 17}, tick_label(v, tx.step), {.size = 11, .anchor = Anchor::kMiddle});
  }
  const Ticks ty = readable_ticks(y_.data, std::max(2, static_cast<int>(area_.height / 45)),
                                  [&](const Ticks& ticks) { return 16 <= area_.height * ticks.step / y_.data.size(); });
  for (const double v : ty.at) {
    svg.line({area_.x, y_(v)}, {area_.x + area_.width, y_(v)}, {.stroke = "#ececec", .width = 0.8});
    svg.line({area_.x - 4, y_(v)}, {area_.x, y_(v)}, {.stroke = kBlack, .width = 0.8});
    svg.text({area_.x - 7, y_(v) + 4}, tick_label(v, ty.step), {.size = 11, .anchor = Anchor::kEnd});
  }
  svg.rect(area_, {.stroke = kBlack, .width = 0.8});
  if (!x_label.empty())
    svg.text({area_.x + area_.width / 2, bottom + 35}, x_label, {.size = 12, .anchor = Anchor::kMiddle});
  svg.text({area_.x - 46, area_.y + area_.height / 2}, y_label, {.size = 12, .anchor = Anchor::kMiddle, .rotate = -90});
  svg.close_group();
}

void draw_time_axis(Svg& svg, const Area& plot, const Extent& window_ms) {
  const Ticks ticks = nice_ticks(window_ms, static_cast<int>(plot.width / 90));
  const double bottom = plot.y + plot.height;
  for (const double t : ticks.at) {
    const double px = plot.x + (t - window_ms.low) / window_ms.size() * plot.width;
    svg.line({px, bottom}, {px, bottom + 4}, {.stroke = kBlack, .width = 0.8});
    svg.text({px, bottom + 16}, tick_label(t, ticks.step), {.size = 10.5, .anchor = Anchor::kMiddle});
  }
  svg.text({plot.x + plot.width / 2, bottom + 33}, "true time [ms]", {.size = 11.5, .anchor = Anchor::kMiddle});
}

bool LabelSpace::claim(const Area& area) {
  for (const Area& t : taken_)
    if (t.overlaps(area)) return false;
  taken_.push_back(area);
  return true;
}

std::optional<Point> LabelSpace::place(std::string_view text, const TextStyle& style, std::span<const Point> candidates,
                                       const Area& bounds) {
  for (const Point& p : candidates) {
    Area a = text_area(p, text, style);
    a.x -= 1.5;
    a.width += 3;
    const bool inside = a.x >= bounds.x && a.y >= bounds.y && a.x + a.width <= bounds.x + bounds.width &&
                        a.y + a.height <= bounds.y + bounds.height;
    if (inside && claim(a)) return p;
  }
  return std::nullopt;
}

double legend_height(std::span<const LegendEntry> entries, double width) { return layout_of(entries, width).height; }

void draw_legend(Svg& svg, Point top_left, double width, std::span<const LegendEntry> entries) {
  svg.open_group("legend");
  const LegendLayout layout = layout_of(entries, width);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const LegendEntry& e = entries[i];
    const double left = top_left.x + layout.entries[i].x, y = top_left.y + layout.entries[i].y;
    const Paint line{.stroke = e.colour, .width = e.width, .dash = e.dash};
    switch (e.kind) {
      case LegendEntry::Kind::kMarker:
        svg.marker(e.marker, {left + 12, y}, 8,
                   {.fill = e.filled ? std::string_view(e.colour) : "none", .stroke = e.colour, .width = 1.4});
        break;
      case LegendEntry::Kind::kLine: svg.line({left, y}, {left + 20, y}, line); break;
      case LegendEntry::Kind::kArrow: svg.arrow({left, y}, {left + 20, y}, line, {}, "sample"); break;
      case LegendEntry::Kind::kNumber:
        svg.rect({left + 3, y - 7, 17, 14}, {.fill = "#ffffff", .stroke = e.colour, .width = 0.7});
        svg.text({left + 11.5, y + 3.2}, "12", {.size = 8.5, .anchor = Anchor::kMiddle});
        break;
      case LegendEntry::Kind::kBox:
        svg.rect({left + 3, y - 5, 17, 10},
                 {.fill = e.filled ? std::string_view(e.colour) : "#ffffff",
                  .stroke = e.filled ? std::string_view("#444444") : std::string_view(e.colour),
                  .width = e.filled ? 0.6 : 1.4,
                  .dash = e.dash});
        break;
    }
    svg.lines({left + kLegendSample, y + 4}, layout.entries[i].lines, {.size = kLegendText});
  }
  svg.close_group();
}

std::string empty_picture(std::string_view title, std::string_view reason, const Sheet& sheet) {
  const double width = sheet.width(std::max({480.0, text_width(title, 15, true) + 40, text_width(reason, 12) + 40}));
  const std::vector<std::string> titles = broken(title, sheet.text(15), sheet.line(width - 20), true),
                                 reasons = broken(reason, sheet.text(12), sheet.line(width - 20));
  const double below = kLineHeight * static_cast<double>(titles.size() - 1);
  Svg svg(width, 120 + below + kLineHeight * static_cast<double>(reasons.size() - 1), title, sheet);
  svg.lines({width / 2, 45}, titles, {.size = 15, .anchor = Anchor::kMiddle, .bold = true});
  svg.lines({width / 2, 80 + below}, reasons, {.size = 12, .anchor = Anchor::kMiddle});
  return svg.str();
}

}  // namespace ttf::report::drawing
