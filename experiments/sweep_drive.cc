#include "experiments/sweep_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <optional>
#include <string>

#include "core/file_bytes.h"
#include "core/hash.h"
#include "core/random.h"
#include "core/yaml_edit.h"
#include "experiments/expected_drive.h"
#include "experiments/measures.h"
#include "experiments/sweep_measures.h"
#include "nodes/catalog.h"
#include "recording/records/tee.h"
#include "schedules/checker.h"
#include "schedules/loader.h"
#include "schedules/ports.h"
#include "sim/drive.h"

namespace ttf::experiments {
namespace {

constexpr std::string_view kOfCluster = "cluster.";
constexpr std::size_t kAllPrepared = 1000;   // drives of a grid that are prepared, every one, before it begins

using Edits = std::vector<std::pair<std::string, std::string>>;

void apply(const Edits& edits, bool of_cluster, std::string& text, const std::string& name) {
  for (const auto& [key, value] : edits) {
    const bool is = key.starts_with(kOfCluster);
    if (is != of_cluster) continue;
    text = with_value(text, name, std::string_view(key).substr(is ? kOfCluster.size() : 0), value);
  }
}

}  // namespace

SweepDrives::SweepDrives(const SweepFile& sweep) : sweep_(sweep), scenario_text_(read_file(sweep.scenario_file)) {
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
  std::string all = sweep.text + '\0' + scenario_text_;
  for (const auto& [path, text] : clusters_) all += '\0' + std::filesystem::path(path).filename().string() + '\0' + text;
  identity_ = hex_hash(all);
}

// Reads the clusters as they are asked for, and says at which point something is wrong.
void SweepDrives::prepare_at(const results::RunKey& key) {
  const Paradigm& paradigm = sweep_.paradigms[key.paradigm];
  try {
    std::string file = paradigm.cluster_file.value_or("");
    if (!paradigm.cluster_file) {
      const nodes::Scenario base = nodes::parse_scenario(scenario_text_, sweep_.scenario_file);
      file = base.cluster_files[static_cast<std::size_t>(paradigm.strategy)];
    }
    if (!clusters_.contains(file)) clusters_[file] = read_file(file);
    std::vector<double> low, high;
    for (const Axis* axis : sweep_.drawn()) {
      low.push_back(axis->low);
      high.push_back(axis->high);
    }
    (void)prepare(key, low);
    if (!high.empty()) (void)prepare(key, high);
  } catch (const InputError& error) {
    Findings findings;
    for (Finding finding : error.findings()) {
      finding.expected += fmt::format(" (with {}, {})", paradigm.name, sweep_.label_of(key.point));
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

PreparedDrive SweepDrives::prepare(const results::RunKey& key) const { return prepare(key, drawn(key.replication)); }

PreparedDrive SweepDrives::prepare(const results::RunKey& key, const std::vector<double>& values) const {
  const Paradigm& paradigm = sweep_.paradigms[key.paradigm];
  Edits edits = paradigm.edits;
  for (const Setting* setting : sweep_.settings_of(key.point))
    edits.insert(edits.end(), setting->edits.begin(), setting->edits.end());
  const std::vector<const Axis*> axes = sweep_.drawn();
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (const std::string& name : axes[a]->keys)
      edits.emplace_back(name, fmt::format("{}{}{}", values[a], axes[a]->unit.empty() ? "" : " ", axes[a]->unit));
  PreparedDrive drive;
  std::string text = scenario_text_;
  apply(edits, false, text, sweep_.scenario_file);
  drive.scenario = nodes::parse_scenario(std::move(text), sweep_.scenario_file);
  drive.strategy = paradigm.strategy;
  std::string& file = drive.scenario.cluster_files[static_cast<std::size_t>(paradigm.strategy)];
  if (paradigm.cluster_file) file = *paradigm.cluster_file;
  const auto known = clusters_.find(file);
  if (known == clusters_.end())
    throw InputError({sweep_.scenario_file, 0, "clusters", file, "must not be varied: give the paradigm a cluster"});
  std::string cluster = known->second;
  apply(edits, true, cluster, file);
  drive.cluster = schedules::parse_cluster(std::move(cluster), file);
  if (auto findings = schedules::check(drive.cluster); !findings.empty()) throw InputError(std::move(findings));
  schedules::bind_ports(drive.cluster, nodes::step_ports());
  sim::check_fits(drive.scenario, drive.cluster, drive.strategy, false);
  return drive;
}

results::Run SweepDrives::run(const results::RunKey& key) const {
  try {
    return run(key, prepare(key));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    results::Run failed{key, error.what(), drawn(key.replication)};
    failed.values.resize(columns().size(), kNotMeasured);
    return failed;
  }
}

results::Run SweepDrives::run(const results::RunKey& key, const PreparedDrive& drive, records::Sink* listener) const {
  results::Run run{key, results::kDone, drawn(key.replication)};
  try {
    DriveMeasures measures(sim::evaluation_start(drive.scenario));
    std::vector<records::Sink*> sinks{&measures};
    std::optional<ExpectedError> expected;
    if (const bool asked = std::count(sweep_.measures.begin(), sweep_.measures.end(), "position_mse_expected") > 0;
        asked && ExpectedError::is_defined(drive.scenario))
      sinks.push_back(&expected.emplace(drive.scenario));
    if (listener != nullptr) sinks.push_back(listener);
    records::Tee tee(sinks);
    const sim::DriveConfig config{&drive.scenario, &drive.cluster, drive.strategy, sweep_.seed, key.replication, nullptr};
    const sim::DriveOutcome outcome = sim::run_drive(config, tee);
    DriveSummary summary = measures.finish();
    summary.position_mse_reference_corrected = summary.position_rmse_reference * summary.position_rmse_reference -
                                               expected_square(drive.scenario.reference, summary.reference_weights);
    if (expected) summary.position_mse_expected = expected->position_mse();
    for (const std::string& name : sweep_.measures) run.values.push_back(find_measure(name)->of(summary, outcome));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    run.status = error.what();
    run.values.resize(columns().size(), kNotMeasured);
  }
  return run;
}

std::vector<std::string> SweepDrives::columns() const {
  std::vector<std::string> names;
  for (const Axis* axis : sweep_.drawn()) names.push_back(axis->name);
  names.insert(names.end(), sweep_.measures.begin(), sweep_.measures.end());
  return names;
}

}  // namespace ttf::experiments
