#include "report/drive/drive_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "core/counted.h"
#include "recording/records/tee.h"
#include "report/drive/plots.h"
#include "report/drive/scenario_words.h"
#include "report/scene/packed.h"
#include "report/timing/diagram.h"
#include "report/timing/windows/packed.h"
#include "report/timing/windows/painted.h"

namespace ttf::report::drive {
namespace {

constexpr Duration kLongestDiagram = Duration::milliseconds(2000);

// Sensors whose places are unknown have their names and colours.
std::vector<scene::ViewedSensor> sensors_of(const Drive& drive) {
  if (!drive.sensors.empty()) return drive.sensors;
  const drawing::Names names = drawing::names_of(drive.log->manifest());
  std::vector<scene::ViewedSensor> sensors;
  for (std::size_t s = 0; s < names.sensors.size(); ++s) {
    const auto id = static_cast<SensorId>(s);
    sensors.push_back({names.sensor(id), drawing::sensor_colour(names, id), std::nullopt, std::nullopt});
  }
  return sensors;
}

}  // namespace

std::vector<ReportedDrive> reported_drives(const std::vector<const Drive*>& drives) {
  std::vector<ReportedDrive> reported;
  std::size_t scenes = 0;
  for (const Drive* drive : drives) {
    ReportedDrive& one = reported.emplace_back();
    one.drive = drive;
    if (!drive->log) continue;
    DriveSeriesSink series;
    if (scenes++ < kMostScenes) {
      scene::SceneSink scene(sensors_of(*drive), {});
      recording::records::Tee both({&series, &scene});
      drive->log->read(both);
      one.scene = scene.finished();
    } else {
      drive->log->read(series);
    }
    one.series = series.finish();
  }
  return reported;
}

void scene_section(page::Page& page, const std::vector<ReportedDrive>& drives) {
  std::vector<nlohmann::ordered_json> scenes;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    const ReportedDrive& reported = drives[d];
    if (reported.scene.empty()) continue;
    const drawing::Names names = drawing::names_of(reported.drive->log->manifest());
    scenes.push_back(scene::packed(reported.scene, names, reported.drive->label, static_cast<int>(d)));
  }
  if (scenes.empty()) return;
  const auto logs = static_cast<std::size_t>(
      std::ranges::count_if(drives, [](const ReportedDrive& reported) { return reported.drive->log != nullptr; }));
  page.section("The drive from above");
  std::string caption;
  if (logs > kMostScenes) caption = fmt::format("The first {} of {} drives are shown. ", kMostScenes, logs);
  const bool moves =
      std::ranges::any_of(drives, [](const ReportedDrive& reported) { return !reported.scene.own.empty(); });
  caption += "In the vehicle's frame, x to the right. Tracks are moved on by their velocity ";
  caption += moves ? "over ground, and by the vehicle's own motion, from image to image. Trails and the lines to where "
                     "tracks are after a second are relative to the vehicle. "
                   : "from image to image. ";
  page.scenes(std::move(scenes), caption + "Plots over time and timing diagrams show the same instant.");
}

void errors_section(page::Page& page, const std::vector<ReportedDrive>& drives) {
  const page::Plot plots[] = {error_plot(drives), age_histogram(drives), age_plot(drives)};
  if (std::ranges::all_of(plots, [](const page::Plot& plot) { return plot.views.empty(); })) return;
  page.section("Errors and ages");
  for (const page::Plot& plot : plots) page.plot(plot);
}

void timing_section(page::Page& page, const std::vector<ReportedDrive>& drives, const DiagramWindow& window) {
  std::vector<page::PageDiagram> diagrams;
  std::vector<std::string> shown, left_out;
  const auto logs = static_cast<std::size_t>(
      std::ranges::count_if(drives, [](const ReportedDrive& reported) { return reported.drive->log != nullptr; }));
  const std::size_t drawn = std::min(logs, window.most);
  for (const ReportedDrive& reported : drives) {
    if (!reported.drive->log || diagrams.size() >= drawn) continue;
    const recording::log::LogManifest& manifest = reported.drive->log->manifest();
    const drawing::Names names = drawing::names_of(manifest);
    TrueTime from = window.from.value_or(scenario_in(*reported.drive->log).judged_from);
    // The given end lies before the judged part: the window ends there.
    if (!window.from && window.to && *window.to <= from) from = std::max(TrueTime{}, *window.to - window.length);
    const TrueTime to = std::min(window.to.value_or(from + window.length), from + kLongestDiagram);
    timing::TimingDiagram diagram(names, {manifest.cycle_ns}, from, to);
    timing::windows::WindowPacker packer(window.packed_bytes / drawn);
    timing::windows::PaintedWindows windows(
        names, {manifest.cycle_ns}, from, std::max(to - from, window.length),
        [&](TrueTime begin, TrueTime end, const std::string& svg) { return packer.add(begin, end, svg); });
    recording::records::Tee both({&diagram, &windows});
    reported.drive->log->read(both);
    windows.finish();
    if (const std::optional<TrueTime> end = packer.full_at(); end && in_ms(*end) < 1e3 * reported.series.end_s)
      left_out.push_back(fmt::format("{} from {:.3f} s on", reported.drive->label, in_ms(*end) * 1e-3));
    diagrams.push_back({reported.drive->label, diagram.svg(timing::TimingUse::kPage), packer.finish()});
    shown.push_back(fmt::format("{:g} ms from {:g} s on", in_ms(to - from), in_ms(from) * 1e-3));
  }
  if (diagrams.empty()) return;
  std::string caption = "A window of each drive";
  if (std::ranges::count(shown, shown.front()) == std::ssize(shown))
    caption += fmt::format(" is drawn, first {}", shown.front());
  else
    for (std::size_t d = 0; d < diagrams.size(); ++d) diagrams[d].label += ", first " + shown[d];
  caption += "; the slider, P and N choose others, and so does an instant chosen elsewhere. ";
  if (!left_out.empty()) caption += fmt::format("Too long for a page, and left out: {}. ", joined(left_out));
  page.section("Timing: slots, tasks and every measurement's way");
  if (logs > drawn) caption += fmt::format("The first {} of {} drives are drawn. ", drawn, logs);
  page.diagrams(std::move(diagrams),
                caption +
                    "Arrows follow each measurement; point at a slot, a task or an arrow to see its source, its "
                    "times and ages.");
}

void time_base_section(page::Page& page, const std::vector<ReportedDrive>& drives, std::size_t most) {
  const page::Plot precision = precision_plot(drives);
  std::vector<page::Plot> corrections;
  for (const ReportedDrive& reported : drives)
    if (reported.drive->log && !reported.series.offset_corrections.empty() && corrections.size() < most)
      corrections.push_back(corrections_plot(reported, drawing::names_of(reported.drive->log->manifest())));
  if (precision.views.empty() && corrections.empty()) return;
  page.section("The time base");
  if (precision.views.empty())
    page.paragraph(
        "Each node was a process of its own: no process saw all clocks, so the log has no precision over time.");
  page.plot(precision);
  if (corrections.empty()) return;
  page.open_details("Clock corrections, node by node");
  for (const page::Plot& plot : corrections) page.plot(plot);
  page.close_details();
}

void troubles_section(page::Page& page, const std::vector<ReportedDrive>& drives) {
  page.section("Faults and problems");
  std::vector<std::string> without;
  for (const ReportedDrive& reported : drives)
    if (!reported.drive->log) without.push_back(reported.drive->label);
  const std::string elsewhere =
      "slot problems and missed deadlines are in the table above only; faults, if any, in summary.json.";
  if (without.size() == drives.size()) {
    page.paragraph("There is no log: " + elsewhere);
    return;
  }
  bool any = false;
  for (const ReportedDrive& reported : drives)
    for (const page::PageTable& table : trouble_tables(reported)) {
      page.table(table);
      any = true;
    }
  if (!any)
    page.paragraph(fmt::format("No fault was injected, no slot had a problem, no deadline was missed{}.",
                               without.empty() ? "" : " in the logs"));
  if (!without.empty()) page.paragraph(fmt::format("There is no log of {}: {}", joined(without), elsewhere));
}

}  // namespace ttf::report::drive
