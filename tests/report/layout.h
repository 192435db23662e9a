// Queries on an SVG for tests: its texts with their areas, and the number of elements of a class.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "report/drawing/svg.h"
#include "tests/support/patterns.h"

namespace ttf::report {

struct DrawnText {
  std::string text;
  drawing::Area area;
};

inline std::string unescape(std::string s) {
  for (const auto& [from, to] :
       {std::pair{"&lt;", "<"}, std::pair{"&gt;", ">"}, std::pair{"&quot;", "\""}, std::pair{"&amp;", "&"}})
    for (std::size_t at = 0; (at = s.find(from, at)) != std::string::npos; ++at)
      s.replace(at, std::string(from).size(), to);
  return s;
}

// Unrotated texts.
inline std::vector<DrawnText> texts_of(const std::string& svg) {
  static const support::Pattern element(
      "<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" font-size=\"([0-9.]+)\"([^>]*)>([^<]*)</text>");
  std::vector<DrawnText> out;
  for (const support::Match& match : support::matches(svg, element)) {
    const std::string& more = match[4];
    if (more.find("rotate") != std::string::npos) continue;
    drawing::TextStyle style;
    style.size = std::stod(match[3]);
    style.bold = more.find("bold") != std::string::npos;
    if (more.find("middle") != std::string::npos) style.anchor = drawing::Anchor::kMiddle;
    if (more.find("\"end\"") != std::string::npos) style.anchor = drawing::Anchor::kEnd;
    const std::string text = unescape(match[5]);
    out.push_back({text, text_area({std::stod(match[1]), std::stod(match[2])}, text, style)});
  }
  return out;
}

inline std::size_t count(const std::string& svg, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = svg.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

inline std::size_t count_class(const std::string& svg, const std::string& css_class) {
  return count(svg, " class=\"" + css_class + "\"");
}

inline void expect_no_overlaps(const std::string& svg) {
  const std::vector<DrawnText> texts = texts_of(svg);
  EXPECT_GT(texts.size(), 4u);
  for (std::size_t i = 0; i < texts.size(); ++i)
    for (std::size_t j = i + 1; j < texts.size(); ++j)
      EXPECT_FALSE(texts[i].area.overlaps(texts[j].area))
          << "\"" << texts[i].text << "\" at " << texts[i].area.x << "," << texts[i].area.y << " and \""
          << texts[j].text << "\" at " << texts[j].area.x << "," << texts[j].area.y;
}

// All text inside the picture.
inline void expect_inside(const std::string& svg) {
  static const support::Pattern size("<svg [^>]*viewBox=\"0 0 ([0-9.]+) ([0-9.]+)\"");
  const auto m = support::first_match(svg, size);
  ASSERT_TRUE(m);
  const double width = std::stod((*m)[1]), height = std::stod((*m)[2]);
  for (const DrawnText& t : texts_of(svg)) {
    EXPECT_GE(t.area.x, 0) << t.text;
    EXPECT_LE(t.area.x + t.area.width, width) << t.text;
    EXPECT_GE(t.area.y, 0) << t.text;
    EXPECT_LE(t.area.y + t.area.height, height) << t.text;
  }
}

// A picture of this width, whose texts have one size, lie inside and do not overlap.
inline void expect_on_paper(const std::string& svg, double width_mm, double font_pt) {
  static const support::Pattern size("<svg [^>]*width=\"([0-9.]+)mm\" height=\"[0-9.]+mm\" viewBox=\"0 0 ([0-9.]+) ");
  const auto m = support::first_match(svg, size);
  ASSERT_TRUE(m) << svg.substr(0, 300);
  EXPECT_NEAR(std::stod((*m)[1]), width_mm, 0.02);
  const double points_per_unit = std::stod((*m)[1]) / 25.4 * 72 / std::stod((*m)[2]);
  static const support::Pattern font(" font-size=\"([0-9.]+)\"");
  for (const support::Match& said : support::matches(svg, font))
    ASSERT_NEAR(std::stod(said[1]) * points_per_unit, font_pt, 0.001 * font_pt) << said[0];
  expect_no_overlaps(svg);
  expect_inside(svg);
}

// librsvg, as a judge of well-formedness: writes a PNG beside the other files of the test run.
void expect_renders(const std::string& svg);

}  // namespace ttf::report
