#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/drive_setup.h"
#include "cli/output.h"
#include "cli/track/track_options.h"
#include "cli/track/track_outputs.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "drives/scenario.h"
#include "nodes/sensing/recorded.h"
#include "recording/rows/laser_radar_file.h"
#include "recording/rows/observation_rows.h"
#include "recording/rows/track_rows.h"
#include "replay/config.h"
#include "replay/recorded_lists.h"
#include "replay/replay.h"
#include "replay/sensor_timing.h"
#include "replay/verdict.h"

namespace ttf::cli::track {
namespace {

// Reports all findings; sound rows are kept. Without any sound row, the findings are an error.
void tell_damage(const Findings& findings, bool skip, std::size_t rows_left) {
  if (!skip || rows_left == 0) findings.throw_if_any();
  for (const Finding& finding : findings.list()) print_warnings(finding.sentence());
}

replay::SensorSetup usual_sensor(bool laser_radar) {
  replay::SensorSetup setup;
  if (!laser_radar) return setup;
  const nodes::sensing::RecordedNoise documented;
  setup.noise.position = documented.position_m;
  setup.noise.range = documented.range_m;
  setup.noise.bearing = documented.bearing_rad;
  setup.noise.range_rate = documented.range_rate_mps;
  return setup;
}

std::vector<recording::rows::ObservationRow> read_rows(const TrackOptions& options, Findings& findings) {
  try {
    if (options.format == "csv") return recording::rows::read_observation_rows(options.observations, findings);
    return recording::rows::observation_rows_of(recording::rows::read_laser_radar(options.observations, findings),
                                                options.observations);
  } catch (const InputError&) {
    refuse_any_kind(options.observations, "a recording");
    throw;
  }
}

int run_track(const TrackOptions& options) {
  if (options.json && options.out.empty())
    throw InputError({"command line", 0, "--json", "", "needs --out: the tracks would go to standard output, too"});
  if (!options.out.empty()) refuse_overwriting(options.observations, options.out, "--out");
  if (!options.out.empty() && !options.config.empty()) refuse_overwriting(options.config, options.out, "--out");

  const replay::SensorSetup usual = usual_sensor(options.format == "laser_radar");
  replay::ReplayConfig config;
  if (!options.config.empty()) config = replay::load_replay_config(options.config, usual);
  if (!options.strategy.empty()) config.strategy = drive::strategy_of(options.strategy);
  Findings findings;
  const std::vector<recording::rows::ObservationRow> rows = read_rows(options, findings);
  replay::list_sensors(config, rows, usual, options.observations);
  replay::SimulatedArrivals simulated;
  try {
    apply_sensor_options(options, config);
    simulated = simulated_arrivals(options, config);
  } catch (const InputError&) {
    // A sensor may be missing because its rows are damaged, so the damage is reported first.
    if (!options.skip_damaged) findings.throw_if_any();
    throw;
  }
  replay::RecordedLists recorded = replay::recorded_lists_of(rows, config, options.observations, findings);
  tell_damage(findings, options.skip_damaged, recorded.lists.size());
  replay::simulate(recorded, simulated);

  TrackResult result{std::string(name_of(config.strategy)), recorded.sensors, {}, findings.size(), {}};
  const replay::ReplaySetup setup{config.strategy, config.tracker,
                                  replay::sensor_timings(recorded, config, config.strategy), options.predict};
  std::string tracks(recording::rows::track_heading());
  result.account =
      replay::replay(recorded, setup, [&](GlobalTime known, std::span<const fusion::tracks::TrackView> views) {
        for (const fusion::tracks::TrackView& view : views)
          tracks += recording::rows::track_line(replay::track_row_of(view, known, recorded.classes));
      });

  result.verdict = replay::judge(rows, findings.size(), recorded, setup, result.account);
  if (options.out.empty()) {
    fmt::print("{}", tracks);
    std::fflush(stdout);  // both streams may share one file
    fmt::print(stderr, "{}", track_table(result));
  } else {
    write_file(options.out, tracks);
    fmt::print("{}", options.json ? to_json(result).dump(2) + '\n' : track_table(result));
    std::fflush(stdout);
    say_written(options.out);
  }
  return print_reasons(options.observations, result.verdict.headline, result.verdict.reasons);
}

void add_sensor_options(CLI::App& command, TrackOptions& options) {
  const auto each_takes_one = [](CLI::Option* option) { option->allow_extra_args(false); };
  each_takes_one(command.add_option("--noise", options.noise,
                                    "SENSOR:WHAT=SIGMA: noise of rows without a covariance, as in radar:range=0.3; "
                                    "may be repeated, like the next three"));
  each_takes_one(
      command.add_option("--worst-delay", options.worst_delay,
                         "SENSOR=DURATION: the delay that buff and tt rely on (default: the longest one recorded)"));
  each_takes_one(
      command.add_option("--period", options.period,
                         "SENSOR=DURATION: the period that tt relies on (default: the recorded one, if regular)"));
  each_takes_one(
      command.add_option("--delay", options.delay,
                         "SENSOR=LEAST..MOST: delays to draw instead of the recorded ones, as in radar=20ms..70ms"));
}

}  // namespace

void add_track(CLI::App& app, Action& action) {
  auto options = std::make_shared<TrackOptions>();
  CLI::App* command = app.add_subcommand("track", "Recorded observations through the tracker: tracks as CSV");
  command->footer(
      "Columns, in and out, and the configuration: docs/track.md.\n"
      "Example: ttfusion track observations.csv --strategy buff --delay radar=20ms..70ms --seed 7 -o tracks.csv");
  command->add_option("observations", options->observations, "Recorded observations")->required()->check(named());
  command->add_option("--config", options->config, "Tracker, strategy and sensors (YAML)")->check(named());
  command
      ->add_option("--format", options->format, "csv (docs/track.md; the default) or laser_radar (docs/recordings.md)")
      ->check(one_of({"csv", "laser_radar"}));
  command->add_option("--strategy", options->strategy, "Strategy, instead of the configuration's (default: adva)")
      ->check(one_of(drive::strategy_names()));
  add_sensor_options(*command, *options);
  command->add_option("--shuffle", options->shuffle, "Groups of this many lists arrive together, in drawn order")
      ->check(whole_number({1, 1000}));
  command->add_option("--seed", options->seed, "Seed of the draws (default: 1)");
  command->add_flag("--predict", options->predict, "Tracks predicted to the instant of each fusion");
  command->add_flag("--skip-damaged", options->skip_damaged, "Leave damaged rows out, each with a warning");
  command->add_option("-o,--out", options->out, "File for the tracks (default: standard output)")->check(named());
  command->add_flag("--json", options->json, "Summary as JSON on standard output; needs --out");
  command->callback([options, &action] { action = [options] { return run_track(*options); }; });
}

}  // namespace ttf::cli::track
