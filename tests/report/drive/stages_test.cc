#include "report/drive/stages.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "report/drive/tables.h"
#include "report/page/page.h"
#include "tests/report/layout.h"

namespace ttf::report::drive {
namespace {

ReportedStage stage(const std::string& name, double most, double age_worst, std::uint64_t beyond = 0) {
  return {name, 0.5, 2.5, {1.0, 1.25, most, most}, 0.5, age_worst, {1.0, 1.25, most, most}, beyond};
}

class StagesSection : public ::testing::Test {
 protected:
  StagesSection() {
    buff.label = "buff";
    buff.stages = {
        {"laser", {stage("measure", 1.5, 2.0), stage("held", 9.0, 30.0), stage("use", 2.0, 40.0)}, 20, 18, true}};
    tt.label = "tt";
    tt.stages = {{"laser", {stage("measure", 1.5, 2.0), stage("use", 41.0, 40.0, 3)}, 20, 19, true}};
  }
  std::string html(const std::vector<ReportedDrive>& drives) {
    page::Page page("", "");
    stages_section(page, drives);
    return page.html();
  }
  Drive buff, tt;
};

TEST_F(StagesSection, RunsStandBelowEachOtherInTheOrderOfTheWay) {
  const std::string page = html({{&tt, {}, {}}, {&buff, {}, {}}});
  std::size_t before = page.find("stage by stage");
  ASSERT_NE(before, page.npos);
  for (const char* name : {">measure</th>", ">held</th>", ">use</th>"}) {
    EXPECT_EQ(count(page, name), 1u) << name;
    const std::size_t at = page.find(name);
    EXPECT_GT(at, before) << name;
    before = at;
  }
  EXPECT_EQ(count(page, ">18 of 20</td>"), 1u);
  EXPECT_EQ(count(page, "colspan=\"4\">had</th>"), 2u);
}

TEST_F(StagesSection, AgesOutsideTheBoundsAreReportedFirst) {
  EXPECT_EQ(beyond_words("tt", tt.stages), "tt: ages outside the schedule's bounds: 3 of 19 measurements of laser.");
  EXPECT_EQ(beyond_words("buff", buff.stages), "");
  EXPECT_EQ(count(html({{&buff, {}, {}}, {&tt, {}, {}}}), "3 ▲"), 2u);
  EXPECT_EQ(count(html({{&buff, {}, {}}}), "was within the bounds of the schedule"), 1u);
  EXPECT_EQ(answer_of({{&tt, {}, {}}}).more.at(0), beyond_words("tt", tt.stages));
}

TEST_F(StagesSection, IsLeftOutWithoutStages) {
  tt.stages.clear();
  EXPECT_EQ(count(html({{&tt, {}, {}}}), "Latency by stage"), 0u);
}

}  // namespace
}  // namespace ttf::report::drive
