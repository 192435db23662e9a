#include "report/drawing/svg.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "core/errors.h"
#include "report/drawing/axes.h"
#include "report/drawing/base64.h"
#include "report/drawing/names.h"
#include "report/drawing/render.h"
#include "report/drawing/tables.h"
#include "report/page/index_page.h"
#include "report/plots/boxes_picture.h"
#include "tests/report/layout.h"

namespace ttf::report::drawing {

namespace {
std::string scratch(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("ttf_report_" + std::to_string(getpid()) + "_" + name)).string();
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}
}  // namespace

namespace {

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648, section 10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Svg, NumbersAreShortAndNeverMinusZero) {
  EXPECT_EQ(number(1.0), "1");
  EXPECT_EQ(number(1.50), "1.5");
  EXPECT_EQ(number(-0.001), "0");
  EXPECT_EQ(number(-12.345), "-12.35");
  EXPECT_EQ(number(100), "100");
  EXPECT_EQ(number(std::numeric_limits<double>::quiet_NaN()), "0");
}

TEST(Svg, EscapesWhatXmlReserves) {
  EXPECT_EQ(escape("a<b & \"c\">\x01"), "a&lt;b &amp; &quot;c&quot;&gt; ");
  Svg svg(100, 50, "x < y & z");
  svg.text({5, 20}, "<a> & \"b\"");
  svg.rect({1, 1, 5, 5}, {.fill = kBlue}, "R&D <hover>");
  expect_renders(svg.str());
  EXPECT_EQ(count(svg.str(), "<title>"), 2u);
}

TEST(Svg, EveryShapeIsWellFormed) {
  Svg svg(200, 100, "shapes");
  svg.open_group("clipped", {10, 10, 50, 50});
  for (const Marker m :
       {Marker::kCircle, Marker::kCross, Marker::kTriangle, Marker::kSquare, Marker::kDiamond, Marker::kDownTriangle})
    svg.marker(m, {20, 20}, 8, {.stroke = kBlack}, "m");
  svg.close_group();
  svg.arrow({0, 0}, {10, 10}, {.stroke = kBlue});
  svg.arrow({0, 0}, {10, 20}, {.stroke = kBlue, .dash = "2 2"});
  svg.arrow({0, 0}, {10, 20}, {.stroke = kGreen});
  EXPECT_EQ(count(svg.str(), "<marker "), 2u) << "one head per colour";
  EXPECT_EQ(count_class(svg.str(), "arrow"), 3u);
  expect_renders(svg.str());
}

TEST(Svg, TextWidthFollowsTheFont) {
  EXPECT_NEAR(text_width("0000000000", 10), 63.6, 0.1);  // DejaVu Sans digits are 0.636 em wide
  EXPECT_LT(text_width("iii", 10), text_width("mmm", 10));
  EXPECT_DOUBLE_EQ(text_width("\xc3\xa4", 10), text_width("\xe2\x80\xa6", 10)) << "one character each, not bytes";
}

TEST(Axes, TicksAreOneTwoFiveAndInside) {
  const Ticks t = nice_ticks({0.0, 1.5}, 8);
  EXPECT_DOUBLE_EQ(t.step, 0.2);
  EXPECT_EQ(t.at.size(), 8u);
  const Ticks odd = nice_ticks({-3.7, 9.1}, 5);
  EXPECT_DOUBLE_EQ(odd.step, 5.0);
  EXPECT_EQ(odd.at, (std::vector<double>{0, 5}));
  EXPECT_EQ(nice_ticks({2, 2}, 5).at.size(), 1u);
  // Steps below the numbers' resolution: one tick, and an end.
  EXPECT_EQ(nice_ticks({1e300, 1e300 * (1 + 1e-15)}, 5).at.size(), 1u);
  EXPECT_EQ(nice_ticks({0, 5e-324}, 5).at.size(), 1u);
  EXPECT_EQ(tick_label(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tick_label(-1e-17, 0.5), "0.0");
  EXPECT_EQ(tick_label(-2, 1),
            "\xe2\x88\x92"
            "2");
}

TEST(Axes, ExtentsIgnoreWhatIsNotFinite) {
  Extent e;
  EXPECT_TRUE(e.empty());
  EXPECT_DOUBLE_EQ(e.padded(0.1, 1).size(), 1.0);
  e.add(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(e.empty());
  e.add(3);
  EXPECT_DOUBLE_EQ(e.padded(0.1, 2).low, 2);
  EXPECT_DOUBLE_EQ(e.padded(0.1, 2).high, 4);
}

TEST(Axes, LabelSpaceTakesTheFirstFreeCandidate) {
  LabelSpace space;
  const std::vector<Point> candidates{{10, 20}, {10, 40}};
  const Area bounds{0, 0, 100, 50};
  EXPECT_DOUBLE_EQ(space.place("abc", {}, candidates, bounds)->y, 20);
  EXPECT_DOUBLE_EQ(space.place("abc", {}, candidates, bounds)->y, 40);
  EXPECT_FALSE(space.place("abc", {}, candidates, bounds));
  EXPECT_FALSE(LabelSpace().place("far too long for these bounds", {}, candidates, bounds));
}

TEST(Axes, ALegendWrapsAndTakesItsOwnSpace) {
  std::vector<LegendEntry> entries;
  for (int i = 0; i < 9; ++i)
    entries.push_back({LegendEntry::Kind::kMarker, "an entry of some length", std::string(kBlue)});
  const double height = legend_height(entries, 500);
  EXPECT_GT(height, legend_height(entries, 5000));
  Svg svg(540, height + 20, "legend");
  draw_legend(svg, {10, 5}, 500, entries);
  expect_no_overlaps(svg.str());
  expect_inside(svg.str());
}

TEST(Axes, ThePaletteDoesNotRepeatSoon) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < 14; ++i) EXPECT_TRUE(seen.insert(palette(i)).second) << i;
  EXPECT_EQ(tint("#000000", 1.0), "#ffffff");
  EXPECT_EQ(text_colour_on(kBlue), "#ffffff");
  EXPECT_EQ(text_colour_on(kYellow), "#000000");
}

TEST(Render, WritesEachFormatAndTheSameBytesAgain) {
  Svg svg(120, 60, "p");
  svg.text({10, 30}, "text");
  for (const std::string extension : {".svg", ".png", ".pdf"}) {
    const std::string path = scratch("picture" + extension);
    write_picture(svg.str(), path);
    const std::string first = bytes_of(path);
    write_picture(svg.str(), path);
    EXPECT_EQ(first, bytes_of(path)) << extension;
    const std::string magic = extension == ".svg" ? "<?xml" : extension == ".png" ? "\x89PNG" : "%PDF";
    EXPECT_EQ(first.substr(0, magic.size()), magic);
    std::filesystem::remove(path);
  }
}

std::string message_of(const std::string& svg, const std::string& path) {
  try {
    write_picture(svg, path);
  } catch (const InputError& e) {
    return std::string("bad input: ") + e.what();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "no error";
}

TEST(Render, NamesTheExtensionsItSupports) {
  EXPECT_NE(message_of("", "out/a.jpg").find(".svg, .png or .pdf"), std::string::npos) << message_of("", "out/a.jpg");
  EXPECT_NE(message_of("", "out/a.jpg").find(".jpg"), std::string::npos);
  EXPECT_NE(message_of("", "dir.png/a").find("none"), std::string::npos);
  EXPECT_THROW(check_picture_path("x"), InputError);
  EXPECT_NO_THROW(check_picture_path("x.pdf"));
}

TEST(Render, SaysWhatCannotBeWrittenOrDrawn) {
  const std::string svg = Svg(10, 10, "p").str();
  for (const std::string extension : {"svg", "png", "pdf"}) {
    const std::string path = "/no/such/folder/a." + extension;
    EXPECT_EQ(message_of(svg, path).find(path + ": cannot be written"), 0u) << message_of(svg, path);
  }
  const std::string message = message_of("<svg", scratch("broken.png"));
  EXPECT_EQ(message.find("bad input: "), 0u) << message;
  EXPECT_NE(message.find("not valid SVG"), std::string::npos);
}

TEST(Tables, AlignNumbersRightAndWordsLeft) {
  Table t({"strategy", "rmse [m]"});
  t.add({"BUFF", "0.25"});
  t.add({"ADVA", "12.5"});
  t.add({"TT", "-"});
  EXPECT_EQ(t.text(),
            "strategy  rmse [m]\n--------  --------\nBUFF          0.25\nADVA          12.5\nTT               -\n");
}

TEST(Tables, CountCharactersAndFillShortRows) {
  Table t({"a", "b"});
  t.add({"\xc2\xb5s"});
  t.add({"x|y", "z"});
  EXPECT_EQ(t.text(), "a    b\n---  -\n\xc2\xb5s\nx|y  z\n");
  EXPECT_EQ(cell(1.2345, 2), "1.23");
  EXPECT_EQ(cell(std::numeric_limits<double>::quiet_NaN(), 2), "-");
}

TEST(IndexPage, ListsPicturesAndTables) {
  const std::vector<page::IndexEntry> entries{{"Timing <1>", "a b.svg", "caption & more", "x  y\n1  2\n", {"a.pdf"}}};
  const std::string dir = scratch("index");
  std::filesystem::create_directories(dir);
  write_index(dir, "A \"run\"", entries);
  const std::string html = bytes_of(dir + "/index.html");
  EXPECT_EQ(html, index_html("A \"run\"", entries));
  for (const char* part : {"<img src=\"a%20b.svg\"", "Timing &lt;1&gt;", "caption &amp; more",
                           "<pre>x  y\n1  2\n</pre>", "href=\"a.pdf\"", "A &quot;run&quot;"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(html.find("http"), std::string::npos) << "nothing from a network";
  std::filesystem::remove_all(dir);
  EXPECT_THROW(write_index(dir, "gone", entries), std::runtime_error);
}

TEST(BoxesPicture, DrawsEveryPointAndBox) {
  const std::vector<Point> points{{1, 1}, {2, 1}, {30, -5}, {std::numeric_limits<double>::quiet_NaN(), 0}};
  const std::vector<plots::Box> boxes{{1.5, 1, 0.3, 4, 2, "car"}, {30, -5, 0, 1, 1, "car"}};
  const std::string svg = plots::boxes_svg(points, boxes, "Boxes");
  EXPECT_EQ(count_class(svg, "point"), 3u);
  EXPECT_EQ(count_class(svg, "box"), 2u);
  EXPECT_NE(svg.find("ISO 8855"), std::string::npos);
  expect_no_overlaps(svg);
  expect_inside(svg);
  expect_renders(svg);
  expect_on_paper(plots::boxes_svg(points, boxes, "Boxes", "fitted box", {88, 8}), 88, 8);
  EXPECT_NE(plots::boxes_svg({}, {}, "Boxes").find("no points"), std::string::npos);
}

TEST(NamesOf, UnknownIdsShowTheirNumber) {
  Names names;
  names.sensors = {"laser"};
  names.pdus = {"Laser_objects", "image"};
  EXPECT_EQ(names.node(NodeId{3}), "node 3");
  EXPECT_EQ(names.task(NodeId{3}, 1), "task 1");
  EXPECT_EQ(names.sensor_of(PduId{0}), SensorId{0}) << "by its name";
  EXPECT_EQ(names.sensor_of(PduId{1}), kNoSensor);
  EXPECT_EQ(names.sensor_of(kNoPdu), kNoSensor);
  names.pdu_sensors = {kNoSensor, SensorId{0}};
  EXPECT_EQ(names.sensor_of(PduId{1}), SensorId{0}) << "as stated";
}

TEST(Axes, HaveMoreThanOneNumberIfThereIsRoom) {
  const auto numbers = [](double width, double height) {
    Svg svg(width + 100, height + 60, "axes");
    PlotFrame({60, 10, width, height}, {44, 79}, {-36, 36}).draw(svg, "x", "y");
    expect_no_overlaps(svg.str());
    return texts_of(svg.str()).size() - 1;  // the label of y is turned
  };
  EXPECT_GE(numbers(250, 150), 6u) << "three each";
  EXPECT_GE(numbers(100, 60), 3u);
}

}  // namespace
}  // namespace ttf::report::drawing
