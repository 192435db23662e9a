#include "cli/drive/run_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/drive/driving_outputs.h"
#include "cli/drive/fault_tables.h"
#include "cli/drive/real_time_outputs.h"
#include "cli/drive/recording_outputs.h"
#include "cli/drive/startup_outputs.h"
#include "cli/drive_progress.h"
#include "cli/tracking_outputs.h"
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

double us(Duration d) { return static_cast<double>(d.ns) * 1e-3; }

using Value = std::string (*)(const ttf::cli::drive::StrategyResult&);
struct Row {
  const char* name;
  Value value;
  bool rare = false;  // 0 in a sound drive: shown if it is not 0 for some strategy
};

std::string number(std::uint64_t n) { return fmt::format("{}", n); }
// An absent age is "-", not 0.
std::string mean_cell(const evaluation::accuracy::AgeStatistics& ages) {
  return ages.count == 0 ? "-" : report::drawing::cell(in_ms(ages.mean()), 1);
}
std::string worst_cell(const evaluation::accuracy::AgeStatistics& ages) {
  return ages.count == 0 ? "-" : report::drawing::cell(in_ms(ages.worst), 1);
}

// Returns how often the feature service had an image and used it.
std::uint64_t uses(const StrategyResult& result) { return result.summary.uses - result.summary.stale_uses; }

// A single clock, or clocks that never ran together, have no precision instead of a perfect one.
std::optional<double> precision_us(const StrategyResult& result) {
  return result.outcome.precision.ns == 0 ? std::nullopt : std::optional(us(result.outcome.precision));
}

// Counts lists that were made and never fused: too late for the strategy, or lost between tasks.
std::uint64_t lost_lists(const StrategyResult& result) {
  const nodes::host::ExecutiveCounts& counts = result.outcome.counts;
  return result.summary.dropped + counts.torn_lists + counts.overwritten_lists + counts.discarded_lists;
}

const Row kRows[] = {
    {"position RMSE against truth [m]",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.position_rmse_truth, 3); }},
    {"velocity RMSE against truth [m/s]",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.velocity_rmse_truth, 3); }},
    {"  x, y, vx, vy",
     [](const StrategyResult& r) {
       const auto& rmse = r.summary.rmse_truth;
       return fmt::format("{} {} {} {}", report::drawing::cell(rmse[0], 2), report::drawing::cell(rmse[1], 2),
                          report::drawing::cell(rmse[2], 2), report::drawing::cell(rmse[3], 2));
     }},
    {"  visible face, gap to it [m]",
     [](const StrategyResult& r) {
       return fmt::format("{} {}", report::drawing::cell(r.summary.box.face_m, 3),
                          report::drawing::cell(r.summary.box.gap_m, 3));
     }},
    {"  heading [rad], speed [m/s]",
     [](const StrategyResult& r) {
       return fmt::format("{} {}", report::drawing::cell(r.summary.box.heading_rad, 3),
                          report::drawing::cell(r.summary.box.speed_mps, 3));
     }},
    {"  acceleration [m/s^2]",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.box.acceleration_mps2, 3); }},
    {"  length, width [m]",
     [](const StrategyResult& r) {
       return fmt::format("{} {}", report::drawing::cell(r.summary.box.length_m, 3),
                          report::drawing::cell(r.summary.box.width_m, 3));
     }},
    {"position RMSE against DGPS [m]",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.position_rmse_reference, 3); }},
    {"velocity RMSE against DGPS [m/s]",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.velocity_rmse_reference, 3); }},
    {"NEES (4 degrees of freedom)", [](const StrategyResult& r) { return report::drawing::cell(r.summary.nees, 2); }},
    {"  95 % band",
     [](const StrategyResult& r) {
       return r.summary.nees_samples == 0 ? std::string("-")
                                          : fmt::format("{:.2f}..{:.2f}", r.summary.nees_low, r.summary.nees_high);
     }},
    {"  of heading, speed, acceleration",
     [](const StrategyResult& r) {
       const evaluation::accuracy::OwnJudgement& own = r.summary.own;
       return fmt::format("{} {} {}", report::drawing::cell(own.heading, 2), report::drawing::cell(own.speed, 2),
                          report::drawing::cell(own.acceleration, 2));
     }},
    {"  of length, width",
     [](const StrategyResult& r) {
       return fmt::format("{} {}", report::drawing::cell(r.summary.own.length, 2),
                          report::drawing::cell(r.summary.own.width, 2));
     }},
    {"NIS per degree of freedom",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.own.innovations, 2); }},
    {"age when fused, mean [ms]", [](const StrategyResult& r) { return mean_cell(r.summary.age_fused); }},
    {"age when fused, worst [ms]", [](const StrategyResult& r) { return worst_cell(r.summary.age_fused); }},
    {"age when used, mean [ms]", [](const StrategyResult& r) { return mean_cell(r.summary.age_used); }},
    {"age when used, worst [ms]", [](const StrategyResult& r) { return worst_cell(r.summary.age_used); }},
    {"observation lists received", [](const StrategyResult& r) { return number(r.summary.received); }},
    {"  arrived out of sequence", [](const StrategyResult& r) { return number(r.summary.out_of_sequence); }},
    {"  fused late (retrodicted)", [](const StrategyResult& r) { return number(r.summary.fused_late); }},
    {"  times held back", [](const StrategyResult& r) { return number(r.summary.held); }},
    {"  held back for, mean / worst [ms]",
     [](const StrategyResult& r) {
       const evaluation::accuracy::AgeStatistics& held = r.summary.held_for;
       return held.count == 0 ? std::string("-") : mean_cell(held) + " / " + worst_cell(held);
     }},
    {"  dropped", [](const StrategyResult& r) { return number(lost_lists(r)); }},
    {"    too old to be fused", [](const StrategyResult& r) { return number(r.summary.dropped); }, true},
    {"    torn on the way", [](const StrategyResult& r) { return number(r.outcome.counts.torn_lists); }, true},
    {"    overwritten before being read",
     [](const StrategyResult& r) { return number(r.outcome.counts.overwritten_lists); }, true},
    {"    discarded: no time measured",
     [](const StrategyResult& r) { return number(r.outcome.counts.discarded_lists); }, true},
    {"times that odometry stopped", [](const StrategyResult& r) { return number(r.summary.odometry_stops); }, true},
    {"fragments refused", [](const StrategyResult& r) { return number(r.outcome.counts.refused_fragments); }, true},
    {"uses of an image", [](const StrategyResult& r) { return number(uses(r)); }},
    {"  refused for its age", [](const StrategyResult& r) { return number(r.summary.stale_uses); }, true},
    {"  with a warning", [](const StrategyResult& r) { return number(r.summary.warnings); }},
    {"objects compared / missed / spurious",
     [](const StrategyResult& r) {
       if (r.summary.matched + r.summary.missed + r.summary.spurious == 0) return std::string("-");
       return fmt::format("{} / {} / {}", r.summary.matched, r.summary.missed, r.summary.spurious);
     }},
    {"GOSPA [m]",
     [](const StrategyResult& r) { return report::drawing::cell(r.summary.tracking.gospa.distance_m, 3); }},
    {"  located, missed, false",
     [](const StrategyResult& r) {
       const fusion::metrics::Gospa& gospa = r.summary.tracking.gospa;
       return fmt::format("{} {} {}", report::drawing::cell(gospa.localisation, 3),
                          report::drawing::cell(gospa.missed, 3), report::drawing::cell(gospa.false_estimates, 3));
     }},
    {"MOTA [%] / switches of track",
     [](const StrategyResult& r) {
       const fusion::metrics::ClearMotCounts& mot = r.summary.tracking.mot;
       if (mot.objects == 0) return std::string("-");
       return fmt::format("{} / {}", report::drawing::cell(100 * mot.mota(), 1), mot.switches);
     }},
    {"precision of the time base [us]",
     [](const StrategyResult& r) {
       const auto precision = precision_us(r);
       return precision ? report::drawing::cell(*precision, 3) : std::string("-");
     }},
    {"slot problems", [](const StrategyResult& r) { return number(r.outcome.counts.slot_problems); }},
    {"deadlines missed", [](const StrategyResult& r) { return number(r.outcome.counts.deadlines_missed); }},
    {"FlexRay load per channel [%]",
     [](const StrategyResult& r) { return report::drawing::cell(100 * r.outcome.flexray_load, 1); }},
    {"content hash of the log",
     [](const StrategyResult& r) { return r.content_hash.empty() ? std::string("-") : r.content_hash; }},
    {"CAN frames refused", [](const StrategyResult& r) { return number(r.outcome.counts.refused_can_frames); }, true},
    {"lists without a record of their fate",
     [](const StrategyResult& r) { return number(r.outcome.counts.unlisted_fates); }, true},
};

nlohmann::ordered_json ages(const evaluation::accuracy::AgeStatistics& statistics) {
  if (statistics.count == 0) return {{"count", 0}, {"mean_ms", nullptr}, {"worst_ms", nullptr}};
  return {{"count", statistics.count}, {"mean_ms", in_ms(statistics.mean())}, {"worst_ms", in_ms(statistics.worst)}};
}

nlohmann::ordered_json statistics_json(const evaluation::ages::DurationStatistics& had) {
  if (had.count == 0) return nullptr;
  return {{"least_ms", in_ms(had.least)},
          {"mean_ms", in_ms(had.mean())},
          {"p99_ms", in_ms(had.p99())},
          {"most_ms", in_ms(had.most)}};
}

nlohmann::ordered_json bounds_json(std::optional<Duration> best, std::optional<Duration> worst) {
  nlohmann::ordered_json bounds{nullptr, nullptr};
  if (best) bounds[0] = in_ms(*best);
  if (worst) bounds[1] = in_ms(*worst);
  return bounds;
}

nlohmann::ordered_json stages_json(const evaluation::ages::SensorStages& sensor) {
  nlohmann::ordered_json json{
      {"measured", sensor.measured}, {"seen", sensor.seen()}, {"to", sensor.to_use ? "use" : "fusion"}};
  for (const evaluation::ages::StageFinding& stage : sensor.stages)
    json["stages"].push_back({{"stage", stage.name},
                              {"bounds_ms", bounds_json(stage.best, stage.worst)},
                              {"had", statistics_json(stage.had)},
                              {"age_bounds_ms", bounds_json(stage.age_best, stage.age_worst)},
                              {"age", statistics_json(stage.age)},
                              {"beyond", stage.beyond}});
  return json;
}

nlohmann::ordered_json box_json(const evaluation::accuracy::BoxErrors& box) {
  return {{"face_m", box.face_m},
          {"gap_m", box.gap_m},
          {"heading_rad", box.heading_rad},
          {"speed_mps", box.speed_mps},
          {"acceleration_mps2", box.acceleration_mps2},
          {"length_m", box.length_m},
          {"width_m", box.width_m}};
}

nlohmann::ordered_json own_json(const evaluation::accuracy::OwnJudgement& own) {
  return {{"position", own.position}, {"velocity", own.velocity},         {"heading", own.heading},
          {"speed", own.speed},       {"acceleration", own.acceleration}, {"length", own.length},
          {"width", own.width}};
}

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

}  // namespace

namespace {

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

std::string table_of(const std::vector<Column>& columns, std::size_t in_group) {
  std::vector<std::string> header{"measure"};
  for (const Column& column : columns) header.push_back(column.head);
  report::drawing::Table table(header);
  for (std::size_t column = 0; column < columns.size(); column += in_group) table.begin_group(column + 1);
  for (const Row& row : kRows) {
    std::vector<std::string> cells{row.name};
    bool any = false;
    for (const Column& column : columns) {
      cells.push_back(row.value(*column.result));
      any = any || cells.back() != "0";
    }
    if (any || !row.rare) table.add(std::move(cells));
  }
  for (std::vector<std::string>& row : can_loads(columns)) table.add(std::move(row));
  std::vector<const StrategyResult*> results;
  for (const Column& column : columns) results.push_back(column.result);
  for (std::vector<std::string>& row : driving_rows(results)) table.add(std::move(row));
  return table.text();
}

}  // namespace

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

// Values that are not finite become null.
nlohmann::ordered_json to_json(const sim::drives::Scenario& scenario, std::uint64_t seed,
                               const std::vector<StrategyResult>& results) {
  nlohmann::ordered_json json;
  json["scenario"] = scenario.name;
  json["seed"] = seed;
  json["duration_s"] = scenario.duration.seconds();
  if (scenario.truth) {
    json["truth"] = {{"file", scenario.truth->name}, {"length_s", scenario.truth->length().seconds()}};
    for (const recording::osi::TracedObject& object : scenario.truth->objects)
      json["truth"]["objects"].push_back({{"id", object.id}, {"kind", name_of(object.kind)}});
  }
  for (const StrategyResult& result : results) {
    const evaluation::accuracy::DriveSummary& s = result.summary;
    nlohmann::ordered_json one;
    one["strategy"] = name_of(result.strategy);
    one["cluster"] = result.cluster.name;
    one["rmse_truth"] = {{"position_m", s.position_rmse_truth},
                         {"velocity_mps", s.velocity_rmse_truth},
                         {"x", s.rmse_truth[0]},
                         {"y", s.rmse_truth[1]},
                         {"vx", s.rmse_truth[2]},
                         {"vy", s.rmse_truth[3]}};
    one["rmse_reference"] = {{"position_m", s.position_rmse_reference},
                             {"velocity_mps", s.velocity_rmse_reference},
                             {"compared", s.reference_compared}};
    one["rmse_box"] = box_json(s.box);
    one.update(tracking_json(s.tracking));
    one["nees"] = {{"mean", s.nees},
                   {"samples", s.nees_samples},
                   {"degrees_of_freedom", 4},
                   {"band_95", {s.nees_low, s.nees_high}},
                   {"per_degree", own_json(s.own)}};
    one["nis"] = {{"per_degree", s.own.innovations}, {"degrees_of_freedom", s.own.innovation_degrees}};
    one["age_when_fused"] = ages(s.age_fused);
    one["age_when_used"] = ages(s.age_used);
    for (const auto& [sensor, statistics] : s.age_used_by_sensor)
      one["age_when_used_by_sensor"][result.cluster.sensor(sensor).name] = ages(statistics);
    for (const evaluation::ages::SensorStages& sensor : result.stages)
      one["age_by_stage"][result.cluster.sensor(sensor.sensor).name] = stages_json(sensor);
    one["observations"] = {{"received", s.received},
                           {"out_of_sequence", s.out_of_sequence},
                           {"fused", s.fused},
                           {"late", s.fused_late},
                           {"held", s.held},
                           {"dropped", s.dropped},
                           {"duplicates", s.duplicates},
                           {"torn", result.outcome.counts.torn_lists},
                           {"overwritten", result.outcome.counts.overwritten_lists},
                           {"discarded", result.outcome.counts.discarded_lists},
                           {"lost", lost_lists(result)}};
    if (s.odometry_samples + s.odometry_stops > 0)
      one["odometry"] = {{"samples", s.odometry_samples}, {"stops", s.odometry_stops}};
    one["held_back_for"] = ages(s.held_for);
    one["objects"] = {{"compared", s.matched}, {"missed", s.missed}, {"spurious", s.spurious}};
    one["uses"] = s.uses;
    one["uses_with_warning"] = s.warnings;
    if (!result.startup.empty()) one["startup"] = startup_json(result);
    one["uses_refused_as_stale"] = s.stale_uses;
    one["precision_us"] = nullptr;
    if (const auto precision = precision_us(result)) one["precision_us"] = *precision;
    one["slot_problems"] = result.outcome.counts.slot_problems;
    one["deadlines_missed"] = result.outcome.counts.deadlines_missed;
    one["overruns"] = result.outcome.counts.overruns;
    one["saturated_signals"] = result.outcome.counts.saturated_signals;
    one["refused_fragments"] = result.outcome.counts.refused_fragments;
    one["refused_can_frames"] = result.outcome.counts.refused_can_frames;
    one["unlisted_fates"] = result.outcome.counts.unlisted_fates;
    one["frames_sent"] = result.outcome.frames_sent;
    one["flexray_load"] = result.outcome.flexray_load;
    for (std::size_t b = 0; b < result.outcome.can_load.size(); ++b)
      one["can_load"][result.cluster.can_buses[b].name] = result.outcome.can_load[b];
    one["content_hash"] = result.content_hash;
    one["log"] = result.log_path;
    if (result.driving) one["driving"] = driving_json(*result.driving);
    if (result.recording) one["recording"] = recording_json(result, scenario.tracker);
    if (result.real_time) one["real_time"] = real_time_json(result);
    if (!scenario.faults.empty()) {
      one["faults"] = faults_json(result.faults.faults, result.cluster);
      one["fault_free_nodes"] = names_json(result.fault_free, result.cluster);
      one["unattributed"] = unattributed_json(result.faults.unattributed, result.cluster);
      if (!result.faults.cans.empty()) one["cans"] = cans_json(result.faults.cans, result.cluster);
    }
    json["strategies"].push_back(std::move(one));
  }
  return json;
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
    names.sensor_styles = sim::drives::sensor_styles(scenario.sensors, result.cluster);
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
