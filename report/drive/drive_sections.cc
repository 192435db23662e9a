#include "report/drive/drive_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/counted.h"
#include "report/drive/plots.h"
#include "report/drive/scenario_words.h"
#include "report/timing/diagram.h"

namespace ttf::report::drive {
namespace {

constexpr Duration kLongestDiagram = Duration::milliseconds(2000);

}  // namespace

ToldDrive told_of(const Drive& drive) {
  DriveSeriesSink sink;
  if (drive.log) drive.log->read(sink);
  return {&drive, sink.finish()};
}

void errors_section(page::Page& page, const std::vector<ToldDrive>& drives) {
  const page::Plot plots[] = {error_plot(drives), age_histogram(drives), age_plot(drives)};
  if (std::ranges::all_of(plots, [](const page::Plot& plot) { return plot.views.empty(); })) return;
  page.section("Errors and ages");
  for (const page::Plot& plot : plots) page.plot(plot);
}

void timing_section(page::Page& page, const std::vector<ToldDrive>& drives, const DiagramWindow& window) {
  std::vector<page::PageDiagram> diagrams;
  std::vector<std::string> windows;
  std::size_t logs = 0;
  double longest_s = 0.0;
  for (const ToldDrive& told : drives) {
    if (!told.drive->log || ++logs > window.most) continue;
    const recording::log::LogManifest& manifest = told.drive->log->manifest();
    TrueTime from = window.from.value_or(scenario_in(*told.drive->log).judged_from);
    // The given end lies before the judged part: the window ends there.
    if (!window.from && window.to && *window.to <= from) from = std::max(TrueTime{}, *window.to - window.length);
    const TrueTime to = std::min(window.to.value_or(from + window.length), from + kLongestDiagram);
    timing::TimingDiagram diagram(drawing::names_of(manifest), {manifest.cycle_ns}, from, to);
    told.drive->log->read(diagram);
    diagrams.push_back({told.drive->label, diagram.svg(timing::TimingUse::kPage)});
    windows.push_back(
        fmt::format("{:g} ms are drawn, from {:g} s on", in_ms(to - from), static_cast<double>(from.ns) * 1e-9));
    longest_s = std::max(longest_s, told.series.end_s);
  }
  if (diagrams.empty()) return;
  std::string caption = fmt::format("Of {:.3f} s only {}", longest_s, windows.front());
  if (std::ranges::count(windows, windows.front()) != std::ssize(windows)) {
    caption = "A part of each drive is drawn";
    for (std::size_t d = 0; d < diagrams.size(); ++d) diagrams[d].label += ", of which " + windows[d];
  }
  caption += " (--from and --to choose others). ";
  page.section("Timing: slots, tasks and every measurement's way");
  if (logs > window.most) caption += fmt::format("The first {} of {} drives are drawn. ", window.most, logs);
  page.diagrams(diagrams, caption +
                              "Arrows follow each measurement; point at a slot, a task or an arrow to see its source, "
                              "its times and ages.");
}

void time_base_section(page::Page& page, const std::vector<ToldDrive>& drives, std::size_t most) {
  const page::Plot precision = precision_plot(drives);
  std::vector<page::Plot> corrections;
  for (const ToldDrive& told : drives)
    if (told.drive->log && !told.series.offset_corrections.empty() && corrections.size() < most)
      corrections.push_back(corrections_plot(told, drawing::names_of(told.drive->log->manifest())));
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

void troubles_section(page::Page& page, const std::vector<ToldDrive>& drives) {
  page.section("Faults and problems");
  std::vector<std::string> without;
  for (const ToldDrive& told : drives)
    if (!told.drive->log) without.push_back(told.drive->label);
  const std::string elsewhere =
      "slot problems and missed deadlines are in the table above only; faults, if any, in summary.json.";
  if (without.size() == drives.size()) {
    page.paragraph("There is no log: " + elsewhere);
    return;
  }
  bool any = false;
  for (const ToldDrive& told : drives)
    for (const page::PageTable& table : trouble_tables(told)) {
      page.table(table);
      any = true;
    }
  if (!any)
    page.paragraph(fmt::format("No fault was injected, no slot had a problem, no deadline was missed{}.",
                               without.empty() ? "" : " in the logs"));
  if (!without.empty()) page.paragraph(fmt::format("There is no log of {}: {}", joined(without), elsewhere));
}

}  // namespace ttf::report::drive
