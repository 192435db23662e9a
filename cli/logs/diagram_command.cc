#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/decimal_option.h"
#include "cli/drive_progress.h"
#include "cli/logs/log_inputs.h"
#include "cli/logs/scan_verdict.h"
#include "cli/logs/viewed_sensors.h"
#include "cli/output.h"
#include "cli/paper_size.h"
#include "cli/time_window.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "recording/exports/lateness_sums.h"
#include "recording/merge/merge.h"
#include "recording/rows/laser_radar_file.h"
#include "report/drawing/render.h"
#include "report/drawing/sheet.h"
#include "report/plots/boxes_picture.h"
#include "report/plots/lateness_picture.h"
#include "report/plots/position_plot.h"
#include "report/scene/scene.h"
#include "report/scene/still.h"
#include "report/startup/diagram.h"
#include "report/timing/diagram.h"
#include "sensors/laser/preprocessor.h"

namespace ttf::cli::logs {
namespace {

std::vector<recording::rows::RecordedScan> read_scans(const std::string& path) {
  try {
    return recording::rows::read_lidar_scans(path);
  } catch (const InputError&) {
    refuse_any_kind(path, "a recording");
    throw;
  }
}

// Returns the part of a vehicle that was seen, as a box: the rest is not known. An end or a side is a line, and so is a
// corner with one known face. A silhouette is a place.
report::plots::Box box_of(const sensors::laser::LaserObject& object) {
  using ttf::fusion::sensors::SeenPoint;
  report::plots::Box box{object.x, object.y, object.heading, object.length, object.width, "", object.has_heading};
  if (object.seen != SeenPoint::kCorner) return box;
  // From the near corner away from the sensor, along both axes.
  const double c = std::cos(object.heading), s = std::sin(object.heading);
  const double along = std::copysign(0.5 * object.length, c * object.x + s * object.y);
  const double across = std::copysign(0.5 * object.width, c * object.y - s * object.x);
  box.x += c * along - s * across;
  box.y += s * along + c * across;
  return box;
}

// Draws a recorded laser scan and the vehicles that preprocessing finds in it. Returns the exit code: without any
// vehicle there is a picture, and the reasons.
int draw_boxes(const std::string& file, int frame, const report::drawing::Sheet& sheet, const std::string& out) {
  const std::vector<recording::rows::RecordedScan> scans = read_scans(file);
  if (frame >= static_cast<int>(scans.size()))
    throw InputError(
        {"command line", 0, "--frame", fmt::format("{}", frame),
         fmt::format("must be 0..{}: the recording has {}", scans.size() - 1, counted(scans.size(), "scan"))});
  const recording::rows::RecordedScan& scan = scans[static_cast<std::size_t>(frame)];
  std::vector<sensors::laser::ScanPoint> points;
  std::vector<report::drawing::Point> drawn;
  for (const recording::rows::RecordedReturn& hit : scan.returns) {
    points.push_back({0, hit.azimuth_rad, hit.range_m});
    drawn.push_back({hit.range_m * std::cos(hit.azimuth_rad), hit.range_m * std::sin(hit.azimuth_rad)});
  }
  std::vector<sensors::laser::LaserObject> objects;
  const sensors::laser::LaserPreprocessingConfig config;
  sensors::laser::LaserPreprocessor preprocessor(config, points.size());
  preprocessor.process(points, objects);
  std::vector<report::plots::Box> rectangles;
  for (const sensors::laser::LaserObject& object : objects) rectangles.push_back(box_of(object));
  const std::string title = fmt::format("Scan {}: {}, {} box{}", scan.frame, counted(points.size(), "return"),
                                        objects.size(), objects.size() == 1 ? "" : "es");
  report::drawing::write_picture(report::plots::boxes_svg(drawn, rectangles, title, "fitted box", sheet), out);
  say_written(out);
  return print_reasons(file, title, reasons_for_no_box(config, preprocessor.fates()));
}

constexpr std::int64_t kMostScans = 1'000'000'000, kMostObjects = 65'536;

struct DiagramOptions {
  std::vector<std::string> logs;
  TimeWindowOptions window;
  std::string kind = "timing";
  std::string out;
  std::optional<int> frame, object;
  PaperSizeOptions paper;
  std::optional<std::string> at;
};

// Finds the end of the last task.
struct Extent final : recording::records::Sink {
  TrueTime last{};
  using recording::records::Sink::on;
  void on(const recording::records::TaskRun& run) override { last = std::max(last, run.end.true_time); }
};

// Without options, shows the whole start-up and two cycles after it.
std::string startup(const DiagramOptions& options, const report::drawing::Sheet& sheet) {
  const TimeWindow window = time_window(options.window);
  const recording::merge::MergedLogs drive = drive_in(options.logs);
  report::startup::StartupExtent extent;
  read_shown(drive, extent);
  const Duration cycle{drive.manifest().cycle_ns};
  const auto whole = extent.window(cycle).value_or(std::pair(TrueTime{}, TrueTime{}));
  report::startup::StartupDiagram diagram(report::drawing::names_of(drive.manifest()), cycle,
                                          window.from.value_or(whole.first), window.to.value_or(whole.second));
  read_shown(drive, diagram);
  return diagram.svg(sheet);
}

// Shows the whole drive: a histogram has no time window.
std::string lateness(const DiagramOptions& options, const report::drawing::Sheet& sheet) {
  for (const auto& [name, text] : {std::pair("--from", options.window.from), std::pair("--to", options.window.to)})
    if (text)
      throw InputError(
          {"command line", 0, name, *text, "does not go with --kind lateness, which shows the whole drive"});
  const recording::merge::MergedLogs drive = drive_in(options.logs);
  recording::exports::LatenessSums sums;
  read_shown(drive, sums);
  if (sums.nodes().empty())
    throw InputError({options.logs[0], 0, "", "", "has no lateness: the run was not in real time"});
  return report::plots::lateness_svg(sums.nodes(), report::drawing::names_of(drive.manifest()), sheet);
}

std::string timing(const recording::merge::MergedLogs& drive, TrueTime from, TrueTime to,
                   const report::drawing::Sheet& sheet) {
  report::timing::TimingDiagram diagram(report::drawing::names_of(drive.manifest()), {drive.manifest().cycle_ns}, from,
                                        to);
  read_shown(drive, diagram);
  return diagram.svg(sheet);
}

// Draws several drives side by side.
std::string positions(const std::vector<recording::merge::MergedLogs>& drives, TrueTime from, TrueTime to,
                      const DiagramOptions& options, const report::drawing::Sheet& sheet) {
  const bool plane = options.kind == "plane";
  std::vector<std::unique_ptr<report::plots::PositionPlots>> plots;
  std::vector<const report::plots::PositionPlots*> panels;
  std::vector<std::string> titles;
  for (const recording::merge::MergedLogs& drive : drives) {
    report::plots::PositionOptions position;
    position.title = fmt::format("{}, {}", drive.manifest().scenario_name, drive.manifest().strategy);
    position.from = from;
    position.to = to;
    if (options.object) {
      position.object = static_cast<ObjectId>(*options.object);
      position.title += fmt::format(", object {}", *options.object);
    }
    plots.push_back(
        std::make_unique<report::plots::PositionPlots>(report::drawing::names_of(drive.manifest()), position));
    read_shown(drive, *plots.back());
    panels.push_back(plots.back().get());
    const std::vector<ObjectId> objects = plots.back()->objects();
    if (options.object && std::ranges::find(objects, *position.object) == objects.end())
      throw InputError({"command line", 0, "--object", fmt::format("{}", *options.object),
                        objects.empty() ? "needs the truth, and the log has none"
                                        : fmt::format("must be an object of the log, which has {}..{}",
                                                      index_of(objects.front()), index_of(objects.back()))});
    titles.push_back(drive.manifest().strategy);
  }
  if (plots.size() > 1)
    return report::plots::comparison_svg(
        panels, titles, plane ? report::plots::PositionView::kPlane : report::plots::PositionView::kXOverTime, {},
        sheet);
  return plane ? plots[0]->plane_svg(sheet) : plots[0]->over_time_svg(sheet);
}

// Draws a timing diagram, or positions.
std::string over_time(const DiagramOptions& options, const report::drawing::Sheet& sheet) {
  const TimeWindow window = time_window(options.window);
  const bool as_timing = options.kind == "timing";
  std::vector<recording::merge::MergedLogs> drives;
  if (as_timing)
    drives.push_back(drive_in(options.logs));
  else
    drives = drives_in(options.logs);
  Extent extent;
  for (const recording::merge::MergedLogs& drive : drives) read_shown(drive, extent);
  const TrueTime from = window.begin();
  if (extent.last == TrueTime{}) throw InputError({options.logs[0], 0, "", "", "has no execution of a task to draw"});
  if (from > extent.last)
    throw InputError({"command line", 0, "--from", *options.window.from,
                      fmt::format("must be before the end of the log, {} s", (extent.last - TrueTime{}).seconds())});
  // A timing diagram of a whole drive is unreadable: the default is 160 ms.
  const TrueTime to = window.to ? *window.to : as_timing ? from + Duration::milliseconds(160) : extent.last;
  return as_timing ? timing(drives[0], from, to, sheet) : positions(drives, from, to, options, sheet);
}

// Draws the scene at an instant, by default half-way through the log.
std::string scene(const DiagramOptions& options, const report::drawing::Sheet& sheet) {
  for (const auto& [name, text] : {std::pair("--from", options.window.from), std::pair("--to", options.window.to)})
    if (text)
      throw InputError(
          {"command line", 0, name, *text, "does not go with --kind scene, which shows one instant (--at)"});
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  constexpr Range<std::int64_t> kInstants{0, 1'000'000'000 * kNsPerSecond};  // as of a time window
  std::optional<TrueTime> at;
  if (options.at) at = TrueTime{decimal_option("--at", *options.at, kNsPerSecond, kInstants, " s")};
  const recording::merge::MergedLogs drive = drive_in(options.logs);
  Extent extent;
  read_shown(drive, extent);
  if (extent.last == TrueTime{}) throw InputError({options.logs[0], 0, "", "", "has no execution of a task to draw"});
  if (at && *at > extent.last)
    throw InputError({"command line", 0, "--at", *options.at,
                      fmt::format("must be at most {} s, the end of the log", (extent.last - TrueTime{}).seconds())});
  const TrueTime shown = at.value_or(TrueTime{extent.last.ns / 2});
  std::vector<std::string> warnings;
  report::scene::SceneLimits limits;
  limits.bytes = std::numeric_limits<std::size_t>::max();
  limits.from = shown - report::scene::SceneSink::kBefore;
  limits.to = shown + report::scene::SceneSink::kAfter;
  report::scene::SceneSink sink(viewed_sensors(drive, warnings), limits);
  read_shown(drive, sink);
  for (const std::string& warning : warnings) print_warnings(warning);
  const report::drawing::Names names = report::drawing::names_of(drive.manifest());
  return report::scene::scene_svg(sink.finished(), shown, names, names.drive, sheet);
}

// Draws any kind but boxes.
std::string picture(const DiagramOptions& options) {
  if (options.frame)
    throw InputError({"command line", 0, "--frame", fmt::format("{}", *options.frame), "goes with --kind boxes only"});
  if (options.object && options.kind != "position" && options.kind != "plane")
    throw InputError(
        {"command line", 0, "--object", fmt::format("{}", *options.object), "goes with --kind position or plane only"});
  if (options.at && options.kind != "scene")
    throw InputError({"command line", 0, "--at", *options.at, "goes with --kind scene only"});
  const report::drawing::Sheet sheet = sheet_of(options.paper);
  if (options.kind == "startup") return startup(options, sheet);
  if (options.kind == "scene") return scene(options, sheet);
  return options.kind == "lateness" ? lateness(options, sheet) : over_time(options, sheet);
}

int run_diagram(const DiagramOptions& options) {
  report::drawing::check_picture_path(options.out);
  if (options.object && options.kind != "position" && options.kind != "plane")
    throw InputError(
        {"command line", 0, "--object", fmt::format("{}", *options.object), "goes with --kind position or plane only"});
  if (options.kind == "boxes") {
    if (options.logs.size() != 1) throw InputError({"command line", 0, "--kind", "boxes", "takes one recording"});
    return draw_boxes(options.logs[0], options.frame.value_or(0), sheet_of(options.paper), options.out);
  }
  report::drawing::write_picture(picture(options), options.out);
  say_written(options.out);
  return 0;
}

}  // namespace

void add_diagram(CLI::App& app, Action& action) {
  auto options = std::make_shared<DiagramOptions>();
  CLI::App* command =
      app.add_subcommand("diagram", "Timing and start-up diagrams, position plots and scenes from logs");
  command->footer(
      "The logs of a run's processes are merged; position and plane show several runs side by side.\n"
      "Examples: ttfusion diagram out/drive/tt.mcap --from 1.5 --to 1.65 -o out/timing.svg\n"
      "          ttfusion diagram out/launch/*.mcap --from 1.5 --to 1.65 -o out/timing.svg\n"
      "          ttfusion diagram out/cold_start/tt.mcap --kind startup -o out/startup.svg\n"
      "          ttfusion diagram out/drive/tt.mcap --kind plane --width 88mm --font-size 8 -o out/plane.pdf\n"
      "          ttfusion diagram out/drive/tt.mcap --kind scene --at 1.5 -o out/scene.svg");
  command
      ->add_option(
          "logs", options->logs,
          "Logs: one of a run, or one of each of its processes, or its folder (with --kind boxes: a recording of laser "
          "scans)")
      ->required();
  add_time_window(
      *command, options->window,
      "Start of the time window, in true time (default: 0; for a start-up diagram the start-up's)",
      "End of the time window, in true time (default: the end; for a timing diagram 160 ms after its start, "
      "for a start-up diagram two cycles after the start-up)");
  command
      ->add_option(
          "--kind", options->kind,
          "timing, startup (states and transmissions), lateness (of wake-ups, in real time), "
          "position (x and y over time), plane (y over x), scene (an instant, seen from above), or boxes (of a "
          "recorded laser scan)")
      ->check(one_of({"timing", "startup", "lateness", "position", "plane", "scene", "boxes"}))
      ->capture_default_str();
  command
      ->add_option("--object", options->object,
                   "The object in detail, with --kind position or plane (default: all, if there are several)")
      ->check(whole_number({0, kMostObjects - 1}));
  command->add_option("--frame", options->frame, "Which scan of a recording, with --kind boxes")
      ->check(whole_number({0, kMostScans - 1}));
  command->add_option("--at", options->at, "Instant of a scene, in true time [s] (default: half-way through the log)");
  add_paper_size(*command, options->paper);
  command->add_option("-o,--out", options->out, "Picture to write: .svg, .png or .pdf")->required()->check(named());
  command->callback([options, &action] { action = [options] { return run_diagram(*options); }; });
}

}  // namespace ttf::cli::logs
