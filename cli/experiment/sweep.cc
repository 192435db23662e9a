#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "cli/experiment/answer_json.h"
#include "cli/experiment/drives.h"
#include "cli/experiment/options.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "core/counted.h"
#include "core/errors.h"
#include "experiments/sweep/answers/answer_text.h"
#include "experiments/sweep/engine.h"

namespace ttf::cli::experiment {
namespace {

using experiments::results::Store;
using experiments::sweep::SweepDrives;
using experiments::sweep::SweepFile;

constexpr std::size_t kShownFailures = 10;  // further failures are only in runs.csv

std::string folder_of(const ExperimentOptions& options, const SweepFile& sweep) {
  return options.out.empty() ? "out/" + sweep.name : options.out;
}
std::string store_in(const std::string& folder) { return folder + "/results.sqlite"; }

std::string key_text(const SweepFile& sweep, const experiments::results::RowKey& key) {
  return fmt::format("{}/{}/{}", key.point, sweep.paradigms[key.paradigm].name, key.replication);
}

std::string names_of(const SweepFile& sweep) {
  std::vector<std::string> names;
  for (const experiments::sweep::Paradigm& paradigm : sweep.paradigms) names.push_back(paradigm.name);
  return joined(names);
}

experiments::results::RowKey key_of(const std::string& text, const SweepFile& sweep) {
  const std::size_t first = text.find('/'), second = text.rfind('/');
  experiments::results::RowKey key;
  const auto number = [](std::string_view part, std::size_t below, std::uint32_t& value) {
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    return error == std::errc{} && end == part.data() + part.size() && value < below;
  };
  if (first != std::string::npos && second > first) {
    const std::string_view all = text;
    const std::string_view name = all.substr(first + 1, second - first - 1);
    for (std::uint32_t p = 0; p < sweep.paradigms.size(); ++p)
      if (key.paradigm = p; sweep.paradigms[p].name == name &&
                            number(all.substr(0, first), sweep.points(), key.point) &&
                            number(all.substr(second + 1), sweep.replications, key.replication))
        return key;
  }
  throw InputError(
      {"command line", 0, "--replay", text,
       fmt::format("must be point/paradigm/replication, of points 0..{} and replications 0..{}; paradigms: {}",
                   sweep.points() - 1, sweep.replications - 1, names_of(sweep))});
}

int replay(const ExperimentOptions& options, const SweepDrives& drives) {
  const SweepFile& sweep = drives.sweep();
  const experiments::results::RowKey key = key_of(*options.replay, sweep);
  if (!options.out.empty()) create_folder(options.out);
  const experiments::results::Row row =
      options.out.empty() ? drives.run(key, drives.prepare(key)) : drive_again(drives, key, options.out);
  if (!options.out.empty()) say_written(options.out);
  fmt::print("{}, {}, replication {}: {}\n", sweep.label_of(key.point), sweep.paradigms[key.paradigm].name,
             key.replication, row.status);
  const std::vector<std::string> columns = drives.columns();
  for (std::size_t c = 0; c < columns.size(); ++c)
    fmt::print("  {} {}\n", columns[c], std::isnan(row.values[c]) ? "-" : fmt::format("{}", row.values[c]));
  return row.status == experiments::results::kDone ? 0 : 1;
}

// Opens a store and checks that all of its drives belong to this experiment. Throws InputError.
Store opened(const SweepDrives& drives, const std::string& path) {
  Store store = Store::open(path);
  if (store.head().identity != drives.identity() || store.head().measures != drives.columns() ||
      store.head().version != TTF_VERSION)
    throw InputError(
        {path, 0, "", "",
         "must belong to this experiment: the file, its seed, a file that it names or the program has changed"});
  const SweepFile& sweep = drives.sweep();
  for (const experiments::results::RowKey& key : store.keys())
    if (key.point >= sweep.points() || key.replication >= sweep.replications || key.paradigm >= sweep.paradigms.size())
      throw InputError({path, 0, "runs", fmt::format("{}/{}/{}", key.point, key.paradigm, key.replication),
                        "must be a run of this experiment: point/paradigm/replication"});
  return store;
}

Store store_of(const ExperimentOptions& options, const SweepDrives& drives, const std::string& path) {
  const SweepFile& sweep = drives.sweep();
  if (!std::filesystem::exists(path))
    return Store::create(
        path, {sweep.name, drives.identity(), TTF_VERSION, sweep.text, drives.columns(), sweep.replications});
  if (!options.resume)
    throw InputError({path, 0, "", "", "exists already: --resume continues it, another --out begins anew"});
  Store store = opened(drives, path);
  if (store.head().replications != sweep.replications) store.ask_for(sweep.replications);
  return store;
}

// Returns whether the merged store is complete.
bool merge(const std::vector<Store>& shards, const SweepFile& sweep, Store& store) {
  for (const Store& shard : shards) {
    std::vector<experiments::results::Row> some;
    shard.for_each([&](const experiments::results::Row& row) {
      some.push_back(row);
      if (some.size() == 10'000) store.add(std::exchange(some, {}));
    });
    store.add(some);
  }
  const std::uint64_t all = sweep.drives();
  if (sweep.stop || store.count() == all) return true;
  fmt::print(stderr, "error: {} of {} runs are missing: --resume drives them\n", all - store.count(), all);
  return false;
}

// With more than one rank in `ranks`, every rank is a worker.
void drive(const ExperimentOptions& options, const SweepDrives& drives, experiments::results::Shard shard, Store& store,
           experiments::mpi::Ranks& ranks) {
  const SweepFile& sweep = drives.sweep();
  const bool alone = ranks.size() == 1;
  const unsigned jobs = !alone ? 1 : options.jobs > 0 ? options.jobs : experiments::results::workers_here();
  fmt::print(stderr, "{}: {}, {}, {}, {} ...\n", sweep.name, counted(sweep.points(), "point"),
             counted(sweep.paradigms.size(), "paradigm"), counted(sweep.replications, "replication"),
             alone ? counted(jobs, "worker") : counted(static_cast<std::size_t>(ranks.size()), "rank"));
  Progress progress("runs");
  experiments::sweep::run_sweep(
      drives, store, shard, jobs,
      [&](const experiments::sweep::SweepProgress& now) { progress(now.done, now.all, now.driven); },
      alone ? nullptr : &ranks);
}

// Lists failed drives, each with the command that drives it again.
std::string failures_text(const ExperimentOptions& options, const SweepFile& sweep, const Store& store) {
  std::string text;
  std::size_t shown = 0;
  store.for_each([&](const experiments::results::Row& row) {
    if (row.status == experiments::results::kDone || ++shown > kShownFailures) return;
    std::string more = options.replications > 0 ? fmt::format(" --replications {}", options.replications) : "";
    if (options.seed) more += fmt::format(" --seed {}", *options.seed);
    for (const std::string& argument : options.steps.arguments()) more += " " + argument;
    text += fmt::format("{}: {}\n  ttfusion experiment {} --replay {}{} --out out/one\n", sweep.label_of(row.key.point),
                        row.status, options.file, key_text(sweep, row.key), more);
  });
  if (shown > kShownFailures) text += fmt::format("and {} more, in runs.csv\n", shown - kShownFailures);
  return text;
}

}  // namespace

int drive_and_answer(const ExperimentOptions& options, const SweepDrives& drives, experiments::mpi::Ranks& ranks) {
  const SweepFile& sweep = drives.sweep();
  // Checks all options before anything is written.
  const experiments::results::Shard shard = shard_of(options.shard);
  if (!options.shard.empty() && sweep.stop)
    throw InputError({"command line", 0, "--shard", options.shard,
                      "needs an experiment without `stop`: no shard has enough runs to decide it"});
  std::vector<Store> shards;
  for (const std::string& from : options.merge) shards.push_back(opened(drives, store_in(from)));

  const std::string folder = folder_of(options, sweep);
  create_folder(folder);
  Store store = store_of(options, drives, store_in(folder));
  if (shards.empty())
    drive(options, drives, shard, store, ranks);
  else if (!merge(shards, sweep, store))
    return 1;

  const experiments::sweep::answers::SweepAnswer answer = experiments::sweep::answers::answer_of(sweep, store);
  const std::string text =
      experiments::sweep::answers::answer_text(sweep, answer) + failures_text(options, sweep, store);
  const nlohmann::ordered_json json = answer_json(sweep, answer, drives.libraries());
  write_file(folder + "/answer.txt", text);
  write_file(folder + "/answer.json", json.dump(2) + '\n');
  write_file(folder + "/summary.csv", experiments::sweep::answers::summary_csv(sweep, answer));
  write_file(folder + "/runs.csv", experiments::sweep::answers::runs_csv(sweep, store));
  if (options.json)
    fmt::print("{}\n", json.dump(2));
  else
    fmt::print("{}", text);
  std::fflush(stdout);
  say_written(folder);
  return answer.holds() && answer.failed == 0 ? 0 : 1;
}

void settle_replications(ExperimentOptions& options, SweepFile& sweep) {
  std::vector<std::string> paths;
  for (const std::string& from : options.merge) paths.push_back(store_in(from));
  if (options.resume) {
    paths.push_back(store_in(folder_of(options, sweep)));
    if (!std::filesystem::exists(paths.back()))
      throw InputError(
          {"command line", 0, "--resume", "",
           fmt::format("needs {}, which is not there: begin without --resume, with all other options", paths.back())});
  }
  std::uint32_t there = 0;
  for (const std::string& path : paths) {
    const std::uint32_t asked_for = Store::open(path).head().replications;
    if (options.replications > 0 && options.replications < asked_for)
      throw InputError({"command line", 0, "--replications", std::to_string(options.replications),
                        fmt::format("must be at least {}, as in {}", asked_for, path)});
    there = std::max(there, asked_for);
  }
  const std::uint32_t files = sweep.replications;
  sweep.replications = options.replications > 0 ? options.replications : there > 0 ? there : files;
  options.replications = sweep.replications == files ? 0 : sweep.replications;
  if (sweep.drives() > experiments::sweep::kMostDrives)
    throw InputError(
        {"command line", 0, "--replications", std::to_string(sweep.replications),
         fmt::format("must make at most {} drives, not {}", experiments::sweep::kMostDrives, sweep.drives())});
}

int run_sweep_experiment(const ExperimentOptions& given, experiments::mpi::Ranks& alone) {
  ExperimentOptions options = given;
  SweepFile sweep = experiments::sweep::read_sweep(file_with_seed(options.file, options.seed));
  settle_replications(options, sweep);
  const std::optional<nodes::foreign::StepFolder> folder = drive::step_folder(options.steps);
  const SweepDrives drives(sweep, drive::pointer_to(folder));
  if (options.replay) return replay(options, drives);
  return drive_and_answer(options, drives, alone);
}

}  // namespace ttf::cli::experiment
