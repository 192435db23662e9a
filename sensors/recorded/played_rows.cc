#include "sensors/recorded/played_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/counted.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/int128.h"

namespace ttf::sensors::recorded {
namespace {

using recording::rows::RecordedObservation;

std::string milliseconds(Duration duration) { return scaled_text(duration.ns, 1'000'000) + " ms"; }

constexpr std::int64_t kBillion = 1'000'000'000;

// A duration on the device's own clock, in true time; and back.
Duration in_true_time(const schedules::model::Node& device, Duration own) {
  const std::int64_t rate = kBillion + device.drift_ppb.value_or(0);
  return {static_cast<std::int64_t>(static_cast<Int128>(own.ns) * kBillion / rate)};
}
Duration on_its_clock(const schedules::model::Node& device, Duration true_time) {
  const std::int64_t rate = kBillion + device.drift_ppb.value_or(0);
  return {static_cast<std::int64_t>(static_cast<Int128>(true_time.ns) * rate / kBillion)};
}

Duration stamp_of(const RecordedObservation& row) { return Duration::microseconds(row.time_us_from_start); }

class Player {
 public:
  Player(const recording::rows::RecordedInput& input, const schedules::model::Cluster& cluster, SensorId sensor,
         const RecordedPlaying& playing, Duration until)
      : input_(input), cluster_(cluster), sensor_(cluster.sensor(sensor)), device_(cluster.node(sensor_.device)),
        playing_(playing), until_(until) {
    for (const RecordedObservation& row : input.observations)
      if (row.sensor == sensor_.name) rows_.push_back(row);
    played_.rows = rows_.size();
  }

  PlayedRows play() {
    const bool runs_freely = !sensor_.scheduled;
    const bool at_stamps = runs_freely && playing_.rows == RowsArePlayed::kAtTheirStamps;
    if (runs_freely) {
      check_stated(device_.drift_ppb.has_value(), device_.line, "nodes." + device_.name + ".drift_ppm",
                   "a drawn clock runs off the recording");
      check_stated(at_stamps || sensor_.phase.has_value(), sensor_.line, "sensors." + sensor_.name + ".phase",
                   "a drawn one fits no row");
    }
    if (at_stamps) {
      play_at_stamps();
    } else {
      list_instants();
      if (playing_.rows == RowsArePlayed::kResampled)
        resample();
      else
        play_as_scheduled();
    }
    for (std::size_t n = 0; n < instants_.size(); ++n)
      played_.silent += !played_.at[n] && !rows_.empty() && instants_[n] <= stamp_of(rows_.back());
    played_.times = std::move(instants_);
    return std::move(played_);
  }

 private:
  void check_stated(bool stated, int line, std::string key, const char* why) const {
    if (!stated)
      throw InputError(cluster_.finding(line, std::move(key), "",
                                        fmt::format("must be given for a device that plays a recording: {}", why)));
  }
  std::string stamp_text(Duration since) const { return fmt::format("{} us", input_.first_time_us + since.ns / 1000); }
  [[noreturn]] void refuse(std::size_t row, std::string expected) const {
    throw InputError({input_.name, rows_[row].line, "t_us",
                      std::to_string(input_.first_time_us + rows_[row].time_us_from_start), std::move(expected)});
  }

  void list_instants() {
    const Duration zero = first_measurement(cluster_, cluster_.sensors.front());
    const Duration first = first_measurement(cluster_, sensor_);
    for (std::int64_t n = 0;; ++n) {
      const Duration own = first + sensor_.period * n;
      const Duration at = (sensor_.scheduled ? own : in_true_time(device_, own)) - zero;
      if (at > until_) break;
      instants_.push_back(at);
      if (!sensor_.scheduled) played_.instants.push_back(own);
    }
    played_.at.resize(instants_.size());
  }

  // The measurement nearest to a stamp; the earlier of two. There must be one.
  std::size_t nearest(Duration stamp) const {
    const auto after = std::lower_bound(instants_.begin(), instants_.end(), stamp);
    if (after == instants_.begin()) return 0;
    const auto n = static_cast<std::size_t>(after - instants_.begin());
    return after == instants_.end() || stamp - instants_[n - 1] <= instants_[n] - stamp ? n - 1 : n;
  }
  Duration off(std::size_t row, std::size_t measurement) const {
    const Duration difference = stamp_of(rows_[row]) - instants_[measurement];
    return std::max(difference, -difference);
  }
  void leave_out(std::size_t row) {
    ++(instants_.empty() || stamp_of(rows_[row]) > instants_.back() ? played_.beyond : played_.between);
  }

  void play_as_scheduled() {
    std::vector<std::size_t> others;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const std::size_t n = instants_.empty() ? 0 : nearest(stamp_of(rows_[r]));
      if (!instants_.empty() && off(r, n) <= playing_.tolerance && !played_.at[n]) {
        played_.at[n] = rows_[r];
        ++played_.lists;
      } else {
        others.push_back(r);
      }
    }
    // A row that is nearer to an instant without a row than to any other would be played at the wrong time.
    std::vector<std::size_t> misfits;
    for (const std::size_t r : others) {
      if (is_misfit(r))
        misfits.push_back(r);
      else
        leave_out(r);
    }
    if (!misfits.empty()) refuse_misfits(misfits);
  }

  bool is_misfit(std::size_t row) const {
    if (instants_.empty()) return false;
    const std::size_t n = nearest(stamp_of(rows_[row]));
    return !played_.at[n] && off(row, n) * 2 < sensor_.period;
  }

  [[noreturn]] void refuse_misfits(const std::vector<std::size_t>& misfits) const {
    const Duration stamp = stamp_of(rows_[misfits.front()]);
    std::size_t n = nearest(stamp);
    if (n > 0 && instants_[n] > stamp) --n;
    refuse(
        misfits.front(),
        fmt::format("must be within {} of an instant at which {} has {} measure: every {}, so at {} and {}; {} of {} "
                    "of {} are not (the scenario's recorded.rows plays them otherwise: {}resampled)",
                    milliseconds(playing_.tolerance), cluster_.file, sensor_.name, milliseconds(sensor_.period),
                    stamp_text(instants_[n]), stamp_text(instants_[n] + sensor_.period), misfits.size(),
                    counted(rows_.size(), "row"), sensor_.name, sensor_.scheduled ? "" : "at_their_stamps, "));
  }

  void play_at_stamps() {
    const Duration zero = first_measurement(cluster_, cluster_.sensors.front());
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      if (stamp_of(rows_[r]) > until_) {
        ++played_.beyond;
        continue;
      }
      if (r > 0 && stamp_of(rows_[r]) - stamp_of(rows_[r - 1]) <
                       sensor_.period - std::min(playing_.tolerance, Duration{sensor_.period.ns / 2}))
        refuse(r, fmt::format("must be {} or more after the row before of {}, {}: {} is proved for this period",
                              milliseconds(sensor_.period), sensor_.name, stamp_text(stamp_of(rows_[r - 1])),
                              cluster_.file));
      instants_.push_back(stamp_of(rows_[r]));
      played_.at.emplace_back(rows_[r]);
      played_.instants.push_back(on_its_clock(device_, zero + stamp_of(rows_[r])));
      ++played_.lists;
    }
  }

  void resample() {
    std::vector<bool> used(rows_.size(), false);
    for (std::size_t n = 0; n < instants_.size(); ++n) {
      const auto after = static_cast<std::size_t>(
          std::lower_bound(rows_.begin(), rows_.end(), instants_[n],
                           [](const RecordedObservation& row, Duration at) { return stamp_of(row) < at; }) -
          rows_.begin());
      if (after == rows_.size()) break;
      const bool exact = stamp_of(rows_[after]) == instants_[n];
      if (!exact && after == 0) continue;
      const std::size_t before = exact ? after : after - 1;
      if (stamp_of(rows_[after]) - stamp_of(rows_[before]) > sensor_.period * 2) continue;
      played_.at[n] = between(rows_[before], rows_[after], instants_[n]);
      used[before] = used[after] = true;
      ++played_.lists;
    }
    for (std::size_t r = 0; r < rows_.size(); ++r)
      if (!used[r]) leave_out(r);
  }

  static RecordedObservation between(const RecordedObservation& a, const RecordedObservation& b, Duration at) {
    if (a.time_us_from_start == b.time_us_from_start) return a;
    const double s = static_cast<double>((at - stamp_of(a)).ns) / static_cast<double>((stamp_of(b) - stamp_of(a)).ns);
    const auto mixed = [s](double from, double to) { return from + s * (to - from); };
    RecordedObservation out = a;
    out.time_us_from_start = at.ns / 1000;
    out.x = mixed(a.x, b.x);
    out.y = mixed(a.y, b.y);
    out.range = mixed(a.range, b.range);
    out.bearing = a.bearing + s * std::remainder(b.bearing - a.bearing, 2.0 * std::numbers::pi);
    out.range_rate = mixed(a.range_rate, b.range_rate);
    return out;
  }

  const recording::rows::RecordedInput& input_;
  const schedules::model::Cluster& cluster_;
  const schedules::model::Sensor& sensor_;
  const schedules::model::Node& device_;
  const RecordedPlaying& playing_;
  Duration until_;
  std::vector<RecordedObservation> rows_;  // those of this sensor, in time order
  std::vector<Duration> instants_;
  PlayedRows played_;
};

}  // namespace

RecordedPlaying load_recorded_playing(YamlMap& yaml) {
  RecordedPlaying playing;
  playing.rows = yaml.choice_or<RowsArePlayed>("rows", playing.rows,
                                               {{"as_scheduled", RowsArePlayed::kAsScheduled},
                                                {"at_their_stamps", RowsArePlayed::kAtTheirStamps},
                                                {"resampled", RowsArePlayed::kResampled}});
  playing.tolerance =
      yaml.duration_or("tolerance", playing.tolerance, {Duration::microseconds(1), Duration::milliseconds(1'000)});
  return playing;
}

Duration first_measurement(const schedules::model::Cluster& cluster, const schedules::model::Sensor& sensor) {
  if (!sensor.scheduled) return sensor.phase.value_or(Duration{});
  return schedules::model::next_occurrence(cluster.flexray, sensor.at, GlobalTime{}).time - GlobalTime{};
}

PlayedRows played_rows(const recording::rows::RecordedInput& input, const schedules::model::Cluster& cluster,
                       SensorId sensor, const RecordedPlaying& playing, Duration until) {
  return Player(input, cluster, sensor, playing, until).play();
}

}  // namespace ttf::sensors::recorded
