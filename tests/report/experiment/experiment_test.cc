#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/errors.h"
#include "report/experiment/markdown.h"
#include "report/experiment/plots.h"
#include "report/experiment/report.h"

namespace ttf::report::experiment {
namespace {

constexpr const char* kPoint = R"({"point": %, "axes": {"road": "dry", "noise": "$"}, "paradigms": {
  "adva": {"error": {"count": 3, "mean": 2.0, "half_width": 1.0}},
  "tt": {"error": {"count": 3, "mean": #, "half_width": 1.0,
                   "difference": {"count": 3, "mean": 0.5, "half_width": null}}}}})";

std::string point(int number, const std::string& noise, const std::string& mean) {
  std::string text = kPoint;
  text.replace(text.find('%'), 1, std::to_string(number));
  text.replace(text.find('$'), 1, noise);
  text.replace(text.find('#'), 1, mean);
  return text;
}

// Two points: at the first, tt is less in every drive by nearly the same amount; at the second, by chance.
class ExperimentReport : public testing::Test {
 protected:
  ExperimentReport() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    write(answer_of(point(0, "0.1 m", "1.0") + "," + point(1, "40 m", "1.9")));
    experiments::results::Store store =
        experiments::results::Store::create(folder_ + "/results.sqlite", {"e", "id", "v", "text <&>", {"error"}});
    std::vector<experiments::results::Row> rows;
    for (std::uint32_t r = 0; r < 3; ++r) {
      const double draw = r;
      rows.push_back({{0, r, 0}, experiments::results::kDone, {draw + 2.0}});
      rows.push_back({{0, r, 1}, experiments::results::kDone, {draw + 1.0 + 0.001 * draw}});
      rows.push_back({{1, r, 0}, experiments::results::kDone, {draw}});
      rows.push_back({{1, r, 1}, experiments::results::kDone, {2.0 - draw}});
    }
    store.add(rows);
  }
  ~ExperimentReport() override { std::filesystem::remove_all(folder_); }

  static std::string answer_of(const std::string& points) {
    return R"({"experiment": "e", "question": "Is <it> so?", "seed": 1, "confidence": 0.95, "runs": 12, "failed": 0,
      "baseline": "adva", "answer": "a sentence.\n", "points": [)" +
           points + R"(], "expectations":
      [{"expected": "tt less than adva", "holds": false, "where_not": ["noise 40 m"]}]})";
  }
  void write(const std::string& answer) { std::ofstream(folder_ + "/answer.json") << answer; }
  std::string page() { return experiment_report_html(read_experiment_folder(folder_), {}, {}); }
  // The answer on the page: the last text that is set large.
  std::string lead() {
    const std::string html = page(), large = "<p class=\"lead\">";
    const std::size_t from = html.rfind(large) + large.size();
    return html.substr(from, html.find("</p>", from) - from);
  }
  std::string refusal() {
    try {
      read_experiment_folder(folder_);
    } catch (const InputError& error) {
      return error.findings().at(0).sentence().substr(folder_.size() + 1);
    }
    return "";
  }

  std::string folder_ = testing::TempDir() + "ttf_experiment_report";
};

TEST_F(ExperimentReport, TheAnswerIsTheRunsOwn) {
  EXPECT_EQ(lead(), "For certain tt has the smallest error at 1 of 2 points; at 1 the drives cannot tell.");
  const std::string html = page();
  for (const char* words :
       {"Is &lt;it&gt; so?", "a sentence.", "Expected: tt less than adva. It does not hold for certain at noise 40 m",
        "text &lt;&amp;&gt;", "+0.500 undecided", "--replay 0/adva/0",
        "All pairs of paradigms at all points were compared. Certain are 1 of 2 comparisons, by Holm",
        "These are: tt less than adva at road dry, noise 0.1 m."})
    EXPECT_NE(html.find(words), std::string::npos) << words;
}

TEST_F(ExperimentReport, ItsCommandsNameTheFileThatWasDriven) {
  EXPECT_NE(page().find("ttfusion experiment experiments/e.yaml --out again"), std::string::npos);
  std::string answer = answer_of(point(0, "1", "1"));
  write(answer.insert(1, R"("file": "my own/e.yaml", )"));
  EXPECT_NE(page().find("ttfusion experiment 'my own/e.yaml' --out again"), std::string::npos);
}

TEST_F(ExperimentReport, ItsCommandsNameTheFolderOfLibraries) {
  EXPECT_EQ(page().find("--steps"), std::string::npos);
  std::string answer = answer_of(point(0, "1", "1"));
  write(answer.insert(1, R"("libraries": {"copy.so": "1a", "lamp.so": "2b"}, )"));
  const std::string html = page();
  for (const char* words : {"ttfusion experiment experiments/e.yaml --steps FOLDER --out again",
                            "--replay 0/adva/0 --steps FOLDER --out one", "copy.so, lamp.so"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  write(answer_of(point(0, "1", "1")).insert(1, R"("libraries": [], )"));
  EXPECT_EQ(refusal(), "answer.json: libraries: must be a mapping with at least one entry");
}

TEST_F(ExperimentReport, WhyNoDriveIsShownIsSaid) {
  EXPECT_EQ(page().find("One drive of each paradigm"), std::string::npos);
  ExperimentDrives none;
  none.why_none = "No drive is shown here: it <was> another.";
  const std::string html = experiment_report_html(read_experiment_folder(folder_), none, {});
  EXPECT_NE(html.find("No drive is shown here: it &lt;was&gt; another."), std::string::npos);
  EXPECT_EQ(html.find("class=\"diagram\""), std::string::npos);
}

TEST_F(ExperimentReport, WithoutItsRunsNothingIsCertain) {
  std::filesystem::remove(folder_ + "/results.sqlite");
  EXPECT_EQ(lead(), "Without results.sqlite it is unknown which paradigm has the smallest error.");
  EXPECT_NE(page().find("There is no results.sqlite"), std::string::npos);
}

// 0.7 +- 0.1 of ten drives is certain, and its table says among how many.
TEST_F(ExperimentReport, ATableSaysHowManyComparisonsItMakes) {
  std::string two = point(0, "0.1 m", "1.0") + "," + point(1, "40 m", "1.9");
  const std::string difference = R"({"count": 3, "mean": 0.5, "half_width": null})";
  write(answer_of(
      two.replace(two.find(difference), difference.size(), R"({"count": 10, "mean": 0.7, "half_width": 0.1})")));
  EXPECT_NE(page().find("+0.70 ± 0.10 more*"), std::string::npos);
  EXPECT_NE(page().find("Those marked * stay certain together: 1 of 1 comparison, by Holm"), std::string::npos);
}

// Every point is a row, and only a certain difference is bold.
TEST_F(ExperimentReport, ItsTablesAreMarkdown) {
  std::string two = point(0, "0.1 | m", "1.0") + "," + point(1, "40 m", "1.9");
  const std::string difference = R"({"count": 3, "mean": 0.5, "half_width": null})";
  write(answer_of(
      two.replace(two.find(difference), difference.size(), R"({"count": 10, "mean": 0.7, "half_width": 0.1})")));
  EXPECT_EQ(
      markdown_tables(read_experiment_folder(folder_)),
      "Is <it> so?\n\nerror; 95 % intervals. 1 of 1 comparison, in bold, stay certain together by Holm's method at "
      "5 %.\n\n"
      "| road | noise | runs | adva | tt - adva |\n"
      "|---|---|---|---|---|\n"
      "| dry | 0.1 \\| m | 3 | 2.0 ± 1.0 | **+0.70 ± 0.10** |\n"
      "| dry | 40 m | 3 | 2.0 ± 1.0 | +0.500 |\n");
}

TEST_F(ExperimentReport, ASingleParadigmHasNoComparison) {
  const std::string alone = R"({"point": %, "axes": {"noise": "1 m"}, "paradigms": {
    "tt": {"error": {"count": 3, "mean": 1.0, "half_width": 0.5}}}})";
  const auto at = [&](int number) { return std::string(alone).replace(alone.find('%'), 1, std::to_string(number)); };
  write(answer_of(at(0) + "," + at(1)));
  EXPECT_EQ(lead(), "There is no other paradigm to compare error of tt with.");
  EXPECT_EQ(page().find("No paradigm crosses"), std::string::npos);
}

TEST_F(ExperimentReport, AnExpectationSaysWhyItFails) {
  std::string answer = answer_of(point(0, "1", "1"));
  const std::string where = R"("where_not": ["noise 40 m"])";
  write(answer.replace(answer.find(where), where.size(),
                       R"("outcome": "cannot tell", "where_not": ["noise 40 m"], "why_not": ["one drive"])"));
  EXPECT_NE(page().find("Expected: tt less than adva. The drives cannot tell at noise 40 m (one drive)."),
            std::string::npos);
}

TEST_F(ExperimentReport, AnExpectationMayFailNowhereInParticular) {
  std::string answer = answer_of(point(0, "1", "1"));
  const std::string where = R"(["noise 40 m"])";
  write(answer.replace(answer.find(where), where.size(), "[]"));
  EXPECT_NE(page().find("It does not hold for certain."), std::string::npos);
}

// The last page of the file has rows that opening it does not read.
TEST_F(ExperimentReport, ADamagedStoreIsRefused) {
  const std::string path = folder_ + "/results.sqlite";
  std::vector<experiments::results::Row> rows;
  for (std::uint32_t r = 3; r < 2000; ++r) rows.push_back({{1, r, 0}, experiments::results::kDone, {0.5 + r}});
  experiments::results::Store::open(path).add(rows);
  EXPECT_EQ(refusal(), "");
  constexpr std::size_t kPage = 4096;
  ASSERT_GT(std::filesystem::file_size(path), 8 * kPage);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(-static_cast<std::streamoff>(kPage), std::ios::end);
  file << std::string(kPage, '\xff') << std::flush;
  EXPECT_EQ(refusal().substr(0, 53), "results.sqlite: must be a store of runs; SQLite says:");
}

TEST_F(ExperimentReport, PlotsGoOverTheNumericAxis) {
  const ExperimentFolder folder = read_experiment_folder(folder_);
  const page::Plot means = means_plot(folder);
  EXPECT_EQ(means.x, "noise [m]");
  EXPECT_TRUE(means.logarithmic_x);
  ASSERT_EQ(means.views.size(), 1u);
  EXPECT_EQ(means.views[0].label, "error, road dry");
  EXPECT_EQ(means.views[0].curves.at(1).x, (std::vector<double>{0.1, 40}));
  EXPECT_EQ(means.views[0].curves.at(1).high, (std::vector<double>{2.0, 2.9}));
  EXPECT_EQ(differences_plot(folder).views.at(0).curves.size(), 1u);
  EXPECT_EQ(replications_plot(folder).views.size(), 2u);
}

constexpr const char* kInteraction = R"(, "interactions": [{"measure": "error", "by": "ratio", "axis": "noise",
  "from": "0.1 m", "to": "40 m", "lowers": "tt", "more_than": "adva", "points": [{"axes": {"road": "dry"},
  "first": {"count": 3, "mean": -0.4, "half_width": 0.1, "percent": {"mean": -40, "low": -45, "high": -35}},
  "second": {"count": 3, "mean": -0.2, "half_width": null},
  "interaction": {"count": 3, "mean": -0.3, "half_width": 0.1, "percent": {"mean": -26, "low": -33, "high": -18},
                  "p": 0.01, "stays_certain": true}}]}])";

// The answer's first line leads, once.
TEST_F(ExperimentReport, AnInteractionIsATable) {
  std::string answer = answer_of(point(0, "0.1 m", "1.0") + "," + point(1, "40 m", "1.9"));
  write(answer.insert(answer.rfind('}'), kInteraction));
  const ExperimentFolder folder = read_experiment_folder(folder_);
  EXPECT_EQ(lead(), "a sentence.");
  const std::string html = page();
  EXPECT_EQ(html.find("a sentence."), html.rfind("a sentence."));
  for (const char* words :
       {"For certain tt has the smallest error at 1 of 2 points", "tt against adva", "-40 % (-45 to -35)", "-0.200",
        "-26 % (-33 to -18) less*", "1 of 1 interaction, marked *, stay certain together by Holm"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  EXPECT_NE(markdown_tables(folder).find("| road | runs | tt | adva | tt against adva |\n|---|---|---|---|---|\n"
                                         "| dry | 3 | -40 % (-45 to -35) | -0.200 | **-26 % (-33 to -18) less** |\n"),
            std::string::npos);
  EXPECT_NE(markdown_tables(folder).find("1 of 1 interaction, in bold, stay certain together by Holm's method at 5 %."),
            std::string::npos);
  std::string broken = answer;
  write(broken.replace(broken.find("true}"), 4, "1234"));
  EXPECT_EQ(refusal(), "answer.json: interactions[0].points[0].interaction.stays_certain: must be true or false");
}

// Points at the axis's baseline have no difference, and all paradigms have one elsewhere.
TEST_F(ExperimentReport, AnAxisMayBeCompared) {
  const std::string difference = R"(,
                   "difference": {"count": 3, "mean": 0.5, "half_width": null})";
  std::string first = point(0, "0.1 m", "1.0"), second = point(1, "40 m", "1.9");
  first.erase(first.find(difference), difference.size());
  const std::string adva = R"("mean": 2.0, "half_width": 1.0)";
  second.replace(second.find(adva), adva.size(),
                 adva + R"(, "difference": {"count": 10, "mean": 0.7, "half_width": 0.1})");
  std::string answer = answer_of(first + "," + second);
  answer.replace(answer.find(R"("baseline": "adva")"), 18, R"("compared_axis": "noise", "baseline": "0.1 m")");
  write(answer);
  const ExperimentFolder folder = read_experiment_folder(folder_);
  const std::string html = page();
  for (const char* words : {"error minus that of noise 0.1 m", "adva − noise 0.1 m", "tt − noise 0.1 m",
                            "+0.70 ± 0.10 more*", "+0.500 undecided"})
    EXPECT_NE(html.find(words), std::string::npos) << words;
  EXPECT_EQ(html.find("No paradigm crosses"), std::string::npos);
  EXPECT_NE(markdown_tables(folder).find("| road | noise | runs | adva | tt | adva - noise 0.1 m | tt - noise 0.1 m |\n"
                                         "|---|---|---|---|---|---|---|\n"
                                         "| dry | 0.1 m | 3 | 2.0 ± 1.0 | 1.0 ± 1.0 | - | - |\n"
                                         "| dry | 40 m | 3 | 2.0 ± 1.0 | 1.9 ± 1.0 | **+0.70 ± 0.10** | +0.500 |\n"),
            std::string::npos)
      << markdown_tables(folder);
}

TEST_F(ExperimentReport, ErrorsOfTheAnswerAreNamed) {
  write(answer_of(""));
  EXPECT_EQ(refusal(), "answer.json: points: must have at least one");
  write(answer_of(point(0, "1", "\"much\"")));
  EXPECT_EQ(refusal(), "answer.json: points[0].paradigms.tt.error.mean: must be a number or null");
  write(answer_of(point(0, "1", "1") + R"(,{"point": 1, "axes": {"road": "dry"}, "paradigms": {}})"));
  EXPECT_EQ(refusal(), "answer.json: points[1].paradigms: must be a mapping with at least one entry");
  write(answer_of(point(-1, "1", "1")));
  EXPECT_EQ(refusal(), "answer.json: points[0].point: must be a whole number from 0 on");
  write(answer_of(point(1, "1", "1").replace(10, 1, "4294967296")));
  EXPECT_EQ(refusal(), "answer.json: points[0].point: must be below 2^32");
  write(answer_of(point(0, "1", "1e999")));
  EXPECT_EQ(refusal(), "answer.json: must be JSON: it has an invalid number");
  write("{\n\"experiment\": ");
  EXPECT_EQ(refusal(), "answer.json:2: must be JSON: it is damaged here, or cut off");
  write("[1]");
  EXPECT_EQ(refusal(), "answer.json: must be a mapping");
}

}  // namespace
}  // namespace ttf::report::experiment
