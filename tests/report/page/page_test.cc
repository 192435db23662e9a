#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/drawing/figures.h"
#include "report/drive/plots.h"
#include "report/experiment/plots.h"
#include "report/page/page.h"
#include "report/timing/diagram.h"
#include "tests/report/layout.h"
#include "tests/report/synthetic_drive.h"

namespace ttf::report::page {
namespace {

const std::string kHostile = "\"><img src=x onerror=\"broken=1\"></script><script>broken=1</script><!--";

TEST(Page, NothingOfANameIsMarkup) {
  Page page(kHostile, kHostile);
  page.section(kHostile);
  page.lead(kHostile);
  page.points({kHostile});
  page.facts({{kHostile, kHostile}});
  page.table({kHostile, {kHostile, kHostile}, {{kHostile, kHostile}}});
  page.plot({kHostile,
             kHostile,
             kHostile,
             Plot::Kind::kLines,
             false,
             false,
             {{kHostile, kHostile, {{kHostile, 0, {1, 2}, {3, 4}, {}, {}}}}}});
  page.diagrams({{kHostile, "<svg></svg>", {{"windows", kHostile}}}}, kHostile);
  page.command(kHostile);
  page.preformatted(kHostile, kHostile);
  EXPECT_EQ(count(page.html(), "<script>"), 7u);  // uPlot and ours
  nlohmann::ordered_json scene;
  scene["label"] = kHostile;
  page.scenes({scene}, kHostile);
  const std::string html = page.html();
  EXPECT_EQ(count(html, "<img"), 0u);
  EXPECT_EQ(count(html, "<script>"), 11u);   // uPlot and ours
  EXPECT_EQ(count(html, "</script>"), 14u);  // and the data of plots, scenes and timing diagrams
  EXPECT_EQ(count(html, "<!--"), 0u);
  EXPECT_GT(count(html, "&lt;/script&gt;"), 10u);
}

TEST(Page, ItsDataComeBackAsTheyWere) {
  Page page("", "");
  page.plot(
      {"heading",
       "",
       "t",
       Plot::Kind::kSteps,
       true,
       true,
       {{"view", "y", {{"</script>", 3, {1, 2.5, 3}, {0.123456789, std::nan(""), 1e-9}, {0, 0, 0}, {1, 1, 1}}}}}});
  const std::string html = page.html();
  const std::string mark = "id=\"plots\">";
  const std::size_t at = html.find(mark) + mark.size();
  const auto plots = nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
  ASSERT_EQ(plots.size(), 1u);
  EXPECT_EQ(plots[0]["kind"], "steps");
  EXPECT_EQ(plots[0]["log"], true);
  const auto& curve = plots[0]["views"][0]["curves"][0];
  EXPECT_EQ(curve["label"], "</script>");
  EXPECT_EQ(curve["colour"], 3);
  EXPECT_EQ(curve["y"][0], 0.1234568);  // the visible digits
  EXPECT_TRUE(curve["y"][1].is_null());
  EXPECT_EQ(curve["y"][2], 1e-9);
  EXPECT_EQ(curve["high"][2], 1);
}

TEST(Page, BytesThatAreNoTextDoNotStopIt) {
  Page page("\xff\xfe", "");
  page.plot({"\xff", "", "", Plot::Kind::kLines, false, false, {{"\xff", "", {{"\xc3", 0, {1}, {1}, {}, {}}}}}});
  EXPECT_NE(page.html().find("</html>"), std::string::npos);
}

TEST(Page, FiguresStandOnTheRightAndWordsOnTheLeft) {
  Page page("", "");
  page.table(
      {"", {"name", "figure", "word"}, {{"a", "0.5 ± 0.1", "one"}, {"b", "-", "2 of them"}, {"  c", "+3 less", "-"}}});
  const std::string html = page.html();
  EXPECT_EQ(count(html, "<td class=\"n\">"), 3u);
  EXPECT_EQ(count(html, "<th scope=\"row\" class=\"part\">  c</th>"), 1u);
}

TEST(Page, PicturesInItShareNoIds) {
  Page page("", "");
  const std::string svg = "<?xml?>\n<svg><clipPath id=\"clip0\"/><g clip-path=\"url(#clip0)\"/></svg>";
  page.picture(svg, "one");
  page.picture(svg, "two");
  const std::string html = page.html();
  for (const char* id : {"\"p0-clip0\"", "\"p1-clip0\"", "url(#p0-clip0)", "url(#p1-clip0)"})
    EXPECT_EQ(count(html, id), 1u) << id;
  EXPECT_EQ(count(html, "<?xml"), 0u);
}

TEST(Page, APictureStaysAsItIsButForItsIds) {
  Page page("", "");
  page.picture("<svg id=\"a\" data-id=\"1:2\"><g fill=\"url(#b)\" id=\"b\"/>url(#c)</svg>", "one");
  const char* const wanted = "<svg id=\"p0-a\" data-id=\"1:2\"><g fill=\"url(#p0-b)\" id=\"p0-b\"/>url(#p0-c)</svg>";
  EXPECT_EQ(count(page.html(), wanted), 1u);
  Page bare("", "");
  bare.picture("<svg></svg>", "none");
  EXPECT_EQ(count(bare.html(), "<svg></svg>"), 1u);
}

TEST(Page, AShellTakesWordsBack) {
  EXPECT_EQ(shell_word("out/a-1.yaml"), "out/a-1.yaml");
  EXPECT_EQ(shell_word("it's $HOME"), "'it'\\''s $HOME'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(Figures, HaveTheDigitsTheirIntervalHas) {
  EXPECT_EQ(drawing::with_interval(0.0123456, 0.00042), "0.01235 ± 0.00042");
  EXPECT_EQ(drawing::with_interval(72.04, 3.21), "72.0 ± 3.2");
  EXPECT_EQ(drawing::with_interval(1234.0, 56.0, true), "+1234 ± 56");
  EXPECT_EQ(drawing::with_interval(-0.5, 0.0, true), "-0.500 ± 0");
  EXPECT_EQ(drawing::with_interval(-0.0012, 0.23, true), "0.00 ± 0.23");
  EXPECT_EQ(drawing::with_interval(0.0012, 0.23, true), "0.00 ± 0.23");
  EXPECT_EQ(drawing::with_interval(0.115, std::nan("")), "0.115");
  EXPECT_EQ(drawing::with_interval(std::nan(""), 1.0), "-");
  EXPECT_EQ(drawing::verdict(-1.0, 0.5), "less");
  EXPECT_EQ(drawing::verdict(1.0, 0.5), "more");
  EXPECT_EQ(drawing::verdict(1.0, 1.5), "undecided");
  EXPECT_EQ(drawing::verdict(1.0, std::nan("")), "undecided");
}

TEST(Histogram, HoldsEveryValueOnceOverCommonBins) {
  const auto curves = drive::histogram({{"a", 0, {10, 11, 11, 40}}, {"none", 1, {}}, {"b", 2, {25, std::nan("")}}}, 10);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].x, curves[1].x);
  double sum = 0;
  for (const double share : curves[0].y) sum += share;
  EXPECT_NEAR(sum, 100.0, 1e-9);
  EXPECT_EQ(curves[0].x.front(), 10.0);
  EXPECT_EQ(curves[0].y.back(), 0.0);
  EXPECT_GE(curves[0].x.back(), 40.0);
  EXPECT_EQ(curves[1].colour, 2);
  EXPECT_EQ(drive::histogram({{"same", 0, {5, 5, 5}}}, 10).at(0).y.front(), 100.0);
  EXPECT_TRUE(drive::histogram({{"none", 0, {}}}, 10).empty());
}

TEST(Histogram, TakesValuesThatAreFarApart) {
  const auto curves = drive::histogram({{"a", 0, {-1.7e308, 0.0, 1.7e308}}, {"b", 1, {1e300, 1.0}}}, 10);
  ASSERT_EQ(curves.size(), 2u);
  for (const Curve& curve : curves) {
    double sum = 0;
    for (const double share : curve.y) sum += share;
    EXPECT_NEAR(sum, 100.0, 1e-9);
  }
}

experiment::ExperimentFolder experiment_of(const std::vector<std::string>& delays) {
  experiment::ExperimentFolder folder;
  folder.axes = {"delay"};
  folder.paradigms = {"tt"};
  folder.measures = {{"age", "ms", ""}};
  for (const std::string& delay : delays) {
    experiment::ExperimentPoint& point = folder.points.emplace_back();
    point.point = static_cast<std::uint32_t>(folder.points.size() - 1);
    point.settings = {delay};
    point.estimates = {{{{4, 1.0, 0.5}, std::nullopt}}};
  }
  return folder;
}

TEST(ExperimentPlots, AnAxisIsNumericInOneUnitOnly) {
  const Plot one = means_plot(experiment_of({"2 ms", "1 ms"}));
  EXPECT_EQ(one.x, "delay [ms]");
  EXPECT_EQ(one.views.at(0).curves.at(0).x, (std::vector<double>{1, 2}));
  EXPECT_EQ(means_plot(experiment_of({"1", "2"})).x, "delay");
  const Plot two = means_plot(experiment_of({"500 us", "1 ms"}));
  EXPECT_EQ(two.x, "point (see the table)");
  EXPECT_EQ(two.views.at(0).curves.at(0).x, (std::vector<double>{0, 1}));
}

TEST(TimingDiagram, InAPageEverythingThatStandsInTimeSaysWhen) {
  timing::TimingDiagram d(synthetic_names(), Duration::milliseconds(5), at_us(200'000), at_us(350'000));
  SyntheticDrive{}.drive(d, 1'500'000);
  const std::string picture = d.svg(), page = d.svg(timing::TimingUse::kPage);
  EXPECT_EQ(picture, d.svg(timing::TimingUse::kPicture));
  EXPECT_EQ(count(picture, "data-"), 0u);
  EXPECT_EQ(count(page, "class=\"plot\" data-a") + count(page, "data-a=\"200\" data-b=\"350\""), 1u);
  for (const char* kind : {"class=\"frame\"", "class=\"task\"", "class=\"measured\"", "class=\"arrow\""})
    EXPECT_GT(count(page, kind), 3u) << kind;
  // The camera's third list: measured at 161 ms, on its way in the window.
  EXPECT_GT(count(page, "data-id=\"1:4\" data-since=\"211\""), 2u);
  EXPECT_EQ(count(page, "camera #4 is measured"), 1u);
  // Texts without room are present, but hidden.
  EXPECT_GT(count(page, "display=\"none\""), 0u);
  expect_renders(page);
}

}  // namespace
}  // namespace ttf::report::page
