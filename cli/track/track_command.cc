#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/drive/drive_setup.h"
#include "cli/logs/scan_verdict.h"
#include "cli/output.h"
#include "cli/paper_size.h"
#include "cli/progress.h"
#include "cli/track/scan_lists.h"
#include "cli/track/track_judge.h"
#include "cli/track/track_lives.h"
#include "cli/track/track_options.h"
#include "cli/track/track_outputs.h"
#include "core/counted.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "fusion/tracks/own_axes.h"
#include "recording/replay/config.h"
#include "recording/replay/recorded_ego.h"
#include "recording/replay/recorded_lists.h"
#include "recording/replay/replay.h"
#include "recording/replay/sensor_timing.h"
#include "recording/replay/verdict.h"
#include "recording/rows/ego_rows.h"
#include "recording/rows/laser_radar_file.h"
#include "recording/rows/observation_rows.h"
#include "recording/rows/scan_file.h"
#include "recording/rows/track_rows.h"
#include "report/drawing/render.h"
#include "report/plots/boxes_picture.h"
#include "sensors/laser/recorded_scans.h"
#include "sensors/recorded/recorded.h"
#include "sim/drives/scenario.h"

namespace ttf::cli::track {
namespace {

// A heading is drawn if it is known as well as this: 20 degrees.
constexpr double kKnownHeading_rad = 0.35;

// Draws a recorded scan and the tracks that are known once it was taken in.
class ScanPicture {
 public:
  ScanPicture(const recording::rows::RecordedScan& scan, const sensors::laser::RecordedScansConfig& how)
      : scan_(scan), at_(sensors::laser::instant_of(scan, how)) {}
  // Takes the tracks whose state is of the scan's instant; the last ones count. A mounted scanner's returns are in its own
  // axes, tracks in the vehicle's: the picture is of a scanner at the origin.
  void take(std::span<const fusion::tracks::TrackView> tracks) {
    if (tracks.empty() || tracks.front().valid_at != at_) return;
    boxes_.clear();
    for (const fusion::tracks::TrackView& track : tracks)
      boxes_.push_back({track.state(0), track.state(1), track.heading, track.length, track.width,
                        std::to_string(index_of(track.id)), track.sigma_heading <= kKnownHeading_rad,
                        track.has_length && track.has_width});
  }
  std::string svg(const report::drawing::Sheet& sheet) const {
    std::vector<report::drawing::Point> points;
    for (const recording::rows::RecordedReturn& hit : scan_.returns)
      points.push_back({hit.range_m * std::cos(hit.azimuth_rad), hit.range_m * std::sin(hit.azimuth_rad)});
    return report::plots::boxes_svg(
        points, boxes_,
        fmt::format("Scan {}: {}, {}", scan_.frame, counted(points.size(), "return"), counted(boxes_.size(), "track")),
        "track", sheet);
  }

 private:
  const recording::rows::RecordedScan& scan_;
  GlobalTime at_;
  std::vector<report::plots::Box> boxes_;
};

// Reports all findings; sound rows are kept. Without any sound row, the findings are an error.
void report_damage(const Findings& findings, bool skip, std::size_t rows_left) {
  if (!skip || rows_left == 0) findings.throw_if_any();
  for (const Finding& finding : findings.list()) print_warnings(finding.sentence());
}

recording::replay::SensorSetup usual_sensor(bool laser_radar) {
  recording::replay::SensorSetup setup;
  if (!laser_radar) return setup;
  const sensors::recorded::RecordedNoise documented;
  setup.noise.position = documented.position_m;
  setup.noise.range = documented.range_m;
  setup.noise.bearing = documented.bearing_rad;
  setup.noise.range_rate = documented.range_rate_mps;
  return setup;
}

// The file, whatever its format.
struct Recording {
  std::vector<recording::rows::ObservationRow> rows;
  std::vector<recording::rows::RecordedScan> scans;  // only with --format scans
};

Recording read_recording(const TrackOptions& options, Findings& findings) {
  try {
    if (options.format == "scans") return {{}, recording::rows::read_lidar_scans(options.observations, findings)};
    if (options.format == "csv") return {recording::rows::read_observation_rows(options.observations, findings), {}};
    return {recording::rows::observation_rows_of(recording::rows::read_laser_radar(options.observations, findings),
                                                 options.observations),
            {}};
  } catch (const InputError&) {
    refuse_any_kind(options.observations, "a recording");
    throw;
  }
}

// Scans are of one sensor, and of a street: its tracks must not overlap, unless the configuration says so.
void prepare_for_scans(recording::replay::ReplayConfig& config, const recording::replay::SensorSetup& usual) {
  if (config.sensors.empty()) config.sensors.emplace_back("laser", usual);
  // The other methods for late lists cannot end tracks for good.
  if (!config.tracker.end_overlaps) config.tracker.end_overlaps = config.tracker.late == fusion::oosm::Kind::kRewind;
  if (config.sensors.size() > 1)
    throw InputError({config.file, 0, "sensors", std::to_string(config.sensors.size()),
                      "must be one sensor: scans are those of one scanner"});
}

// The number of the scan to draw: the last one, unless --frame says another.
std::size_t drawn_scan(const TrackOptions& options, std::size_t scans) {
  if (!options.frame) return scans - 1;
  if (*options.frame >= static_cast<std::int64_t>(scans))
    throw InputError({"command line", 0, "--frame", std::to_string(*options.frame),
                      fmt::format("must be 0..{}: the recording has {}", scans - 1, counted(scans, "scan"))});
  return static_cast<std::size_t>(*options.frame);
}

void check_options(const TrackOptions& options) {
  if (options.json && options.out.empty())
    throw InputError({"command line", 0, "--json", "", "needs --out: the tracks would go to standard output, too"});
  for (const std::string& written : {options.out, options.picture}) {
    const std::string flag = &written == &options.out ? "--out" : "--picture";
    if (!written.empty()) refuse_overwriting(options.observations, written, flag);
    if (!written.empty() && !options.config.empty()) refuse_overwriting(options.config, written, flag);
    if (!written.empty() && !options.ego.empty()) refuse_overwriting(options.ego, written, flag);
  }
  if (!options.picture.empty() && options.format != "scans")
    throw InputError({"command line", 0, "--picture", options.picture, "goes with --format scans only"});
  if (options.frame && options.picture.empty())
    throw InputError({"command line", 0, "--frame", std::to_string(*options.frame), "goes with --picture only"});
  if (!options.picture.empty()) report::drawing::check_picture_path(options.picture);
  if (options.paper.width && options.picture.empty())
    throw InputError({"command line", 0, "--width", *options.paper.width, "goes with --picture only"});
  sheet_of(options.paper);  // refuses a size before the work
}

// A box comes of many returns, which are the rows of scans.
recording::replay::RowCounts row_counts(const recording::replay::RecordedLists& recorded,
                                        const std::optional<ScanAccount>& scans, const Findings& findings) {
  recording::replay::RowCounts counts{scans ? scans->returns : 0, findings.size()};
  if (scans) return counts;
  for (const recording::replay::RecordedList& list : recorded.lists) counts.sound += list.observations.size();
  return counts;
}

// Without any box, preprocessing has the reasons. The reason why most was dropped comes first.
void judge_scans(const sensors::laser::LaserPreprocessingConfig& how, TrackResult& result) {
  if (result.scans->fates.objects > 0) return;
  result.verdict.made_nothing = true;
  result.verdict.headline = fmt::format("no box came of {}", counted(result.scans->scans, "scan"));
  const std::vector<std::string> reasons = logs::reasons_for_no_box(how, result.scans->fates);
  result.verdict.reasons.resize(result.verdict.dropped_most ? 1 : 0);
  result.verdict.reasons.insert(result.verdict.reasons.end(), reasons.begin(), reasons.end());
}

std::uint64_t seconds_between(GlobalTime from, GlobalTime to) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, (to - from).ns) / 1'000'000'000);
}

// Returns the tracks in the vehicle's axes at their instant, in `own`.
std::span<const fusion::tracks::TrackView> in_own_axes(std::span<const fusion::tracks::TrackView> tracks,
                                                       const recording::replay::RecordedEgo& ego,
                                                       std::vector<fusion::tracks::TrackView>& own) {
  own.assign(tracks.begin(), tracks.end());
  for (fusion::tracks::TrackView& view : own)
    if (const auto state = ego.at(view.valid_at)) fusion::tracks::to_own_axes(view, *state, ego.errors());
  return own;
}

int run_track(const TrackOptions& options) {
  check_options(options);
  const recording::replay::SensorSetup usual = usual_sensor(options.format == "laser_radar");
  const bool of_scans = options.format == "scans";
  recording::replay::ReplayConfig config;
  sensors::laser::RecordedScansConfig scanner;
  if (!options.config.empty())
    config = recording::replay::load_replay_config(options.config, usual, [&](YamlMap& root) {
      std::optional<YamlMap> scans = root.map_if("scans");
      if (!scans) return;
      if (!of_scans) root.fail("scans", "goes with --format scans only");
      scanner = sensors::laser::load_recorded_scans(*scans);
      scans->finish();
    });
  if (!options.strategy.empty()) config.strategy = drive::strategy_of(options.strategy);
  Findings findings;
  Recording input = read_recording(options, findings);
  std::vector<recording::rows::ObservationRow>& rows = input.rows;
  std::optional<recording::replay::RecordedEgo> ego;
  if (!options.ego.empty())
    ego = recording::replay::recorded_ego_of(recording::rows::read_ego_rows(options.ego), options.ego, config);
  else if (config.tracker.odometry)
    throw InputError(
        {config.file, config.tracker.odometry_line, "tracker.odometry", "", "must be absent without --ego"});
  if (of_scans)
    prepare_for_scans(config, usual);
  else
    recording::replay::list_sensors(config, rows, usual, options.observations);
  recording::replay::SimulatedArrivals simulated;
  try {
    apply_sensor_options(options, config);
    simulated = simulated_arrivals(options, config);
  } catch (const InputError&) {
    // A sensor may be missing because its rows are damaged, so the damage is reported first.
    if (!options.skip_damaged) findings.throw_if_any();
    throw;
  }
  TrackResult result;
  recording::replay::RecordedLists recorded;
  if (of_scans) {
    ScanLists lists = lists_of(input.scans, scanner, config, options.observations);
    recorded = std::move(lists.recorded);
    result.scans = lists.account;
  } else {
    recorded = recording::replay::recorded_lists_of(rows, config, options.observations, findings);
  }
  report_damage(findings, options.skip_damaged, recorded.lists.size());
  if (ego) recording::replay::carry(recorded, rows, *ego, options.observations);
  recording::replay::simulate(recorded, simulated);

  result.strategy = std::string(name_of(config.strategy));
  result.sensors = recorded.sensors;
  result.damaged = findings.size();
  const recording::replay::ReplaySetup setup{config.strategy, config.tracker,
                                             recording::replay::sensor_timings(recorded, config, config.strategy),
                                             options.predict};
  std::string tracks(recording::rows::track_heading());
  TrackJudge judge(rows, config.cut_off);
  TrackLives lives;
  std::vector<fusion::tracks::TrackView> own;
  std::optional<ScanPicture> picture;
  if (!options.picture.empty()) picture.emplace(input.scans[drawn_scan(options, input.scans.size())], scanner);
  std::optional<Progress> progress(std::in_place, "s of the recording");
  const GlobalTime first = recorded.lists.empty() ? GlobalTime{} : recorded.lists.front().arrival;
  const std::uint64_t whole = recorded.lists.empty() ? 0 : seconds_between(first, recorded.lists.back().arrival);
  result.account = recording::replay::replay(
      recorded, setup, [&](GlobalTime known, std::span<const fusion::tracks::TrackView> views) {
        const std::uint64_t done = seconds_between(first, known);
        (*progress)(done, whole, done);
        judge.take(known, views);
        if (ego) views = in_own_axes(views, *ego, own);
        if (of_scans) lives.take(views);
        if (picture) picture->take(views);
        for (const fusion::tracks::TrackView& view : views)
          tracks += recording::rows::track_line(recording::replay::track_row_of(view, known, recorded.classes));
      });

  progress.reset();
  result.accuracy = judge.finish();
  result.verdict =
      recording::replay::judge(rows, row_counts(recorded, result.scans, findings), recorded, setup, result.account);
  if (of_scans) {
    result.lives = lives.summary();
    judge_scans(scanner.preprocessing, result);
  }
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
  if (picture) {
    report::drawing::write_picture(picture->svg(sheet_of(options.paper)), options.picture);
    say_written(options.picture);
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
      "Columns, in and out, and the configuration: docs/use/track.md.\n"
      "Example: ttfusion track observations.csv --strategy buff --delay radar=20ms..70ms \\\n"
      "           --seed 7 -o tracks.csv\n"
      "         ttfusion track scans.csv --format scans --picture street.svg -o tracks.csv");
  command->add_option("observations", options->observations, "Recorded observations")->required()->check(named());
  command
      ->add_option("--ego", options->ego,
                   "Motion of the sensors' vehicle (CSV): time, x, y, heading, or time, speed, yaw_rate")
      ->check(named());
  command->add_option("--config", options->config, "Tracker, strategy and sensors (YAML)")->check(named());
  command
      ->add_option("--format", options->format,
                   "csv (docs/use/track.md; the default), laser_radar or scans (docs/use/recordings.md)")
      ->check(one_of({"csv", "laser_radar", "scans"}));
  command->add_option("--strategy", options->strategy, "Strategy, instead of the configuration's (default: adva)")
      ->check(one_of(drive::strategy_names()));
  add_sensor_options(*command, *options);
  command->add_option("--shuffle", options->shuffle, "Groups of this many lists arrive together, in drawn order")
      ->check(whole_number({1, 1000}));
  command->add_option("--seed", options->seed, "Seed of the draws (default: 1)");
  command->add_flag("--predict", options->predict, "Tracks predicted to the instant of each fusion");
  command->add_flag("--skip-damaged", options->skip_damaged, "Leave damaged rows out, each with a warning");
  command->add_option("-o,--out", options->out, "File for the tracks (default: standard output)")->check(named());
  command
      ->add_option("--picture", options->picture,
                   "Picture of a scan and its tracks: .svg, .png or .pdf; only with --format scans")
      ->check(named());
  command->add_option("--frame", options->frame, "Which scan to draw, from 0 (default: the last one)")
      ->check(whole_number({0, 1'000'000'000}));
  add_paper_size(*command, options->paper);
  command->add_flag("--json", options->json, "Summary as JSON on standard output; needs --out");
  command->callback([options, &action] { action = [options] { return run_track(*options); }; });
}

}  // namespace ttf::cli::track
