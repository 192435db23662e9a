// An experiment's tables and scripts for papers, from summaries with an exactly known result.
#include "report/paper/experiment.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/errors.h"
#include "report/paper/drive.h"
#include "tests/support/refusals.h"

namespace ttf::report::paper {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kHead = "paradigm,measure,count,mean,half_width,difference,difference_half_width\n";

std::map<std::string, std::string> paper(const std::string& summary) {
  std::map<std::string, std::string> files;
  for (const PaperFile& file : paper_of_experiment(summary, "summary.csv", "noise", [](std::string_view measure) {
         return measure == "error" ? MeasureWords{"m^2", "what it is"} : MeasureWords{};
       }))
    files[file.name] = file.text;
  return files;
}

std::string refusal(const std::string& summary) {
  return support::refusal_of([&] { paper(summary); }, "taken");
}

TEST(PaperExperiment, OneTableAndOneScriptAMeasure) {
  const auto files = paper(std::string("point,noise,") + kHead +
                           "0,0.5,a,error,9,1.5,0.25,,\n0,0.5,b,error,9,1.25,0.5,-0.25,0.125\n"
                           "0,0.5,a,age,9,3,,,\n1,50,a,error,9,2,0.5,,\n1,50,b,error,9,3,0.5,1,0.125\n");
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files.at("error.csv"),
            "case,noise,x,a_mean,a_half_width,a_difference,a_difference_half_width,"
            "b_mean,b_half_width,b_difference,b_difference_half_width\n"
            "0,0.5,0.5,1.5,0.25,,,1.25,0.5,-0.25,0.125\n"
            "0,50,50,2,0.5,,,3,0.5,1,0.125\n");
  EXPECT_THAT(files.at("error.gp"), AllOf(HasSubstr("error [m²]"), HasSubstr("what it is"), HasSubstr("set logscale x"),
                                          HasSubstr("difference from a"), HasSubstr("set multiplot layout 1,2")));
  // A paradigm without a value of a measure has no curve there; without differences there is one panel.
  EXPECT_THAT(files.at("age.gp"), AllOf(Not(HasSubstr("title \"b\"")), HasSubstr("set multiplot layout 1,1")));
}

TEST(PaperExperiment, OtherAxesAreCasesOfTheirOwnAndLabelsAreNumbered) {
  const auto files = paper(std::string("point,road,period,") + kHead +
                           "0,dry,42 ms,a,error,9,1,0.1,,\n1,dry,84 ms,a,error,9,2,0.1,,\n"
                           "2,icy,42 ms,a,error,9,3,0.1,,\n3,icy,84 ms,a,error,9,4,0.1,,\n");
  EXPECT_THAT(files.at("error.csv"), HasSubstr("\n1,icy,42 ms,42,3,0.1,,\n"));
  EXPECT_THAT(files.at("error.gp"), AllOf(HasSubstr("period [ms]"), HasSubstr("road dry"), HasSubstr("road icy"),
                                          HasSubstr("layout 2,1"), Not(HasSubstr("logscale x"))));
  const auto labelled =
      paper(std::string("point,road,") + kHead + "0,dry,a,error,9,1,0.1,,\n1,icy,a,error,9,2,0.1,,\n");
  EXPECT_THAT(labelled.at("error.csv"), HasSubstr("\n0,icy,1,2,0.1,,\n"));
  EXPECT_THAT(labelled.at("error.gp"), HasSubstr("set xtics (\"dry\" 0, \"icy\" 1)"));
}

// gnuplot has no range for values on one line, and prints a warning.
TEST(PaperExperiment, AMeasureThatNeverChangesHasARange) {
  const auto files = paper(std::string("point,noise,") + kHead + "0,1,a,error,9,0,0,,\n1,2,a,error,9,0,0,,\n" +
                           "0,1,a,age,9,5,0,,\n1,2,a,age,9,5,,,\n");
  EXPECT_THAT(files.at("error.gp"), HasSubstr("set yrange [-1:1]"));
  EXPECT_THAT(files.at("age.gp"), HasSubstr("set yrange [4.5:5.5]"));
}

TEST(PaperExperiment, AFileThatIsNoSummaryIsRefused) {
  EXPECT_THAT(refusal(""), HasSubstr("summary.csv"));
  EXPECT_THAT(refusal("a,b\n"), HasSubstr("must be the summary.csv of an experiment"));
  EXPECT_THAT(refusal(std::string("point,") + kHead), HasSubstr("has no result yet"));
  EXPECT_THAT(refusal(std::string("point,") + kHead + "0,a,error,9\n"), HasSubstr("summary.csv:2: must have 8 fields"));
  EXPECT_THAT(refusal(std::string("point,") + kHead + "0,a,error,9,much,,,\n"),
              HasSubstr("mean = much: must be a number"));
  EXPECT_THAT(refusal(std::string("point,") + kHead + "0,a,../error,9,1,,,\n"), HasSubstr("letters, digits"));
  EXPECT_THAT(refusal(std::string("point,") + kHead + "0,a,error,9,1,,,\n0,a,error,9,1,,,\n"),
              HasSubstr("summary.csv:3: must be the only row of its point"));
  std::string strange = std::string("point,") + kHead;  // every row another point, paradigm and measure
  for (int n = 0; n < 100; ++n) strange += fmt::format("{0},p{0},m{0},9,1,,,\n", n);
  EXPECT_THAT(refusal(strange), HasSubstr("must have a row for each point, paradigm and measure"));
}

// Numbers of several units, or of one value, have no place along an axis.
TEST(PaperExperiment, AnAxisOfSeveralUnitsIsLabelled) {
  const std::string points = "0,500 us,a,error,9,1,0.1,,\n1,1 ms,a,error,9,2,0.1,,\n";
  const auto units = paper(std::string("point,period,") + kHead + points);
  EXPECT_THAT(units.at("error.gp"), AllOf(HasSubstr("set xtics (\"500 us\" 0, \"1 ms\" 1)"), Not(HasSubstr("[ms]"))));
  const auto one = paper(std::string("point,period,") + kHead + "0,1 ms,a,error,9,1,,,\n1,1.0 ms,a,error,9,2,,,\n");
  EXPECT_THAT(one.at("error.gp"), HasSubstr("set xtics (\"1 ms\" 0, \"1.0 ms\" 1)"));
}

TEST(PaperExperiment, AParadigmWithoutAValueIsNotTheBaseline) {
  const auto files = paper(std::string("point,noise,") + kHead +
                           "0,1,a,error,0,,,,\n0,1,b,error,9,1,,,\n0,1,c,error,9,2,,1,0.5\n"
                           "1,2,a,error,0,,,,\n1,2,b,error,9,1,,,\n1,2,c,error,9,2,,1,0.5\n");
  EXPECT_THAT(files.at("error.gp"), HasSubstr("difference from b"));
}

// Each kind of position has a distinct name.
TEST(PaperDrive, ASensorIsNoOtherKind) {
  EXPECT_EQ(sensor_kind("laser"), "laser");
  EXPECT_EQ(sensor_kind("sensor left"), "sensor left");
  EXPECT_EQ(sensor_kind("truth"), "sensor truth");
  EXPECT_EQ(sensor_kind("sensor truth"), "sensor sensor truth");
}

TEST(PaperExperiment, TextIsQuotedForGnuplot) {
  GnuplotFigure figure;
  figure.name = "f";
  figure.about = {"a\nsystem('x')\\", "\\ "};
  EXPECT_THAT(gnuplot_script(figure).text, HasSubstr("f.png\n# a system('x')\\.\n# \\.\n\n"));
  EXPECT_EQ(gnuplot_text("a \"b\" \\ `c`\n"), "\"a \\\"b\\\" \\\\ \\`c\\` \"");
}

}  // namespace
}  // namespace ttf::report::paper
