// The picture of lateness: its curves show the histograms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "report/plots/lateness_picture.h"
#include "tests/report/layout.h"
#include "tests/support/patterns.h"

namespace ttf::report::plots {
namespace {

using recording::records::BinnedDurations;
using LatenessOfNodes = std::map<NodeId, recording::exports::NodeLateness>;

drawing::Names three_names() {
  drawing::Names names;
  names.drive = "drive <1>";
  names.nodes = {"laser", "fusion", "feature"};
  return names;
}

BinnedDurations late_by(std::initializer_list<std::pair<std::int64_t, int>> us_and_times) {
  BinnedDurations late;
  for (const auto& [us, times] : us_and_times)
    for (int i = 0; i < times; ++i) late.add(Duration::microseconds(us));
  return late;
}

struct DrawnCurve {
  std::vector<drawing::Point> points;
  std::string hover;
  bool dashed = false;
};
std::vector<DrawnCurve> curves_in(const std::string& svg) {
  static const support::Pattern element("<path d=\"([^\"]*)\"( class=\"curve\"[^>]*)><title>([^<]*)</title>");
  std::vector<DrawnCurve> curves;
  for (const support::Match& drawn : support::matches(svg, element)) {
    DrawnCurve& curve = curves.emplace_back();
    static const support::Pattern pair("([-0-9.]+)[ ,]([-0-9.]+)");
    for (const support::Match& point : support::matches(drawn[1], pair))
      curve.points.push_back({std::stod(point[1]), std::stod(point[2])});
    curve.dashed = drawn[2].find("dasharray") != std::string::npos;
    curve.hover = drawn[3];
  }
  return curves;
}

// 1000 wake-ups: 900 by 3 us, 90 by 30 us, 9 by 300 us, one by 5000 us. From 1 us to 10 ms are four decades,
// and from all to one in 1000 three.
TEST(LatenessPicture, CurvesShowTheShareThatIsAsLate) {
  LatenessOfNodes nodes;
  nodes[NodeId{1}].wake_ups = late_by({{3, 900}, {30, 90}, {300, 9}, {5000, 1}});
  const std::string svg = lateness_svg(nodes, three_names());
  const auto curves = curves_in(svg);
  ASSERT_EQ(curves.size(), 1u);
  const DrawnCurve& curve = curves[0];
  EXPECT_FALSE(curve.dashed);
  EXPECT_NE(curve.hover.find("fusion: 1000 wake-ups, half of them later than 4 us"), std::string::npos) << curve.hover;
  const double left = 112, width = 860, decade_x = width / 4;
  // The first point is at 1 us, where all are at least as late: the frame's upper left corner.
  const double top = curve.points.front().y, decade_y = 420.0 / 3;
  EXPECT_NEAR(curve.points.front().x, left, 0.01);
  const auto share_at = [&](double us) {  // on the last point inside
    double y = top;
    for (const drawing::Point& p : curve.points)
      if (p.x <= left + decade_x * std::log10(us) + 0.01) y = p.y;
    return std::pow(10.0, -(y - top) / decade_y);
  };
  EXPECT_NEAR(share_at(3), 1.0, 1e-3);
  EXPECT_NEAR(share_at(4), 0.1, 1e-4);
  EXPECT_NEAR(share_at(30), 0.1, 1e-4);
  EXPECT_NEAR(share_at(31), 0.01, 1e-5);
  EXPECT_NEAR(share_at(290), 0.01, 1e-5);
  EXPECT_NEAR(share_at(310), 0.001, 1e-6);
  EXPECT_NEAR(curve.points.back().x, left + decade_x * std::log10(5000), 0.01) << "ends at the longest";
  EXPECT_NEAR(curve.points.back().y, top + 3 * decade_y, 0.02);
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    EXPECT_GE(curve.points[i].x, curve.points[i - 1].x);
    EXPECT_GE(curve.points[i].y, curve.points[i - 1].y);
  }
  EXPECT_EQ(count_class(svg, "longest"), 1u);
  EXPECT_EQ(count_class(svg, "decade"), 5u + 4u);
}

TEST(LatenessPicture, AllFloorsAreOneDashedCurve) {
  LatenessOfNodes nodes;
  for (std::uint8_t n = 0; n < 3; ++n) {
    nodes[NodeId{n}].wake_ups = late_by({{60 + n, 100}});
    nodes[NodeId{n}].floor = late_by({{50, 100}, {200 + n, 1}});
    nodes[NodeId{n}].arrivals = late_by({{9999, 5}});  // is another story
  }
  const std::string svg = lateness_svg(nodes, three_names());
  const auto curves = curves_in(svg);
  ASSERT_EQ(curves.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(curves[i].dashed);
  EXPECT_TRUE(curves[3].dashed);
  EXPECT_NE(curves[3].hover.find("303 wake-ups"), std::string::npos) << curves[3].hover;
  EXPECT_NE(curves[3].hover.find("the latest by 202 us"), std::string::npos);
  expect_no_overlaps(svg);
  expect_inside(svg);
  expect_renders(svg);
  EXPECT_EQ(svg, lateness_svg(nodes, three_names()));
  for (const double width_mm : {75.0, 88.0, 180.0})
    expect_on_paper(lateness_svg(nodes, three_names(), {width_mm, 8}), width_mm, 8);
}

TEST(LatenessPicture, WithoutWakeUpsItSaysSo) {
  for (const LatenessOfNodes& nodes : {LatenessOfNodes{}, LatenessOfNodes{{NodeId{0}, {}}}}) {
    const std::string svg = lateness_svg(nodes, three_names());
    EXPECT_NE(svg.find("this run was not in real time"), std::string::npos);
    EXPECT_TRUE(curves_in(svg).empty());
    expect_renders(svg);
  }
  // Never late by a microsecond: logarithmic axes have no curve for it, but the text reports it.
  LatenessOfNodes nodes;
  nodes[NodeId{0}].wake_ups = late_by({{0, 10}, {-5, 3}});
  const std::string svg = lateness_svg(nodes, three_names());
  EXPECT_TRUE(curves_in(svg).empty());
  EXPECT_NE(svg.find("laser, never late by 1 us"), std::string::npos);
  expect_inside(svg);
}

TEST(LatenessPicture, NumbersThatNoRunHasAreDrawnAllTheSame) {
  const std::vector<std::uint64_t> full(recording::records::kLatenessBins, std::numeric_limits<std::uint64_t>::max());
  std::vector<std::uint64_t> last(recording::records::kLatenessBins);
  last.back() = 1;
  LatenessOfNodes nodes;
  std::uint8_t n = 0;
  for (const std::int64_t longest_ns :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{0}, std::numeric_limits<std::int64_t>::max()}) {
    nodes[NodeId{n++}].wake_ups = BinnedDurations(full, Duration{longest_ns});
    nodes[NodeId{n++}].wake_ups = BinnedDurations(last, Duration{longest_ns});
  }
  const std::string svg = lateness_svg(nodes, drawing::Names{});
  EXPECT_EQ(curves_in(svg).size(), 6u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  expect_inside(svg);
  expect_renders(svg);
}

}  // namespace
}  // namespace ttf::report::plots
