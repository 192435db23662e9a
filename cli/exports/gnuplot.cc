#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "cli/drive_progress.h"
#include "cli/exports/formats.h"
#include "cli/logs/log_inputs.h"
#include "cli/output.h"
#include "core/counted.h"
#include "core/csv.h"
#include "core/errors.h"
#include "evaluation/accuracy/drive_rows.h"
#include "evaluation/measures/measure.h"
#include "recording/merge/merge.h"
#include "recording/merge/stored_log.h"
#include "recording/records/tee.h"
#include "report/paper/drive.h"
#include "report/paper/experiment.h"
#include "report/plots/position_plot.h"

namespace ttf::cli::exports {
namespace {

namespace fs = std::filesystem;
using report::paper::PaperFile;
using report::paper::table_number;

double in_seconds(TrueTime at) { return static_cast<double>(at.ns) * 1e-9; }

std::string as_file_name(const std::string& text) {
  std::string name;
  for (const char c : text)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ? c : '_';
  return name.empty() ? "run" : name;
}

// Writes the tables of one drive and notes their content in `has`.
class DriveTables {
 public:
  DriveTables(const recording::merge::MergedLogs& drive, report::paper::PaperDrive& has)
      : names_(report::drawing::names_of(drive.manifest())), has_(has) {
    read_shown(drive, rows_);
    rows_.finish();
    const ObjectId object = rows_.referenced().value_or(ObjectId{0});
    has_.object = static_cast<int>(index_of(object));
    report::plots::PositionOptions options;
    options.object = object;
    report::plots::PositionPlots plots(names_, options);
    read_shown(drive, plots);
    selection_ = plots.select();
  }

  std::vector<PaperFile> files() {
    return {{has_.label + "_positions.csv", positions()},
            {has_.label + "_errors.csv", errors()},
            {has_.label + "_nees.csv", nees()},
            {has_.label + "_ages.csv", ages()}};
  }

 private:
  // Returns the sensor's name, and notes how to draw it.
  std::string shown(SensorId id) {
    std::string name = names_.sensor(id);
    const auto has_name = [&](const report::paper::PaperSensor& one) { return one.name == name; };
    if (std::none_of(has_.sensors.begin(), has_.sensors.end(), has_name))
      has_.sensors.push_back(
          {name, report::drawing::sensor_colour(names_, id), report::drawing::sensor_marker(names_, id)});
    return name;
  }

  std::string positions() {
    std::string text = report::paper::kPositionsHead;
    const auto add = [&](const std::string& kind, const std::vector<report::plots::PositionPlots::Sample>& samples) {
      if (samples.empty()) return;
      has_.kinds.push_back(kind);
      for (const auto& sample : samples)
        text += fmt::format("{},{},{},{}\n", csv_field(kind), table_number(sample.t), table_number(sample.x),
                            table_number(sample.y));
    };
    add("truth", selection_.truth);
    add("reference", selection_.reference);
    for (std::size_t s = 0; s < selection_.observations.size(); ++s)
      add(report::paper::sensor_kind(shown(static_cast<SensorId>(s))), selection_.observations[s]);
    add("image", selection_.fusion);
    return text;
  }

  std::string errors() {
    std::string text = report::paper::kErrorsHead;
    for (const evaluation::accuracy::ErrorRow& row : rows_.errors()) {
      text += fmt::format("{},{}", table_number(in_seconds(row.at)), index_of(row.object));
      for (const auto* values : {&row.error, &row.sigma})
        for (const double value : *values) text += ',' + table_number(value);
      text += ',' + table_number(row.nees) + '\n';
      if (static_cast<int>(index_of(row.object)) != has_.object) continue;
      if (!has_.errors) has_.first_error_s = in_seconds(row.at);
      has_.last_error_s = in_seconds(row.at);
      has_.errors = true;
      has_.sigmas = has_.sigmas || std::isfinite(row.sigma[0]);
    }
    return text;
  }

  std::string nees() {
    std::string text = report::paper::kNeesHead;
    for (const evaluation::accuracy::NeesRow& row : evaluation::accuracy::nees_rows(rows_.errors())) {
      text += fmt::format("{},{},{},{},{},{}\n", table_number(row.from_s), table_number(row.to_s), row.samples,
                          table_number(row.mean), table_number(row.low), table_number(row.high));
      has_.nees = true;
    }
    return text;
  }

  std::string ages() {
    std::string text = report::paper::kAgesHead;
    for (const auto& [what, histogram] : rows_.ages()) {
      const std::string of = what.first == evaluation::accuracy::AgeOf::kFused ? "fused" : "used",
                        sensor = shown(what.second);
      has_.ages.emplace_back(of, sensor);
      const double bin_ms = static_cast<double>(evaluation::accuracy::kAgeBin.ns) * 1e-6;
      has_.least_age_ms = std::min(has_.least_age_ms, bin_ms * static_cast<double>(histogram.begin()->first));
      has_.most_age_ms = std::max(has_.most_age_ms, bin_ms * static_cast<double>(histogram.rbegin()->first + 1));
      for (const auto& [bin, count] : histogram)
        text += fmt::format("{},{},{},{},{}\n", of, csv_field(sensor), static_cast<double>(bin) * bin_ms,
                            static_cast<double>(bin + 1) * bin_ms, count);
    }
    return text;
  }

  report::drawing::Names names_;
  report::paper::PaperDrive& has_;
  evaluation::accuracy::DriveRows rows_;
  report::plots::PositionPlots::Selection selection_;
};

std::vector<PaperFile> of_logs(const std::vector<std::string>& paths) {
  std::vector<PaperFile> files;
  std::vector<report::paper::PaperDrive> drives;
  std::set<std::string> labels;
  for (const recording::merge::MergedLogs& drive : logs::drives_in(paths)) {
    const recording::log::LogManifest& manifest = drive.manifest();
    report::paper::PaperDrive has;
    const std::string label = as_file_name(manifest.strategy);
    has.label = label;
    for (int n = 2; !labels.insert(has.label).second; ++n) has.label = fmt::format("{}_{}", label, n);
    has.title = manifest.scenario_name + ", " + manifest.strategy;
    for (PaperFile& file : DriveTables(drive, has).files()) files.push_back(std::move(file));
    drives.push_back(std::move(has));
  }
  std::vector<PaperFile> scripts = report::paper::scripts_of_drives(drives);
  if (scripts.empty())
    throw InputError({joined(paths), 0, "", "", "has no position, no use of an image and no fused measurement"});
  for (PaperFile& script : scripts) files.push_back(std::move(script));
  return files;
}

report::paper::MeasureWords words_of(std::string_view measure) {
  const evaluation::measures::Measure* known = evaluation::measures::find_measure(measure);
  return known == nullptr ? report::paper::MeasureWords{}
                          : report::paper::MeasureWords{std::string(known->unit), std::string(known->meaning)};
}

std::vector<PaperFile> of_experiment(const fs::path& summary) {
  std::ifstream file(summary, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw InputError({summary.string(), 0, "", "", "cannot be read"});
  const std::string folder = fs::absolute(summary).lexically_normal().parent_path().filename().string();
  return report::paper::paper_of_experiment(text, summary.string(), folder, words_of);
}

}  // namespace

std::vector<std::string> export_gnuplot(const std::vector<std::string>& inputs, const std::string& out) {
  std::vector<std::string> logs;
  std::vector<PaperFile> files;
  std::error_code none;
  for (const std::string& input : inputs) {
    if (!fs::is_directory(input, none)) {
      logs.push_back(input);
      continue;
    }
    if (const fs::path summary = fs::path(input) / "summary.csv"; fs::exists(summary, none)) {
      if (inputs.size() > 1)
        throw InputError({"command line", 0, "logs", input, "must be alone: it is an experiment's folder"});
      files = of_experiment(summary);
      continue;
    }
    if (recording::merge::logs_in(input).empty())
      throw InputError({input, 0, "", "", "holds neither logs (.mcap) nor an experiment's summary.csv"});
    logs.push_back(input);
  }
  if (!logs.empty()) files = of_logs(logs);
  create_folder(out);
  std::vector<std::string> names;
  for (const PaperFile& file : files) {
    const std::string path = out + "/" + file.name;
    for (const std::string& input : inputs) refuse_overwriting(input, path, "--out");
    write_file(path, file.text);
    names.push_back(file.name);
  }
  return names;
}

}  // namespace ttf::cli::exports
