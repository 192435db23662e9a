#include "report/drawing/svg.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace ttf::report::drawing {
namespace {

// Advance widths of DejaVu Sans in thousandths of the font size, U+0020 to U+007E (from the font's hmtx table).
constexpr std::array<std::uint16_t, 95> kAdvance{
    318, 401, 460, 838, 636, 950, 780, 275, 390, 390, 500, 838, 318, 361,  318, 337, 636, 636, 636,
    636, 636, 636, 636, 636, 636, 636, 337, 337, 838, 838, 838, 531, 1000, 684, 686, 698, 770, 632,
    575, 775, 752, 295, 295, 656, 557, 863, 748, 787, 603, 787, 695, 635,  611, 732, 684, 989, 685,
    611, 685, 390, 337, 390, 838, 500, 500, 613, 635, 550, 635, 615, 352,  635, 634, 278, 278, 579,
    278, 974, 634, 612, 635, 635, 411, 521, 392, 634, 592, 818, 592, 592,  525, 636, 337, 636, 838};
constexpr double kOtherAdvance = 838;  // covers most symbols beyond ASCII
constexpr double kBoldFactor = 1.12;   // DejaVu Sans Bold, relative to the regular face
constexpr double kHeadLength = 6.0;

void add_paint(std::string& out, const Paint& p) {
  fmt::format_to(std::back_inserter(out), " fill=\"{}\"", p.fill);
  if (p.stroke != "none") {
    fmt::format_to(std::back_inserter(out), " stroke=\"{}\" stroke-width=\"{}\"", p.stroke, number(p.width));
    if (!p.dash.empty()) fmt::format_to(std::back_inserter(out), " stroke-dasharray=\"{}\"", p.dash);
  }
  if (p.opacity < 1.0) fmt::format_to(std::back_inserter(out), " opacity=\"{}\"", number(p.opacity));
}

void add_class(std::string& out, std::string_view css_class) {
  if (!css_class.empty()) fmt::format_to(std::back_inserter(out), " class=\"{}\"", escape(css_class));
}

std::string path_of(std::span<const Point> points, bool closed) {
  std::string d;
  for (std::size_t i = 0; i < points.size(); ++i)
    fmt::format_to(std::back_inserter(d), "{}{} {}", i == 0 ? "M" : "L", number(points[i].x), number(points[i].y));
  if (closed) d += 'Z';
  return d;
}

}  // namespace

std::string number(double value) {
  if (!std::isfinite(value)) return "0";
  std::string s = fmt::format("{:.2f}", value);
  while (s.back() == '0') s.pop_back();
  if (s.back() == '.') s.pop_back();
  return s == "-0" ? "0" : s;
}

std::string escape(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
    }
  }
  return out;
}

double text_width(std::string_view text, double size, bool bold) {
  double thousandths = 0;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u >= 0x20 && u < 0x7f)
      thousandths += kAdvance[u - 0x20u];
    else if ((u & 0xc0u) != 0x80u)
      thousandths += kOtherAdvance;  // first byte of a UTF-8 sequence
  }
  return thousandths * size / 1000.0 * (bold ? kBoldFactor : 1.0);
}

Area text_area(Point at, std::string_view text, const TextStyle& style) {
  const double width = text_width(text, style.size, style.bold);
  const double left = style.anchor == Anchor::kStart    ? at.x
                      : style.anchor == Anchor::kMiddle ? at.x - width / 2
                                                        : at.x - width;
  return {left, at.y - 0.8 * style.size, width, style.size};
}

MarkerShape shape_of(Marker kind) {
  switch (kind) {
    case Marker::kCircle: break;
    case Marker::kCross: return {{{{-1, -1}, {1, 1}}, {{-1, 1}, {1, -1}}}, false};
    case Marker::kPlus: return {{{{-1, 0}, {1, 0}}, {{0, -1}, {0, 1}}}, false};
    case Marker::kTriangle: return {{{{0, -1.1}, {1, 0.8}, {-1, 0.8}}}};
    case Marker::kSquare: return {{{{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}}}};
    case Marker::kDiamond: return {{{{0, -1.2}, {1.2, 0}, {0, 1.2}, {-1.2, 0}}}};
    case Marker::kDownTriangle: return {{{{0, 1.1}, {1, -0.8}, {-1, -0.8}}}};
  }
  return {};
}

Svg::Svg(double width, double height, std::string_view title, const Sheet& sheet)
    : width_(width), height_(height), title_(title), sheet_(sheet) {}

void Svg::open_group(std::string_view css_class) {
  body_ += "<g";
  add_class(body_, css_class);
  body_ += ">\n";
}

void Svg::open_group(std::string_view css_class, const Area& clip) {
  fmt::format_to(std::back_inserter(defs_),
                 "<clipPath id=\"clip{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n", clips_,
                 number(clip.x), number(clip.y), number(clip.width), number(clip.height));
  body_ += "<g";
  add_class(body_, css_class);
  fmt::format_to(std::back_inserter(body_), " clip-path=\"url(#clip{})\">\n", clips_++);
}

void Svg::close_group() { body_ += "</g>\n"; }

void Svg::finish_element(std::string_view name, std::string_view hover) {
  body_ += std::exchange(tags_, {});
  if (hover.empty())
    body_ += "/>\n";
  else
    fmt::format_to(std::back_inserter(body_), "><title>{}</title></{}>\n", escape(hover), name);
}

void Svg::rect(const Area& a, const Paint& paint, std::string_view hover, std::string_view css_class) {
  fmt::format_to(std::back_inserter(body_), "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", number(a.x),
                 number(a.y), number(a.width), number(a.height));
  add_class(body_, css_class);
  add_paint(body_, paint);
  finish_element("rect", hover);
}

void Svg::line(Point a, Point b, const Paint& paint, std::string_view css_class) {
  const std::array<Point, 2> points{a, b};
  polyline(points, paint, false, {}, css_class);
}

void Svg::polyline(std::span<const Point> points, const Paint& paint, bool closed, std::string_view hover,
                   std::string_view css_class) {
  if (points.empty()) return;
  fmt::format_to(std::back_inserter(body_), "<path d=\"{}\"", path_of(points, closed));
  add_class(body_, css_class);
  add_paint(body_, paint);
  finish_element("path", hover);
}

void Svg::arrow(Point a, Point b, const Paint& paint, std::string_view hover, std::string_view css_class) {
  const std::string_view colour = paint.stroke;
  std::string id = "head-";
  for (const char c : colour)
    if (c != '#') id += c;
  if (heads_.insert(id).second)
    fmt::format_to(std::back_inserter(defs_),
                   "<marker id=\"{}\" markerUnits=\"userSpaceOnUse\" markerWidth=\"8\" markerHeight=\"8\" refX=\"{}\" "
                   "refY=\"3\" orient=\"auto\"><path d=\"M0 0.4L6 3L0 5.6Z\" fill=\"{}\"/></marker>\n",
                   id, number(kHeadLength), colour);
  const std::array<Point, 2> points{a, b};
  fmt::format_to(std::back_inserter(body_), "<path d=\"{}\"", path_of(points, false));
  add_class(body_, css_class);
  add_paint(body_, paint);
  fmt::format_to(std::back_inserter(body_), " marker-end=\"url(#{})\"", id);
  finish_element("path", hover);
}

void Svg::marker(Marker kind, Point at, double size, const Paint& paint, std::string_view hover,
                 std::string_view css_class) {
  const double r = size / 2;
  const MarkerShape shape = shape_of(kind);
  if (shape.lines.empty()) {
    fmt::format_to(std::back_inserter(body_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"", number(at.x), number(at.y),
                   number(r));
  } else {
    std::string d;
    for (std::vector<Point> line : shape.lines) {
      for (Point& p : line) p = {at.x + r * p.x, at.y + r * p.y};
      d += path_of(line, shape.closed);
    }
    fmt::format_to(std::back_inserter(body_), "<path d=\"{}\"", d);
  }
  add_class(body_, css_class);
  add_paint(body_, paint);
  finish_element(shape.lines.empty() ? "circle" : "path", hover);
}

void Svg::text(Point at, std::string_view text, const TextStyle& style) {
  fmt::format_to(std::back_inserter(body_), "<text x=\"{}\" y=\"{}\" font-size=\"{}\"", number(at.x), number(at.y),
                 number(sheet_.text(style.size)));
  if (style.anchor != Anchor::kStart)
    fmt::format_to(std::back_inserter(body_), " text-anchor=\"{}\"",
                   style.anchor == Anchor::kMiddle ? "middle" : "end");
  if (style.bold) body_ += " font-weight=\"bold\"";
  if (style.fill != "#000000") fmt::format_to(std::back_inserter(body_), " fill=\"{}\"", style.fill);
  if (style.rotate != 0)
    fmt::format_to(std::back_inserter(body_), " transform=\"rotate({} {} {})\"", number(style.rotate), number(at.x),
                   number(at.y));
  if (style.halo) body_ += " stroke=\"#ffffff\" stroke-width=\"2.5\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
  body_ += std::exchange(tags_, {});
  fmt::format_to(std::back_inserter(body_), ">{}</text>\n", escape(text));
}

void Svg::lines(Point at, std::span<const std::string> lines, const TextStyle& style) {
  for (const std::string& line : lines) {
    text(at, line, style);
    at.y += kLineHeight;
  }
}

std::string Svg::str() const {
  const auto length = [&](double units) {
    return sheet_.on_paper() ? fmt::format("{:.4f}mm", sheet_.mm(units)) : number(units);
  };
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{5}\" height=\"{6}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"DejaVu Sans, sans-serif\">\n<title>{2}</title>\n<defs>\n{3}</defs>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n{4}</svg>\n",
      number(width_), number(height_), escape(title_), defs_, body_, length(width_), length(height_));
}

}  // namespace ttf::report::drawing
