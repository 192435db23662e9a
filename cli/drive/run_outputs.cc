#include "cli/drive/run_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/drive/real_time_outputs.h"
#include "cli/drive_progress.h"
#include "experiments/sweep/driving.h"
#include "recording/log/reader.h"
#include "recording/records/tee.h"
#include "report/drawing/render.h"
#include "report/drawing/tables.h"
#include "report/page/index_page.h"
#include "report/plots/driving_picture.h"
#include "report/plots/lateness_picture.h"
#include "report/plots/position_plot.h"
#include "report/plots/schedule_picture.h"
#include "report/startup/diagram.h"
#include "report/timing/diagram.h"
#include "sim/drives/traced.h"

namespace ttf::cli::drive {
namespace {

using evaluation::measures::DriveFigures;
using evaluation::measures::Measure;
using evaluation::measures::ShownIn;
using evaluation::measures::Subject;

constexpr const char* kPictureFormats[] = {".svg", ".png", ".pdf"};
constexpr const char* kIndex = "index.html";
constexpr const char* kSchedule = "schedule";
// Files per strategy: STRATEGY_timing and so on.
constexpr const char* kOfStrategy[] = {"startup", "lateness", "timing", "over_time", "plane", "driving"};

report::plots::PositionOptions position_options(const sim::drives::Scenario& scenario, const StrategyResult& result) {
  report::plots::PositionOptions options;
  options.title = fmt::format("{}, {}", scenario.name, name_of(result.strategy));
  options.from = sim::drives::evaluation_start(scenario);
  options.to = sim::drives::drive_end(scenario);
  return options;
}

// The picture's settings for a scenario whose vehicle commands drive.
report::plots::DrivingOptions driving_options(const sim::drives::Scenario& scenario,
                                              const schedules::model::Cluster& cluster, const std::string& title) {
  report::plots::DrivingOptions options{title, sim::drives::evaluation_start(scenario),
                                        sim::drives::drive_end(scenario), scenario.world.ego->front,
                                        scenario.world.ego->width};
  if (const auto lane = experiments::sweep::lane_kept(scenario, cluster))
    options.lane = [lane = evaluation::driving::TrueLane(*lane)](const recording::records::EgoTruth& ego) {
      const evaluation::driving::InLane place = lane.place_of(ego);
      return report::plots::PlaceInLane{place.offset, place.heading};
    };
  return options;
}

struct Column {
  std::string head;
  const StrategyResult* result;
};

// Returns a row of loads for each private CAN. Names tell CANs of different clusters apart.
std::vector<std::vector<std::string>> can_loads(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns)
    for (const schedules::model::CanBus& bus : column.result->cluster.can_buses)
      if (std::ranges::find(names, bus.name) == names.end()) names.push_back(bus.name);
  std::vector<std::vector<std::string>> rows;
  for (const std::string& name : names) {
    rows.push_back({fmt::format("{} load [%]", name)});
    for (const Column& column : columns) {
      const auto& buses = column.result->cluster.can_buses;
      const auto bus = std::ranges::find(buses, name, &schedules::model::CanBus::name);
      const auto b = static_cast<std::size_t>(bus - buses.begin());
      const std::vector<double>& loads = column.result->outcome.can_load;
      rows.back().push_back(b < loads.size() ? report::drawing::cell(100 * loads[b], 1) : "-");
    }
  }
  return rows;
}

// Rows of measures that share a line of the table.
using Line = std::vector<const Measure*>;

std::vector<Line> lines_of(Subject subject) {
  std::vector<Line> lines;
  for (const Measure& row : evaluation::measures::measures(subject)) {
    if (row.shown.label.empty() || row.shown.place == ShownIn::kPage) continue;
    if (row.shown.join.empty()) lines.emplace_back();
    lines.back().push_back(&row);
  }
  return lines;
}

// Returns whether the drive has the line.
bool has(const DriveFigures& figures, const Measure& first) {
  return applies(first.when, figures) || (!first.shown.absent.empty() && figures.driving != nullptr);
}

std::string cell_of(const Line& line, const DriveFigures& figures) {
  const Measure& first = *line.front();
  if (!has(figures, first)) return "-";
  std::string text;
  bool any = false;
  for (const Measure* row : line) {
    const double value = value_of(*row, figures);
    any = any || std::isfinite(value);
    text += std::string(row->shown.join) + report::drawing::cell(value * row->shown.scale.factor, row->shown.decimals);
  }
  return any ? text : std::string(first.shown.absent.empty() ? "-" : first.shown.absent);
}

void add_lines(report::drawing::Table& table, const std::vector<Column>& columns, Subject subject) {
  for (const Line& line : lines_of(subject)) {
    const Measure& first = *line.front();
    std::vector<std::string> cells{first.shown.line.empty() ? label_of(first) : std::string(first.shown.line)};
    bool any = false;
    for (const Column& column : columns) {
      const DriveFigures figures = figures_of(*column.result);
      cells.push_back(cell_of(line, figures));
      any = any || (has(figures, first) && (!first.shown.is_rare || cells.back() != "0"));
    }
    if (any) table.add(std::move(cells));
  }
}

std::string table_of(const std::vector<Column>& columns, std::size_t in_group) {
  std::vector<std::string> header{"measure"}, hashes{"content hash of the log"};
  for (const Column& column : columns) {
    header.push_back(column.head);
    hashes.push_back(column.result->content_hash.empty() ? "-" : column.result->content_hash);
  }
  report::drawing::Table table(header);
  for (std::size_t column = 0; column < columns.size(); column += in_group) table.begin_group(column + 1);
  for (const Subject subject : {Subject::kErrors, Subject::kLists, Subject::kTracking, Subject::kCluster})
    add_lines(table, columns, subject);
  table.add(std::move(hashes));
  for (std::vector<std::string>& row : can_loads(columns)) table.add(std::move(row));
  add_lines(table, columns, Subject::kDriving);
  return table.text();
}

}  // namespace

DriveFigures figures_of(const StrategyResult& result) {
  return {result.summary, result.outcome, result.driving ? &*result.driving : nullptr};
}

std::string comparison_table(const std::vector<StrategyResult>& results) {
  std::vector<Column> columns;
  for (const StrategyResult& result : results) columns.push_back({std::string(name_of(result.strategy)), &result});
  return table_of(columns, 1);
}

std::string comparison_table(const std::vector<ScenarioResults>& scenarios) {
  if (scenarios.size() == 1) return comparison_table(scenarios.front().results);
  std::vector<Column> columns;
  for (const ScenarioResults& scenario : scenarios)
    for (const StrategyResult& result : scenario.results)
      columns.push_back({fmt::format("{}\n{}", scenario.name, name_of(result.strategy)), &result});
  return table_of(columns, scenarios.front().results.size());
}

std::vector<std::string> picture_files(std::string_view strategy) {
  std::vector<std::string> files{kIndex};
  for (const std::string format : kPictureFormats) {
    files.push_back(kSchedule + format);
    for (const char* const what : kOfStrategy) files.push_back(fmt::format("{}_{}{}", strategy, what, format));
  }
  return files;
}

void write_pictures(const sim::drives::Scenario& scenario, const std::vector<StrategyResult>& results,
                    const std::string& folder) {
  std::vector<report::page::IndexEntry> entries;
  entries.push_back({sim::drives::subject_of(scenario), "", "", comparison_table(results), {"summary.json"}});
  const auto picture = [&](const std::string& name, const std::string& heading, const std::string& caption,
                           const std::string& svg) {
    report::drawing::write_picture(svg, folder + "/" + name + ".svg");
    report::drawing::write_picture(svg, folder + "/" + name + ".png");
    report::drawing::write_picture(svg, folder + "/" + name + ".pdf");
    entries.push_back({heading, name + ".svg", caption, "", {name + ".png", name + ".pdf"}});
  };

  std::vector<std::unique_ptr<report::plots::PositionPlots>> plots;
  std::vector<const report::plots::PositionPlots*> panels;
  std::vector<std::string> titles;
  for (const StrategyResult& result : results) {
    report::drawing::Names names = report::drawing::names_of(result.cluster);
    names.sensor_styles = sensors::kinds::sensor_styles(scenario.sensors, result.cluster);
    names.drive = fmt::format("{}, {}", scenario.name, name_of(result.strategy));
    const std::string strategy(name_of(result.strategy));
    // The timing diagram shows 160 ms, four images, from the begin of the judged part.
    const TrueTime from = sim::drives::evaluation_start(scenario);
    report::timing::TimingDiagram timing(names, result.cluster.cycle(), from, from + Duration::milliseconds(160));
    plots.push_back(std::make_unique<report::plots::PositionPlots>(names, position_options(scenario, result)));
    report::startup::StartupExtent extent;
    DriveProgress progress(sim::drives::drive_end(scenario), "read for pictures");
    std::vector<recording::records::Sink*> readers{&timing, plots.back().get(), &extent, &progress};
    std::optional<report::plots::DrivingPicture> driving;
    if (result.driving) readers.push_back(&driving.emplace(driving_options(scenario, result.cluster, names.drive)));
    recording::records::Tee tee(readers);
    recording::log::read_log(result.log_path, tee);
    if (const auto window = extent.window(result.cluster.cycle())) {
      report::startup::StartupDiagram startup(names, result.cluster.cycle(), window->first, window->second);
      recording::log::read_log(result.log_path, startup);
      picture(strategy + "_startup", strategy + ": start-up", "Every node's states and transmissions.", startup.svg());
    }
    if (result.real_time) {
      picture(strategy + "_lateness", strategy + ": lateness", "Lateness of the nodes' wake-ups, in real time.",
              report::plots::lateness_svg(result.real_time->lateness, names));
      entries.push_back({"", "", "", real_time_text(result), {}});
    }
    picture(strategy + "_timing", strategy + ": timing", "Slots, tasks and every measurement's way.", timing.svg());
    picture(strategy + "_over_time", strategy + ": x and y over time", "", plots.back()->over_time_svg());
    picture(strategy + "_plane", strategy + ": y over x", "", plots.back()->plane_svg());
    if (driving)
      picture(strategy + "_driving", strategy + ": the drive", "Gap, speeds and acceleration of the loop.",
              driving->svg());
    panels.push_back(plots.back().get());
    titles.push_back(strategy);
  }
  if (panels.size() > 1)
    picture("comparison", "The strategies side by side", "y over x, the same axes.",
            report::plots::comparison_svg(panels, titles));
  picture("schedule", "Schedule of " + results.back().cluster.name, "One communication cycle and the multiplexing.",
          report::plots::schedule_svg(results.back().cluster));
  report::page::write_index(folder, scenario.name, entries);
}

}  // namespace ttf::cli::drive
