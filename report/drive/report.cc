#include "report/drive/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>

#include "core/counted.h"
#include "core/decimal.h"
#include "recording/exports/lateness_sums.h"
#include "recording/records/tee.h"
#include "report/drive/scenario_words.h"
#include "report/drive/stages.h"
#include "report/drive/tables.h"
#include "report/page/page.h"
#include "report/plots/lateness_picture.h"
#include "report/plots/position_plot.h"
#include "report/startup/diagram.h"

namespace ttf::report::drive {
namespace {

constexpr std::size_t kMostPictures = 6;  // drives

// Labels the drives by distinct words: strategies, or folders with strategies.
void label_drives(std::vector<ResultsFolder>& folders) {
  std::map<std::string, int> known;
  for (ResultsFolder& folder : folders) {
    std::filesystem::path path = std::filesystem::path(folder.path).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    for (Drive& drive : folder.drives) {
      drive.label = folders.size() == 1 ? drive.strategy : path.filename().string() + " " + drive.strategy;
      if (const int before = known[drive.label]++; before > 0) drive.label += fmt::format(" ({})", before + 1);
    }
  }
}

void asked(page::Page& page, const std::vector<ResultsFolder>& folders, const std::vector<ReportedDrive>& drives) {
  page.section("Question");
  std::set<std::string> described;
  for (const ReportedDrive& reported : drives)
    if (reported.drive->log)
      if (const ScenarioWords words = scenario_in(*reported.drive->log);
          !words.description.empty() && described.insert(words.description).second)
        page.paragraph(words.description);
  for (const ResultsFolder& folder : folders) {
    const Drive& first = folder.drives.front();
    std::vector<std::string> strategies;
    for (const Drive& drive : folder.drives) strategies.push_back(drive.strategy);
    std::vector<std::pair<std::string, std::string>> facts{{"folder", folder.path},
                                                           {"scenario", first.scenario},
                                                           {"seed", std::to_string(first.seed)},
                                                           {"strategies", joined(strategies)}};
    if (const auto duration = folder.summary.find("duration_s");
        duration != folder.summary.end() && duration->is_number())
      facts.emplace_back("duration", fmt::format("{:g} s", duration->get<double>()));
    page.facts(facts);
  }
}

void answered(page::Page& page, const std::vector<ResultsFolder>& folders, const std::vector<ReportedDrive>& drives) {
  const DrivesAnswer answer = answer_of(drives);
  page.section("Answer");
  page.lead(answer.answer);
  page.points(answer.more);
  for (const page::PageTable& table : repeated_tables(drives)) page.table(table);
  page::PageTable table = measure_table(drives);
  table.caption = "Errors are root mean squares at the instants an image is used";
  if (!table.rows.empty()) page.table(table);
  for (const ResultsFolder& folder : folders)
    for (const std::string& remark : folder.remarks) page.paragraph(folder.path + ": " + remark);
}

void pictures(page::Page& page, const std::vector<ReportedDrive>& drives) {
  std::size_t shown = 0;
  bool any = false;
  const auto add = [&](std::string_view svg, const std::string& caption) {
    if (!any) page.section("Positions");
    any = true;
    page.picture(svg, caption);
  };
  for (const ReportedDrive& reported : drives) {
    if (!reported.drive->log || shown >= kMostPictures) continue;
    ++shown;
    const recording::log::LogManifest& manifest = reported.drive->log->manifest();
    const drawing::Names names = drawing::names_of(manifest);
    plots::PositionOptions options;
    options.title = fmt::format("{}, {}", reported.drive->scenario, reported.drive->label);
    options.from = scenario_in(*reported.drive->log).judged_from;
    plots::PositionPlots plots(names, options);
    startup::StartupExtent extent;
    recording::exports::LatenessSums lateness;
    recording::records::Tee tee({&plots, &extent, &lateness});
    reported.drive->log->read(tee);
    if (!plots.select().empty())
      add(plots.plane_svg(),
          reported.drive->label + (plots.several() ? ": y over x of all objects, by truth and image"
                                                   : ": y over x by truth, sensors, DGPS and the image"));
    if (const auto window = extent.window({manifest.cycle_ns})) {
      startup::StartupDiagram startup(names, {manifest.cycle_ns}, window->first, window->second);
      reported.drive->log->read(startup);
      add(startup.svg(), reported.drive->label + ": start-up, every node's states and transmissions");
    }
    if (const auto nodes = lateness.nodes(); !nodes.empty())
      add(plots::lateness_svg(nodes, names), reported.drive->label + ": lateness of wake-ups, in real time");
  }
}

void made(page::Page& page, const std::vector<ReportedDrive>& drives) {
  if (std::ranges::none_of(drives, [](const ReportedDrive& reported) { return reported.drive->log != nullptr; }))
    return;
  page.section("How to repeat it");
  page::PageTable table{"Facts from each log",
                        {"", "version", "seed", "strategy", "cluster", "content hash", "hashes of its inputs"},
                        {}};
  std::set<std::string> commands, texts;
  std::vector<std::string> order;
  for (const ReportedDrive& reported : drives) {
    if (!reported.drive->log) continue;
    const recording::log::LogManifest& manifest = reported.drive->log->manifest();
    std::string hashes;
    for (const auto& [what, hash] : manifest.hashes)
      hashes += fmt::format("{}{} {}", hashes.empty() ? "" : ", ", what, hash);
    table.rows.push_back({reported.drive->label, manifest.version, std::to_string(manifest.seed), manifest.strategy,
                          manifest.cluster_name,
                          recording::log::ContentHash::text(reported.drive->log->content_hash().value()), hashes});
    const ScenarioWords words = scenario_in(*reported.drive->log);
    std::string command = fmt::format(
        "ttfusion {} {} --strategy {} --seed {}", manifest.clock.empty() ? "run" : "launch",
        page::shell_word("scenarios/" + (words.file.empty() ? manifest.scenario_name + ".yaml" : words.file)),
        page::shell_word(manifest.strategy), manifest.seed);
    constexpr std::int64_t kNsPerSecond = 1'000'000'000, kPpm = 1'000'000;
    if (reported.drive->duration && *reported.drive->duration != words.duration)
      command += " --duration " + scaled_text(reported.drive->duration->ns, kNsPerSecond);
    if (manifest.time_scale_ppm != kPpm) command += " --time-scale " + scaled_text(manifest.time_scale_ppm, kPpm);
    if (!manifest.recording_name.empty()) command += " --input " + page::shell_word(manifest.recording_name);
    if (!manifest.truth_name.empty()) command += " --truth " + page::shell_word(manifest.truth_name);
    if (has_libraries(*reported.drive)) command += " --steps FOLDER";
    if (commands.insert(command).second) order.push_back(command);
  }
  if (!table.rows.empty()) page.table(table);
  if (!order.empty()) {
    page.paragraph(
        "In virtual time the same version, inputs and seed give the same content hash. If the scenario is in "
        "another folder than scenarios/, name it:");
    std::string all;
    for (const std::string& command : order) all += command + '\n';
    page.command(all);
  }
  for (const ReportedDrive& reported : drives)
    if (reported.drive->log)
      for (const recording::log::Attachment& attachment : reported.drive->log->attachments())
        if (texts.insert(attachment.name + '\n' + attachment.bytes).second)
          page.preformatted(attachment.name, attachment.bytes);
}

}  // namespace

std::string drive_report_html(std::vector<ResultsFolder> folders, const DiagramWindow& window) {
  label_drives(folders);
  std::vector<const Drive*> all;
  std::set<std::string> scenarios;
  for (const ResultsFolder& folder : folders)
    for (const Drive& drive : folder.drives) {
      all.push_back(&drive);
      scenarios.insert(drive.scenario);
    }
  const std::vector<ReportedDrive> drives = reported_drives(all);
  page::Page page(joined({scenarios.begin(), scenarios.end()}),
                  folders.size() == 1 ? "Report of a run" : fmt::format("Report of {} runs", folders.size()));
  asked(page, folders, drives);
  answered(page, folders, drives);
  scene_section(page, drives);
  errors_section(page, drives);
  stages_section(page, drives);
  timing_section(page, drives, window);
  time_base_section(page, drives, window.most);
  troubles_section(page, drives);
  pictures(page, drives);
  made(page, drives);
  return page.html();
}

}  // namespace ttf::report::drive
