#include "experiments/sweep/drives.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "core/file_bytes.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/strict_yaml.h"
#include "core/yaml_edit.h"
#include "evaluation/accuracy/drive_measures.h"
#include "evaluation/measures/figures.h"
#include "experiments/sweep/driving.h"
#include "experiments/sweep/expected_drive.h"
#include "faults/plan.h"
#include "recording/records/tee.h"
#include "schedules/check/checker.h"
#include "schedules/file/inherit.h"
#include "schedules/file/vary.h"
#include "schedules/model/ports.h"
#include "sim/drives/drive.h"
#include "sim/drives/step_catalog.h"

namespace ttf::experiments::sweep {
namespace {

using evaluation::measures::find_measure;

constexpr std::string_view kOfCluster = "cluster.";
constexpr std::size_t kAllPrepared = 1000;  // the largest grid of which every drive is prepared before the first one

// Returns the last value of the key, or null.
const std::string* file_of(const std::vector<Edit>& edits, std::string_view key) {
  const auto last = std::find_if(edits.rbegin(), edits.rend(), [&](const Edit& edit) { return edit.key == key; });
  return last == edits.rend() ? nullptr : &last->value;
}

std::vector<std::string> stored_measures(const SweepFile& sweep) {
  std::vector<std::string> names = sweep.measures;
  if (std::ranges::find(names, kTrackLost) == names.end()) names.emplace_back(kTrackLost);
  return names;
}

// Names the file that a key's value is.
std::string_view kind_words(std::string_view key) {
  return key == kScenarioFile ? "a scenario file" : key == kClusterFile ? "a cluster file" : "a file of faults";
}

// The recursion of expected errors has no range rates.
bool measures_positions_alone(const PreparedDrive& drive) {
  const auto& sensors = drive.cluster.sensors;
  return std::none_of(sensors.begin(), sensors.end(), [&](const schedules::model::Sensor& sensor) {
    return schedules::model::row_of(sensor.kind).rates && drive.scenario.sensors.enabled(sensor);
  });
}

}  // namespace

SweepDrives::SweepDrives(const SweepFile& sweep, const nodes::foreign::StepFolder* steps)
    : sweep_(sweep), steps_(steps) {
  read_files();
  const std::size_t points = sweep.points();
  const auto each_paradigm = [&](std::uint32_t point) {
    for (std::uint32_t p = 0; p < sweep.paradigms.size(); ++p) prepare_at({point, 0, p});
  };
  if (points * sweep.paradigms.size() <= kAllPrepared) {
    for (std::uint32_t point = 0; point < points; ++point) each_paradigm(point);
  } else {
    each_paradigm(0);
    std::size_t step = points;
    for (const Axis* axis : sweep.grid()) {
      step /= axis->settings.size();
      for (std::size_t s = 1; s < axis->settings.size(); ++s) each_paradigm(static_cast<std::uint32_t>(s * step));
    }
  }
  // The identity does not depend on the folder of the files.
  std::vector<std::string> others;
  for (const auto& [path, text] : texts_)
    if (path != sweep.scenario_file) others.push_back(std::filesystem::path(path).filename().string() + '\0' + text);
  std::sort(others.begin(), others.end());
  std::string all = sweep.text + '\0' + texts_.at(sweep.scenario_file);
  for (const std::string& other : others) all += '\0' + other;
  for (const auto& [name, hash] : libraries_) all += '\0' + name + '\0' + hash;
  identity_ = hex_hash(all);
}

// Reads all files that a drive may need, including the scenarios' clusters.
void SweepDrives::read_files() {
  std::vector<std::string> scenarios{sweep_.scenario_file};
  const auto read = [&](const std::string& file, const Finding& entry, std::string_view key) {
    if (texts_.contains(file)) return;
    texts_[file] = read_named_file(file, entry, kind_words(key));
    if (key != kClusterFile) return;
    schedules::file::ClusterText whole = schedules::file::inherited(file);
    texts_[file] = std::move(whole.text);
    origins_[file] = std::move(whole.origins);
  };
  const auto read_named = [&](const Edit& edit) {
    if (!is_file(edit)) return;
    read(edit.value, {sweep_.file, edit.line, edit.key, "", ""}, edit.key);
    if (edit.key == kScenarioFile) scenarios.push_back(edit.value);
  };
  read(sweep_.scenario_file, {sweep_.file, sweep_.scenario_line, "scenario", "", ""}, kScenarioFile);
  for (const Axis& axis : sweep_.axes)
    for (const Setting& setting : axis.settings)
      for (const Edit& edit : setting.edits) read_named(edit);
  for (const Paradigm& paradigm : sweep_.paradigms)
    for (const Edit& edit : paradigm.edits) read_named(edit);
  for (const Paradigm& paradigm : sweep_.paradigms) {
    if (paradigm.cluster_file)
      read(*paradigm.cluster_file,
           {sweep_.file, paradigm.cluster_line, fmt::format("paradigms.{}.cluster", paradigm.name), "", ""},
           kClusterFile);
    for (std::size_t s = 0; s < scenarios.size() && !paradigm.cluster_file; ++s) {
      const sim::drives::Scenario scenario = sim::drives::parse_scenario(texts_.at(scenarios[s]), scenarios[s]);
      const Finding entry = sim::drives::cluster_entry(scenario, paradigm.strategy);
      read(entry.value, entry, kClusterFile);
    }
  }
}

// Adds the point to the sentences of errors.
void SweepDrives::prepare_at(const results::RowKey& key) {
  try {
    std::vector<double> low, high;
    for (const Axis* axis : sweep_.drawn()) {
      low.push_back(axis->low);
      high.push_back(axis->high);
    }
    for (auto& library : nodes::foreign::library_hashes(prepare(key, low).cluster, steps_))
      libraries_.insert(std::move(library));
    if (!high.empty()) (void)prepare(key, high);
  } catch (const InputError& error) {
    Findings findings;
    for (Finding finding : error.findings()) {
      finding.expected +=
          fmt::format(" (with {}, {})", sweep_.paradigms[key.paradigm].name, sweep_.label_of(key.point));
      findings.add(std::move(finding));
    }
    findings.throw_if_any();
  }
}

std::vector<double> SweepDrives::drawn(std::uint32_t replication) const {
  std::vector<double> values;
  for (const Axis* axis : sweep_.drawn()) {
    RandomStream stream({sweep_.seed, replication, Purpose::kSweep, static_cast<std::uint16_t>(values.size()), 0});
    values.push_back(std::stod(fmt::format("{:.6g}", stream.uniform(axis->low, axis->high))));
  }
  return values;
}

PreparedDrive SweepDrives::prepare(const results::RowKey& key) const { return prepare(key, drawn(key.replication)); }

// In this order: the paradigm's own, the point's, and drawn values.
std::vector<Edit> SweepDrives::edits_of(const results::RowKey& key, const std::vector<double>& drawn) const {
  const Paradigm& paradigm = sweep_.paradigms[key.paradigm];
  std::vector<Edit> edits = paradigm.edits;
  const auto add = [&](const Edit& edit, const std::string& value) {
    if (edit.paradigm.empty() || edit.paradigm == paradigm.name)
      edits.push_back({edit.key, value, edit.paradigm, edit.line});
  };
  for (const Setting* setting : sweep_.settings_of(key.point))
    for (const Edit& edit : setting->edits) add(edit, edit.value);
  const std::vector<const Axis*> axes = sweep_.drawn();
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (const Edit& edit : axes[a]->keys)
      add(edit, fmt::format("{}{}{}", drawn[a], axes[a]->unit.empty() ? "" : " ", axes[a]->unit));
  return edits;
}

// Returns none for a file whose text is its own.
TextOrigins SweepDrives::origins_of(const std::string& file) const {
  const auto found = origins_.find(file);
  return found == origins_.end() ? TextOrigins{} : found->second;
}

schedules::file::ClusterText SweepDrives::edited(const std::vector<Edit>& edits, bool of_cluster,
                                                 const std::string& name) const {
  schedules::file::ClusterText text{texts_.at(name), name, origins_of(name)};
  for (const Edit& edit : edits) {
    const bool is = edit.key.starts_with(kOfCluster);
    if (is != of_cluster || is_file(edit)) continue;
    const std::string key = edit.key.substr(is ? kOfCluster.size() : 0);
    try {
      text.text = with_value(text.text, name, key, edit.value);
    } catch (const InputError& error) {
      Finding finding = error.findings().front();
      if (finding.line != 0) {
        finding.file = name;
        throw InputError(text.origins.moved(std::move(finding)));
      }
      // The file as it is: other edits may have left half an instant so far.
      if (is && schedules::file::leaves_out({texts_.at(name), name, origins_of(name)}, key)) {
        text = schedules::file::with_key(std::move(text), key, edit.value);
        continue;
      }
      // The file lacks the key: the finding names the line that sets it.
      throw InputError({sweep_.file, edit.line, edit.key, "",
                        fmt::format("must be in the file {}: only its written keys can be varied", name)});
    }
  }
  return text;
}

// Takes the faults as if the scenario had them.
void SweepDrives::plan_faults(const std::string& file, sim::drives::Scenario& scenario) const {
  if (!scenario.faults.empty())
    throw InputError({scenario.file, 0, "faults", "", "must be absent, since " + file + " has the faults"});
  const std::string& text = texts_.at(file);
  scenario.faults = faults::read_fault_plan(StrictYaml::parse(text, file), scenario.duration);
  scenario.text += "\n" + text;
}

PreparedDrive SweepDrives::prepare(const results::RowKey& key, const std::vector<double>& values) const {
  const Paradigm& paradigm = sweep_.paradigms[key.paradigm];
  const std::vector<Edit> edits = edits_of(key, values);
  const std::string* scenario = file_of(edits, kScenarioFile);
  const std::string& scenario_file = scenario != nullptr ? *scenario : sweep_.scenario_file;
  PreparedDrive drive;
  drive.scenario = sim::drives::parse_scenario(edited(edits, false, scenario_file).text, scenario_file);
  if (const std::string* faults = file_of(edits, kFaultsFile)) plan_faults(*faults, drive.scenario);
  drive.strategy = paradigm.strategy;
  std::string& file = drive.scenario.cluster_files[static_cast<std::size_t>(paradigm.strategy)];
  if (paradigm.cluster_file) file = *paradigm.cluster_file;
  if (const std::string* cluster = file_of(edits, kClusterFile)) file = *cluster;
  drive.cluster = schedules::file::parse_cluster(edited(edits, true, file));
  if (auto findings = schedules::check::check(drive.cluster); !findings.empty()) throw InputError(std::move(findings));
  sim::drives::check_steps(drive.cluster);
  sim::drives::check_fits(drive.scenario, drive.cluster, drive.strategy, false);
  nodes::foreign::check_steps(drive.cluster, steps_);
  return drive;
}

results::Row SweepDrives::run(const results::RowKey& key) const {
  try {
    return run(key, prepare(key));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    results::Row failed{key, error.what(), drawn(key.replication)};
    failed.values.resize(columns().size(), evaluation::accuracy::kNotMeasured);
    return failed;
  }
}

results::Row SweepDrives::run(const results::RowKey& key, const PreparedDrive& drive,
                              recording::records::Sink* listener) const {
  results::Row row{key, results::kDone, drawn(key.replication)};
  try {
    const auto asked_for = [this](std::string_view measure) {
      return std::find(sweep_.measures.begin(), sweep_.measures.end(), measure) != sweep_.measures.end();
    };
    evaluation::accuracy::DriveMeasures measures(sim::drives::evaluation_start(drive.scenario),
                                                 evaluation::accuracy::kGate_m, std::nullopt, drive.scenario.cut_off);
    std::vector<recording::records::Sink*> sinks{&measures};
    std::optional<ExpectedError> expected;
    if ((asked_for("face_mse_expected") || asked_for("position_mse_expected")) &&
        ExpectedError::is_defined(drive.scenario) && measures_positions_alone(drive))
      sinks.push_back(&expected.emplace(drive.scenario, drive.cluster));
    std::optional<evaluation::driving::DrivingAccount> driving;
    if (is_driven(drive.scenario)) {
      sinks.push_back(&driving.emplace(driving_config(drive.scenario, drive.cluster),
                                       sim::drives::evaluation_start(drive.scenario)));
      measures.end_with([&driving] { return driving->collided_at(); });
    }
    if (listener != nullptr) sinks.push_back(listener);
    recording::records::Tee tee(sinks);
    sim::drives::DriveConfig config{
        &drive.scenario, &drive.cluster, drive.strategy, sweep_.seed,
        key.replication, nullptr,        nullptr,        listener != nullptr || asked_for("precision")};
    config.steps = steps_;
    const sim::drives::DriveOutcome outcome = sim::drives::run_drive(config, tee);
    evaluation::accuracy::DriveSummary summary = measures.finish();
    summary.position_mse_reference_corrected = summary.position_rmse_reference * summary.position_rmse_reference -
                                               expected_square(drive.scenario.reference, summary.reference_weights);
    if (expected) {
      summary.face_mse_expected = expected->face_mse();
      summary.position_mse_expected = expected->position_mse();
    }
    std::optional<evaluation::driving::DrivingFindings> driven;
    if (driving) driven = driving->finish();
    const evaluation::measures::DriveFigures figures{summary, outcome, driven ? &*driven : nullptr};
    for (const std::string& name : stored_measures(sweep_))
      row.values.push_back(value_of(*find_measure(name), figures));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    row.status = error.what();
    row.values.resize(columns().size(), evaluation::accuracy::kNotMeasured);
  }
  return row;
}

std::vector<std::string> SweepDrives::columns() const {
  std::vector<std::string> names;
  for (const Axis* axis : sweep_.drawn()) names.push_back(axis->name);
  for (std::string& name : stored_measures(sweep_)) names.push_back(std::move(name));
  return names;
}

}  // namespace ttf::experiments::sweep
