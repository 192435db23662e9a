#include "cli/experiment/drives.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/drive/drive_setup.h"
#include "core/counted.h"
#include "core/errors.h"
#include "experiments/sweep/file.h"

namespace ttf::cli::experiment {
namespace {

namespace fs = std::filesystem;
using experiments::sweep::SweepDrives;
using experiments::sweep::SweepFile;

// The reason for an empty section, in words for the page.
class NoDrives : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A temporary folder, removed with its content.
class ScratchFolder {
 public:
  ScratchFolder() : path_((fs::temp_directory_path() / "ttfusion_XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr)
      throw std::runtime_error(
          fmt::format("{}: cannot be created: {}", path_, std::error_code(errno, std::generic_category()).message()));
  }
  ~ScratchFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Returns the drives of one replication by paradigm; empty if no replication has them all.
std::vector<experiments::results::Row> first_done_by_all(const experiments::results::Store& store, std::uint32_t point,
                                                         std::size_t paradigms) {
  std::vector<experiments::results::Row> rows;
  for (experiments::results::Row& row : store.of_point(point)) {
    if (!rows.empty() && rows.front().key.replication != row.key.replication) rows.clear();
    if (row.status != experiments::results::kDone || row.key.paradigm != rows.size()) continue;
    rows.push_back(std::move(row));
    if (rows.size() == paradigms) return rows;
  }
  return {};
}

bool same(const experiments::results::Row& a, const experiments::results::Row& b) {
  return a.status == b.status &&
         std::equal(a.values.begin(), a.values.end(), b.values.begin(), b.values.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

// Throws NoDrives if the folder belongs to another experiment.
void check_same_experiment(const SweepDrives& drives, const report::experiment::ExperimentFolder& folder) {
  const SweepFile& sweep = drives.sweep();
  const experiments::results::StoreHead& head = folder.store->head();
  if (head.version != TTF_VERSION)
    throw NoDrives(fmt::format("the runs are of version {} of the program, and this is {}", head.version, TTF_VERSION));
  std::vector<std::string> names;
  for (const experiments::sweep::Paradigm& paradigm : sweep.paradigms) names.push_back(paradigm.name);
  const std::size_t points = sweep.points();
  const bool all_there = std::ranges::all_of(
      folder.points, [&](const report::experiment::ExperimentPoint& point) { return point.point < points; });
  if (!all_there || head.identity != drives.identity() || head.measures != drives.columns() ||
      names != folder.paradigms)
    throw NoDrives(fmt::format("{}, or a file that it names, has changed since the experiment was driven", sweep.file));
}

report::drive::Drive driven(const SweepDrives& drives, const experiments::results::Row& known) {
  const std::string& paradigm = drives.sweep().paradigms[known.key.paradigm].name;
  const ScratchFolder scratch;
  if (!same(drive_again(drives, known.key, scratch.path()), known))
    throw NoDrives(fmt::format("{}, driven again, gave other numbers than in results.sqlite", paradigm));
  report::drive::ResultsFolder folder =
      report::drive::read_results_folder(scratch.path());  // its logs are in memory now
  report::drive::Drive drive = std::move(folder.drives.front());
  drive.folder.clear();
  drive.label = paradigm;
  return drive;
}

std::vector<report::drive::Drive> all_driven(const report::experiment::ExperimentFolder& folder,
                                             const std::string& file, std::uint32_t point,
                                             const nodes::foreign::StepFolder* steps, std::uint32_t& replication) {
  const SweepFile sweep = experiments::sweep::read_sweep(file_with_seed(file, folder.seed));
  const SweepDrives drives(sweep, steps);
  check_same_experiment(drives, folder);
  const std::vector<experiments::results::Row> rows = first_done_by_all(*folder.store, point, folder.paradigms.size());
  if (rows.empty()) throw NoDrives(fmt::format("point {} has no replication that every paradigm has done", point));
  replication = rows.front().key.replication;
  fmt::print(stderr, "{}: {} of point {}, replication {}, again ...\n", sweep.name, counted(rows.size(), "run"), point,
             replication);
  std::vector<report::drive::Drive> all;
  for (const experiments::results::Row& row : rows) all.push_back(driven(drives, row));
  return all;
}

}  // namespace

experiments::results::Row drive_again(const SweepDrives& drives, const experiments::results::RowKey& key,
                                      const std::string& folder) {
  const SweepFile& sweep = drives.sweep();
  const experiments::sweep::PreparedDrive drive = drives.prepare(key);
  const std::unique_ptr<recording::log::LogWriter> log = drive::begin_log(
      fmt::format("{}/{}.mcap", folder, sweep.paradigms[key.paradigm].name),
      drive::manifest_of(drive.scenario, drive.cluster, drive.strategy, sweep.seed, {}, drives.steps()), drive.scenario,
      drive.cluster);
  experiments::results::Row row = drives.run(key, drive, log.get());
  log->close();
  return row;
}

report::experiment::ExperimentDrives drives_of(const report::experiment::ExperimentFolder& folder,
                                               const std::optional<std::string>& file,
                                               std::optional<std::uint32_t> point,
                                               const nodes::foreign::StepFolder* steps) {
  report::experiment::ExperimentDrives result;
  result.point = point.value_or(folder.points.front().point);
  if (std::ranges::find(folder.points, result.point, &report::experiment::ExperimentPoint::point) ==
      folder.points.end())
    throw InputError({"command line", 0, "--point", std::to_string(result.point),
                      fmt::format("must be a point of {}, {} to {}", folder.path, folder.points.front().point,
                                  folder.points.back().point)});
  const std::string path = file.value_or(folder.file);
  try {
    if (!folder.store) throw NoDrives("there is no results.sqlite");
    if (path.empty()) throw NoDrives("answer.json does not name the experiment's file: give --file");
    result.drives = all_driven(folder, path, result.point, steps, result.replication);
  } catch (const NoDrives& reason) {
    if (file)
      throw InputError({"command line", 0, "--file", *file, std::string("cannot be driven again: ") + reason.what()});
    result.why_none = fmt::format("No drive is shown here: {}.", reason.what());
  } catch (const InputError& error) {
    if (file) throw;
    result.why_none = fmt::format("No drive is shown here: the experiment cannot be driven again ({}).",
                                  error.findings().front().sentence());
  }
  return result;
}

}  // namespace ttf::cli::experiment
