// The latency of measurements by stage, from a drive's records: what the schedule's analysis bounds, beside what was.
//
// Stages are those of schedules/analysis/ages.h between two instants that records show. Where no record shows the end
// of a stage, it is stated together with the next one. A measurement counts if its whole way was seen: to the first use of
// the first image in which it is its sensor's newest, or to the fusion without a service. So the mean stages add up to
// the mean age.
//
// All instants are true times. The analysis' bounds hold on any clock.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/binned_durations.h"
#include "recording/records/records.h"
#include "schedules/analysis/ages.h"

namespace ttf::evaluation::ages {

struct DurationStatistics {
  std::uint64_t count = 0;
  Duration sum{}, least{}, most{};
  recording::records::BinnedDurations binned;

  void add(Duration one);
  Duration mean() const { return count == 0 ? Duration{} : Duration{sum.ns / static_cast<std::int64_t>(count)}; }
  Duration p99() const { return binned.quantile(990); }
};

struct StageFinding {
  std::string name;
  // The stage's shares of the least and of the largest age. A stage may last longer where another is shorter: they
  // bound the sum. Absent if the schedule bounds none, as the wait for the order of lists.
  std::optional<Duration> best, worst;
  DurationStatistics had;
  // The age of the measurement at the stage's end, and its bounds.
  Duration age_best{};
  std::optional<Duration> age_worst;
  DurationStatistics age;
  std::uint64_t beyond = 0;  // measurements whose age there was outside its bounds
};

struct SensorStages {
  SensorId sensor{};
  std::vector<StageFinding> stages;
  std::uint64_t measured = 0;  // in the judged part
  bool to_use = false;         // else to the fusion

  std::uint64_t seen() const { return stages.empty() ? 0 : stages.back().had.count; }
  // Whether all ages were within their bounds.
  bool within() const;
};

class StageAccount final : public recording::records::Sink {
 public:
  // Judges what was measured from `from` on. `held`: the strategy holds lists for their order (BUFF).
  StageAccount(std::vector<schedules::analysis::AgePath> paths, bool held, TrueTime from);

  // Returns the sensors in the order of the paths. Call it once, at the end.
  std::vector<SensorStages> finish();

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::Measured& r) override;
  void on(const recording::records::ListHop& r) override;
  void on(const recording::records::ListFused& r) override;
  void on(const recording::records::ImageWritten& r) override;
  void on(const recording::records::FeatureUsed& r) override;

 private:
  // A measurement on its way: the instants at its waypoints, as far as they were seen.
  struct Way {
    TrueTime measured{};
    std::vector<std::optional<TrueTime>> at;
    bool in_image = false;
  };
  struct Sensor {
    schedules::analysis::AgePath path;
    SensorStages findings;
    std::map<std::uint32_t, Way> ways;  // by number
  };
  using Kind = schedules::analysis::Waypoint::Kind;

  Sensor* sensor_of(SensorId id);
  static void pass(Sensor& sensor, Way& way, Kind kind, NodeId node, PduId pdu, TrueTime at);
  void end(Sensor& sensor, const Way& way);

  bool held_;
  TrueTime from_;
  std::vector<Sensor> sensors_;
  struct Image {
    std::uint64_t order = 0;           // images written before: a fusion node that restarts counts anew
    std::vector<MeasurementId> first;  // measurements that it is the first to show
  };
  std::map<std::uint32_t, Image> images_;  // the last ones, by number
  std::uint64_t written_ = 0;
};

}  // namespace ttf::evaluation::ages
