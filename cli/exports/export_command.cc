#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive_progress.h"
#include "cli/exports/formats.h"
#include "cli/logs/log_inputs.h"
#include "cli/output.h"
#include "core/counted.h"
#include "recording/exports/captures.h"
#include "recording/exports/perfetto.h"
#include "recording/merge/merge.h"
#include "report/experiment/markdown.h"

namespace ttf::cli::exports {
namespace {

struct ExportOptions {
  std::vector<std::string> logs;
  std::string format;
  std::string out;
  bool json = false;
};

// Throws InputError if the file's name ends as those of another format.
void refuse_other_end(const ExportOptions& options);

// A drive that is exported: its logs are no output.
recording::merge::MergedLogs drive_of(const ExportOptions& options) {
  for (const std::string& log : options.logs) refuse_overwriting(log, options.out, "--out");
  refuse_other_end(options);
  for (const std::string& log : logs::log_files(options.logs)) refuse_overwriting(log, options.out, "--out");
  return logs::drive_in(options.logs);
}

template <auto kText> int export_frames(const ExportOptions& options) {
  const recording::merge::MergedLogs drive = drive_of(options);
  recording::exports::FrameCollector collector;
  read_shown(drive, collector);
  const std::vector<recording::exports::LoggedFrame> frames = collector.in_order();
  write_file(options.out, kText(collector, frames, recording::exports::LogNames(drive.manifest())));
  std::size_t flexray = 0, can = 0, symbols = 0;
  for (const recording::exports::LoggedFrame& frame : frames)
    ++(frame.symbol ? symbols : frame.flexray ? flexray : can);
  constexpr bool kCanOnly = kText == recording::exports::export_candump;
  if (options.json)
    fmt::print("{{\n  \"format\": \"{}\",\n  \"flexray_frames\": {},\n  \"symbols\": {},\n  \"can_frames\": {}\n}}\n",
               options.format, kCanOnly ? 0 : flexray, kCanOnly ? 0 : symbols, can);
  say_written(options.out, kCanOnly ? counted(can, "CAN frame")
                                    : fmt::format("{} FlexRay and {} and {}", flexray, counted(can, "CAN frame"),
                                                  counted(symbols, "symbol")));
  return 0;
}

int export_perfetto(const ExportOptions& options) {
  const recording::merge::MergedLogs drive = drive_of(options);
  OutputFile file(options.out);
  recording::exports::PerfettoExport trace(recording::exports::LogNames(drive.manifest()),
                                           [&](std::string_view bytes) { file.write(bytes); });
  read_shown(drive, trace);
  const recording::exports::TraceCounts counts = trace.finish();
  file.finish();
  if (options.json)
    fmt::print(
        "{{\n  \"format\": \"perfetto\",\n  \"slices\": {},\n  \"instants\": {},\n"
        "  \"counter_values\": {},\n  \"flows\": {}\n}}\n",
        counts.slices, counts.instants, counts.counters, counts.flows);
  say_written(options.out, fmt::format("{}, {} and {} of measurements", counted(counts.slices, "slice"),
                                       counted(counts.instants, "instant"), counted(counts.flows, "way")));
  return 0;
}

int export_for_viewers(const ExportOptions& options) {
  const recording::merge::MergedLogs drive = drive_of(options);
  const FoxgloveResult result = export_foxglove(drive, options.out);
  print_warnings(result.warnings);
  const recording::exports::viewer::SceneCounts& counts = result.counts;
  if (options.json) {
    std::string left_out;
    for (const std::string& one : result.left_out)
      left_out += fmt::format("{}\"{}\"", left_out.empty() ? "" : ", ", one);
    fmt::print(
        "{{\n  \"format\": \"foxglove\",\n  \"fields\": {},\n  \"truths\": {},\n  \"references\": {},\n"
        "  \"observations\": {},\n  \"images\": {},\n  \"uses\": {},\n  \"ages\": {},\n  \"errors\": {},\n"
        "  \"left_out\": [{}]\n}}\n",
        counts.fields, counts.truths, counts.references, counts.observations, counts.images, counts.uses, counts.ages,
        counts.errors, left_out);
  }
  say_written(
      options.out,
      fmt::format("{} of truth, {} of observations, {} and {}{}", counted(counts.truths, "instant"),
                  counted(counts.observations, "list"), counted(counts.images, "image"), counted(counts.uses, "use"),
                  result.left_out.empty() ? "" : "; the log has no " + joined(result.left_out, " or ")));
  if (counts.truths + counts.references + counts.observations + counts.images + counts.uses + counts.ages +
          counts.errors >
      0)
    return 0;
  fmt::print(stderr, "error: {}: has nothing that a scene shows\n", options.logs[0]);
  return 1;
}

// One file with the log, or a folder for files of the messages alone.
int export_for_osi(const ExportOptions& options) {
  const recording::merge::MergedLogs drive = drive_of(options);
  if (options.out.ends_with(".osi"))
    throw InputError({"command line", 0, "--out", options.out,
                      "must end in .mcap, or name a folder for two .osi files: SensorData and GroundTruth"});
  std::vector<std::string> files;
  const recording::osi::OsiCounts counts =
      options.out.ends_with(".mcap") ? export_osi(drive, options.out) : export_osi_files(drive, options.out, files);
  if (options.json)
    fmt::print("{{\n  \"format\": \"osi\",\n  \"sensor_data\": {},\n  \"ground_truths\": {},\n  \"left_out\": {}\n}}\n",
               counts.images, counts.truths, counts.left_out);
  say_written(options.out,
              fmt::format("{} of SensorData and {} of GroundTruth{}", counted(counts.images, "message"), counts.truths,
                          files.empty() ? ", beside the log" : " in " + joined(files, " and ")));
  if (counts.images + counts.truths > 0) return 0;
  fmt::print(stderr, "error: {}: has neither images nor truth\n", options.logs[0]);
  return 1;
}

template <auto kExport> int export_drive_tables(const ExportOptions& options) {
  const auto tables = kExport(drive_of(options), options.out);
  std::vector<std::string> rows;
  for (const auto& [file, count] : tables) rows.push_back(fmt::format("{} of {}", counted(count, "row"), file));
  if (options.json) {
    fmt::print("{{\n  \"format\": \"{}\",\n  \"rows\": {{", options.format);
    for (std::size_t t = 0; t < tables.size(); ++t)
      fmt::print("{}\"{}\": {}", t == 0 ? "" : ", ", tables[t].first, tables[t].second);
    fmt::print("}}\n}}\n");
  }
  say_written(options.out, joined(rows));
  if (std::any_of(tables.begin(), tables.end(), [](const auto& table) { return table.second > 0; })) return 0;
  fmt::print(stderr, "error: {}: has nothing for a table\n", options.logs[0]);
  return 1;
}

int export_for_papers(const ExportOptions& options) {
  const std::vector<std::string> files = export_gnuplot(options.logs, options.out);
  if (options.json) {
    fmt::print("{{\n  \"format\": \"gnuplot\",\n  \"files\": [");
    for (std::size_t f = 0; f < files.size(); ++f) fmt::print("{}\"{}\"", f == 0 ? "" : ", ", files[f]);
    fmt::print("]\n}}\n");
  }
  say_written(options.out, counted(files.size(), "file") + "; `gnuplot NAME.gp` there draws NAME.pdf and NAME.png");
  return 0;
}

int export_experiment_tables(const ExportOptions& options) {
  if (options.logs.size() > 1)
    throw InputError({"command line", 0, "logs", options.logs[1], "must be one experiment's folder"});
  refuse_other_end(options);
  const report::experiment::ExperimentFolder folder = report::experiment::read_experiment_folder(options.logs[0]);
  write_file(options.out, report::experiment::markdown_tables(folder));
  if (options.json)
    fmt::print("{{\n  \"format\": \"markdown\",\n  \"tables\": {},\n  \"points\": {}\n}}\n", folder.measures.size(),
               folder.points.size());
  say_written(options.out, fmt::format("{} of {}", counted(folder.measures.size(), "table"),
                                       counted(folder.points.size(), "point")));
  return 0;
}

// A format is a row.
struct Format {
  std::string_view name;
  std::string_view about;
  std::vector<std::string_view> ends;  // its files' names have one of these; a folder has none
  int (*write)(const ExportOptions&);
};

const std::vector<Format> kFormats = {
    {"pcapng", "FlexRay and CAN, for Wireshark", {".pcapng"}, export_frames<recording::exports::export_pcapng>},
    {"candump", "CAN only, for canplayer", {".log"}, export_frames<recording::exports::export_candump>},
    {"csv", "all frames and symbols", {".csv"}, export_frames<recording::exports::export_csv>},
    {"perfetto", "tasks, frames and ways, for ui.perfetto.dev", {".pftrace"}, export_perfetto},
    {"foxglove", "scene and plots, for Foxglove and Lichtblick", {".mcap"}, export_for_viewers},
    {"osi",
     "ASAM OSI: images as SensorData and truth as GroundTruth, beside the log in one .mcap file, or as two .osi "
     "files in a folder",
     {".mcap"},
     export_for_osi},
    {"tables",
     "truth, tracks, images, ages, errors, tasks and frames for Python and R, into a folder",
     {},
     export_drive_tables<export_tables>},
    {"sqlite", "the same tables in one file", {".sqlite", ".db"}, export_drive_tables<export_sqlite>},
    {"gnuplot", "tables and scripts for papers, into a folder", {}, export_for_papers},
    {"markdown", "an experiment's tables, with every point", {".md"}, export_experiment_tables}};

void refuse_other_end(const ExportOptions& options) {
  std::vector<FormatEnds> known;
  for (const Format& format : kFormats)
    if (!format.ends.empty()) known.push_back({format.name, format.ends});
  refuse_other_format(options.out, options.format, known);
}

int run_export(const ExportOptions& options) {
  const auto format =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& one) { return one.name == options.format; });
  return format->write(options);
}

}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export",
      "A run for Wireshark, canplayer, ui.perfetto.dev, Foxglove, OSI's tools, Python, a spreadsheet or a paper");
  command->footer(
      "The start of the run is 1970-01-01 in pcapng, foxglove and osi, second 1000000000 in candump, and\n"
      "0 in csv, perfetto, tables and sqlite.\n"
      "The logs of a run's processes are merged.\n"
      "Examples: ttfusion export out/drive/tt.mcap --format pcapng -o out/drive.pcapng\n"
      "          ttfusion export out/drive/tt.mcap --format foxglove -o out/scene.mcap\n"
      "          ttfusion export out/drive/tt.mcap --format osi -o out/trace.mcap\n"
      "          ttfusion export out/drive/tt.mcap --format tables -o out/tables\n"
      "          ttfusion export out/drive/tt.mcap --format sqlite -o out/tables.sqlite\n"
      "          ttfusion export out/noise --format gnuplot -o out/figures\n"
      "          ttfusion export out/noise --format markdown -o out/noise.md");
  command
      ->add_option("logs", options->logs,
                   "Log of a run, or one of each of its processes, or its folder; for gnuplot also of several runs, or "
                   "an experiment's folder; for markdown an experiment's folder")
      ->required();
  std::vector<std::string> names, abouts;
  for (const Format& format : kFormats) {
    names.emplace_back(format.name);
    abouts.push_back(fmt::format("{} ({})", format.name, format.about));
  }
  command->add_option("--format", options->format, fmt::format("{}", fmt::join(abouts, ", ")))
      ->required()
      ->check(one_of(names));
  command->add_option("-o,--out", options->out, "File to write; for tables and gnuplot the folder, for osi either")
      ->required()
      ->check(named());
  command->add_flag("--json", options->json, "Counts as JSON on standard output");
  command->callback([options, &action] { action = [options] { return run_export(*options); }; });
}

}  // namespace ttf::cli::exports
