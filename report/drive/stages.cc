#include "report/drive/stages.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/counted.h"
#include "report/drawing/tables.h"
#include "report/drive/tables.h"

namespace ttf::report::drive {
namespace {

constexpr int kDecimals = 2;

std::string cell(double ms) { return drawing::cell(ms, kDecimals); }
std::string cell(const std::optional<double>& ms) { return ms ? cell(*ms) : "-"; }
std::string cell(std::uint64_t beyond) { return beyond == 0 ? "-" : fmt::format("{} ▲", beyond); }

// A sensor's stages in one drive.
struct Of {
  const std::string* label;
  const ReportedStages* stages;
};

std::vector<std::string> sensors_of(const std::vector<ReportedDrive>& drives) {
  std::vector<std::string> names;
  for (const ReportedDrive& reported : drives)
    for (const ReportedStages& one : reported.drive->stages)
      if (one.seen > 0 && std::ranges::find(names, one.sensor) == names.end()) names.push_back(one.sensor);
  return names;
}

std::vector<Of> of_sensor(const std::vector<ReportedDrive>& drives, const std::string& sensor) {
  std::vector<Of> all;
  for (const ReportedDrive& reported : drives)
    for (const ReportedStages& one : reported.drive->stages)
      if (one.sensor == sensor && one.seen > 0) all.push_back({&reported.drive->label, &one});
  return all;
}

// Returns the stages of all drives in the order of the way: one that a drive alone has stands behind its predecessor.
std::vector<std::string> stages_of(const std::vector<Of>& drives) {
  std::vector<std::string> names;
  for (const Of& one : drives) {
    auto place = names.begin();
    for (const ReportedStage& stage : one.stages->stages) {
      const auto known = std::ranges::find(names, stage.name);
      place = known != names.end() ? known : names.insert(place, stage.name);
      ++place;
    }
  }
  return names;
}

page::PageTable ages_table(const std::vector<ReportedDrive>& drives) {
  page::PageTable table{
      "Age of a measurement at the end of its way, the first use of an image that shows it [ms]",
      {"sensor", "run", "seen all the way", "least", "most", "least", "mean", "p99", "most", "outside"},
      {},
      {{"", 3}, {"bounds", 2}, {"had", 4}, {"", 1}}};
  for (const std::string& sensor : sensors_of(drives)) {
    bool first = true;
    for (const Of& one : of_sensor(drives, sensor)) {
      const ReportedStage& last = one.stages->stages.back();
      std::uint64_t beyond = 0;
      for (const ReportedStage& stage : one.stages->stages) beyond = std::max(beyond, stage.beyond);
      table.rows.push_back({first ? sensor : "", *one.label,
                            fmt::format("{} of {}", one.stages->seen, one.stages->measured), cell(last.age_best),
                            cell(last.age_worst), cell(last.age.least), cell(last.age.mean), cell(last.age.p99),
                            cell(last.age.most), cell(beyond)});
      first = false;
    }
  }
  return table;
}

page::PageTable stages_table(const std::string& sensor, const std::vector<Of>& drives) {
  const bool several = drives.size() > 1;
  page::PageTable table{sensor + ": stages of a measurement's way [ms]", {"stage"}, {}, {{"", several ? 2u : 1u}}};
  if (several) table.header.emplace_back("run");
  for (const char* head : {"least", "most", "least", "mean", "p99", "most", "bound", "had", "outside"})
    table.header.emplace_back(head);
  table.groups.insert(table.groups.end(), {{"shares of the bounds", 2}, {"had", 4}, {"age at its end, most", 3}});
  for (const std::string& name : stages_of(drives)) {
    bool first = true;
    for (const Of& one : drives) {
      const auto stage = std::ranges::find(one.stages->stages, name, &ReportedStage::name);
      if (stage == one.stages->stages.end()) continue;
      std::vector<std::string> cells{first ? name : ""};
      if (several) cells.push_back(*one.label);
      for (const std::string& text :
           {cell(stage->best), cell(stage->worst), cell(stage->had.least), cell(stage->had.mean), cell(stage->had.p99),
            cell(stage->had.most), cell(stage->age_worst), cell(stage->age.most), cell(stage->beyond)})
        cells.push_back(text);
      table.rows.push_back(std::move(cells));
      first = false;
    }
  }
  return table;
}

}  // namespace

std::string beyond_words(const std::string& label, const std::vector<ReportedStages>& sensors) {
  std::string text;
  for (const ReportedStages& one : sensors) {
    const auto worst = std::ranges::max_element(one.stages, {}, &ReportedStage::beyond);
    if (worst == one.stages.end() || worst->beyond == 0) continue;
    text += fmt::format("{}{} of {} of {}", text.empty() ? "" : ", ", worst->beyond, counted(one.seen, "measurement"),
                        one.sensor);
  }
  return text.empty() ? "" : fmt::format("{}: ages outside the schedule's bounds: {}.", label, text);
}

void stages_section(page::Page& page, const std::vector<ReportedDrive>& drives) {
  const std::vector<std::string> sensors = sensors_of(drives);
  if (sensors.empty()) return;
  page.section("Latency by stage");
  std::vector<std::string> beyond;
  for (const ReportedDrive& reported : drives)
    if (std::string words = beyond_words(reported.drive->label, reported.drive->stages); !words.empty())
      beyond.push_back(std::move(words));
  if (beyond.empty())
    page.paragraph(
        "Each measurement that was seen all the way was within the bounds of the schedule's analysis at the end of "
        "each stage.");
  else
    page.points(beyond);
  page.table(ages_table(drives));
  for (const std::string& sensor : sensors) {
    page.open_details(sensor + ", stage by stage");
    page.paragraph(
        "The stages are those of `ttfusion schedule check`. A stage's bounds are its shares of the least and of the "
        "largest age: it may last longer where another is shorter. The age at its end may not be outside its bounds.");
    page.table(stages_table(sensor, of_sensor(drives, sensor)));
    page.close_details();
  }
}

}  // namespace ttf::report::drive
