#include "report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "core/counted.h"
#include "core/errors.h"
#include "core/strict_yaml.h"
#include "recording/lateness_sums.h"
#include "recording/records/tee.h"
#include "report/lateness_picture.h"
#include "report/page.h"
#include "report/position_plot.h"
#include "report/run_plots.h"
#include "report/run_tables.h"
#include "report/startup_diagram.h"
#include "report/timing_diagram.h"

namespace ttf::report {
namespace {

constexpr Duration kDiagram = Duration::milliseconds(160), kLongestDiagram = Duration::milliseconds(2000);
constexpr std::size_t kMostDiagrams = 6;   // half a megabyte each

// What the scenario in the log says of itself.
struct ScenarioWords {
  std::string description, file, text;
  TrueTime judged_from{};
};

ScenarioWords scenario_in(const recording::MergedLogs& log) {
  ScenarioWords words;
  for (const recording::Attachment& attachment : log.attachments()) {
    if (attachment.media_type != "application/yaml") continue;
    try {
      Findings findings;
      YamlMap root = StrictYaml::parse(attachment.bytes, attachment.name).root(findings);
      if (!root.has("world") && !root.has("evaluate_from")) continue;
      words.description = root.text_or("description", "");
      const Duration from =
          root.duration_or("evaluate_from", Duration{}, {Duration{}, Duration::milliseconds(100'000'000)});
      words.judged_from = TrueTime{from.ns};
      words.file = attachment.name;
      words.text = attachment.bytes;
      return words;
    } catch (const InputError&) {
      // A damaged attachment says nothing.
    }
  }
  return words;
}

// Its labels are words that tell the drives apart: strategies, or folders with them.
void label_drives(std::vector<RunFolder>& folders) {
  std::map<std::string, int> known;
  for (RunFolder& folder : folders) {
    std::filesystem::path path = std::filesystem::path(folder.path).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    for (Drive& drive : folder.drives) {
      drive.label = folders.size() == 1 ? drive.strategy : path.filename().string() + " " + drive.strategy;
      if (const int before = known[drive.label]++; before > 0) drive.label += fmt::format(" ({})", before + 1);
    }
  }
}

void asked(Page& page, const std::vector<RunFolder>& folders, const std::vector<ToldDrive>& drives) {
  page.section("What was asked");
  std::set<std::string> described;
  for (const ToldDrive& told : drives)
    if (told.drive->log)
      if (const ScenarioWords words = scenario_in(*told.drive->log);
          !words.description.empty() && described.insert(words.description).second)
        page.paragraph(words.description);
  for (const RunFolder& folder : folders) {
    const Drive& first = folder.drives.front();
    std::vector<std::string> strategies;
    for (const Drive& drive : folder.drives) strategies.push_back(drive.strategy);
    std::vector<std::pair<std::string, std::string>> facts{{"folder", folder.path}, {"scenario", first.scenario},
                                                           {"seed", std::to_string(first.seed)},
                                                           {"strategies", joined(strategies)}};
    if (const auto duration = folder.summary.find("duration_s");
        duration != folder.summary.end() && duration->is_number())
      facts.emplace_back("duration", fmt::format("{:g} s", duration->get<double>()));
    page.facts(facts);
  }
}

void answered(Page& page, const std::vector<RunFolder>& folders, const std::vector<ToldDrive>& drives) {
  const RunAnswer answer = run_answer(drives);
  page.section("What came out");
  page.lead(answer.answer);
  page.points(answer.more);
  for (const PageTable& table : repeated_tables(drives)) page.table(table);
  PageTable table = measure_table(drives);
  table.caption = "Errors are root mean squares at the instants an image is used";
  if (!table.rows.empty()) page.table(table);
  for (const RunFolder& folder : folders)
    for (const std::string& remark : folder.remarks) page.paragraph(folder.path + ": " + remark);
}

void timing(Page& page, const std::vector<ToldDrive>& drives, const RunReportOptions& options) {
  std::vector<PageDiagram> diagrams;
  std::vector<std::string> windows;
  std::size_t logs = 0;
  double longest_s = 0.0;
  for (const ToldDrive& told : drives) {
    if (!told.drive->log || ++logs > kMostDiagrams) continue;
    const recording::LogManifest& manifest = told.drive->log->manifest();
    TrueTime from = options.from.value_or(scenario_in(*told.drive->log).judged_from);
    // An end alone may lie before that: then it is the end that counts.
    if (!options.from && options.to && *options.to <= from) from = std::max(TrueTime{}, *options.to - kDiagram);
    const TrueTime to = std::min(options.to.value_or(from + kDiagram), from + kLongestDiagram);
    TimingDiagram diagram(names_of(manifest), {manifest.cycle_ns}, from, to);
    told.drive->log->read(diagram);
    diagrams.push_back({told.drive->label, diagram.svg(TimingUse::kPage)});
    windows.push_back(
        fmt::format("{:g} ms are drawn, from {:g} s on", in_ms(to - from), static_cast<double>(from.ns) * 1e-9));
    longest_s = std::max(longest_s, told.series.end_s);
  }
  if (diagrams.empty()) return;
  std::string window = fmt::format("Of {:.3f} s only {}", longest_s, windows.front());
  if (std::ranges::count(windows, windows.front()) != std::ssize(windows)) {
    window = "Of each drive a part is drawn";
    for (std::size_t d = 0; d < diagrams.size(); ++d) diagrams[d].label += ", of which " + windows[d];
  }
  window += " (--from and --to choose others). ";
  page.section("Timing: slots, tasks and every measurement's way");
  if (logs > kMostDiagrams) window += fmt::format("Of {} drives the first {} are drawn. ", logs, kMostDiagrams);
  page.diagrams(diagrams, window +
                              "Arrows follow each measurement; point at a slot, a task or an arrow to see whose it is, "
                              "its times and ages.");
}

void time_base(Page& page, const std::vector<ToldDrive>& drives) {
  const Plot precision = precision_plot(drives);
  std::vector<Plot> corrections;
  for (const ToldDrive& told : drives)
    if (told.drive->log && !told.series.offset_corrections.empty() && corrections.size() < kMostDiagrams)
      corrections.push_back(corrections_plot(told, names_of(told.drive->log->manifest())));
  if (precision.views.empty() && corrections.empty()) return;
  page.section("The time base");
  if (precision.views.empty())
    page.paragraph("Processes of their own: nobody sees all clocks, and the log has no precision over time.");
  page.plot(precision);
  if (corrections.empty()) return;
  page.open_details("Clock corrections, node by node");
  for (const Plot& plot : corrections) page.plot(plot);
  page.close_details();
}

void troubles(Page& page, const std::vector<ToldDrive>& drives) {
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
    for (const PageTable& table : trouble_tables(told)) {
      page.table(table);
      any = true;
    }
  if (!any)
    page.paragraph(fmt::format("No fault was injected, no slot had a problem, no deadline was missed{}.",
                               without.empty() ? "" : " in what was logged"));
  if (!without.empty())
    page.paragraph(fmt::format("Of {} there is no log: {}", joined(without), elsewhere));
}

void errors(Page& page, const std::vector<ToldDrive>& drives) {
  const Plot plots[] = {error_plot(drives), age_histogram(drives), age_plot(drives)};
  if (std::ranges::all_of(plots, [](const Plot& plot) { return plot.views.empty(); })) return;
  page.section("Errors and ages");
  for (const Plot& plot : plots) page.plot(plot);
}

void pictures(Page& page, const std::vector<ToldDrive>& drives) {
  std::size_t shown = 0;
  bool any = false;
  const auto add = [&](std::string_view svg, const std::string& caption) {
    if (!any) page.section("Where the car was");
    any = true;
    page.picture(svg, caption);
  };
  for (const ToldDrive& told : drives) {
    if (!told.drive->log || shown >= kMostDiagrams) continue;
    ++shown;
    const recording::LogManifest& manifest = told.drive->log->manifest();
    const Names names = names_of(manifest);
    PositionOptions options;
    options.title = fmt::format("{}, {}", told.drive->scenario, told.drive->label);
    options.from = scenario_in(*told.drive->log).judged_from;
    PositionPlots plots(names, options);
    StartupExtent extent;
    recording::LatenessSums lateness;
    records::Tee tee({&plots, &extent, &lateness});
    told.drive->log->read(tee);
    if (!plots.select().empty())
      add(plots.plane_svg(), told.drive->label + ": y over x, as truth, sensors, DGPS and the image have it");
    if (const auto window = extent.window({manifest.cycle_ns})) {
      StartupDiagram startup(names, {manifest.cycle_ns}, window->first, window->second);
      told.drive->log->read(startup);
      add(startup.svg(), told.drive->label + ": start-up, every node's states and what it sent");
    }
    if (const auto nodes = lateness.nodes(); !nodes.empty())
      add(lateness_svg(nodes, names), told.drive->label + ": how late processes were woken up, in real time");
  }
}

void made(Page& page, const std::vector<ToldDrive>& drives) {
  if (std::ranges::none_of(drives, [](const ToldDrive& told) { return told.drive->log != nullptr; })) return;
  page.section("How it was made");
  PageTable table{"What each log says of itself",
                  {"", "version", "seed", "strategy", "cluster", "content hash", "hashes of its inputs"},
                  {}};
  std::set<std::string> commands, texts;
  std::vector<std::string> order;
  for (const ToldDrive& told : drives) {
    if (!told.drive->log) continue;
    const recording::LogManifest& manifest = told.drive->log->manifest();
    std::string hashes;
    for (const auto& [what, hash] : manifest.hashes)
      hashes += fmt::format("{}{} {}", hashes.empty() ? "" : ", ", what, hash);
    table.rows.push_back({told.drive->label, manifest.version, std::to_string(manifest.seed), manifest.strategy,
                          manifest.cluster_name, recording::ContentHash::text(told.drive->log->content_hash().value()),
                          hashes});
    const ScenarioWords words = scenario_in(*told.drive->log);
    std::string command =
        fmt::format("ttfusion {} {} --strategy {} --seed {}", manifest.clock.empty() ? "run" : "launch",
                    shell_word("scenarios/" + (words.file.empty() ? manifest.scenario_name + ".yaml" : words.file)),
                    shell_word(manifest.strategy), manifest.seed);
    if (!manifest.recording_name.empty()) command += " --input " + shell_word(manifest.recording_name);
    if (commands.insert(command).second) order.push_back(command);
  }
  if (!table.rows.empty()) page.table(table);
  if (!order.empty()) {
    page.paragraph(
        "In virtual time the same version, inputs and seed give the same content hash. Where the scenario is in "
        "another folder than scenarios/, say so:");
    std::string all;
    for (const std::string& command : order) all += command + '\n';
    page.command(all);
  }
  for (const ToldDrive& told : drives)
    if (told.drive->log)
      for (const recording::Attachment& attachment : told.drive->log->attachments())
        if (texts.insert(attachment.name + '\n' + attachment.bytes).second)
          page.preformatted(attachment.name, attachment.bytes);
}

}  // namespace

std::string run_report_html(std::vector<RunFolder> folders, const RunReportOptions& options) {
  label_drives(folders);
  std::vector<ToldDrive> drives;
  std::set<std::string> scenarios;
  for (const RunFolder& folder : folders)
    for (const Drive& drive : folder.drives) {
      RunSeriesSink sink;
      if (drive.log) drive.log->read(sink);
      drives.push_back({&drive, sink.finish()});
      scenarios.insert(drive.scenario);
    }
  Page page(joined({scenarios.begin(), scenarios.end()}),
            folders.size() == 1 ? "Report of a run" : fmt::format("Report of {} runs", folders.size()));
  asked(page, folders, drives);
  answered(page, folders, drives);
  errors(page, drives);
  timing(page, drives, options);
  time_base(page, drives);
  troubles(page, drives);
  pictures(page, drives);
  made(page, drives);
  return page.html();
}

}  // namespace ttf::report
