// The fusion node: decodes the lists from its controller, hands them to a strategy, and writes the real-time image.
//
// The node has only bytes from its controller, the schedule and its own clock. Its tasks share one
// FusionHost. A task `fusion` runs at every fusion instant; with BUFF and ADVA there may be one for each
// sensor, which runs when a list of that sensor arrives. `image_output` runs before the image's slots. The
// image is predicted to the instant at which the feature service will use it, known from the schedule. The
// prediction leaves the filter state unchanged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "fusion/ego/ego_path.h"
#include "fusion/strategies/strategy.h"
#include "nodes/fusion/image_codec.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"
#include "sensors/observation_codec.h"

namespace ttf::nodes::fusion {

// Returns each sensor's timing by the schedule, for the strategy (schedules/analysis/settled.h computes
// how long to wait for a list).
std::vector<ttf::fusion::strategies::SensorTiming> sensor_timings(const schedules::model::Cluster& cluster);

// Returns the odometry that a task reads; kNoSensor: it reads none.
SensorId odometry_of(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
// Returns the odometry that a fusion task of the cluster reads; kNoSensor: none reads any, and images are relative to the
// vehicle.
SensorId fused_odometry(const schedules::model::Cluster& cluster);

// Returns the tracker of a scenario with its sensors by their ids in this cluster, and with odometry if the fusion reads it.
// Throws InputError, naming the scenario's file, for a sensor name that the cluster lacks, and for keys that its vehicle
// contradicts.
ttf::fusion::config::TrackerConfig tracker_in(const schedules::model::Cluster& cluster,
                                              ttf::fusion::config::TrackerConfig tracker,
                                              const std::string& scenario_file);

// `tracker` is a result of tracker_in().
struct FusionHost {
  FusionHost(const schedules::model::Cluster& cluster, ttf::fusion::strategies::StrategyKind kind,
             const ttf::fusion::config::TrackerConfig& tracker);
  // Takes a view to the vehicle's axes at its instant. Without odometry, tracks live in these.
  void to_own_axes(ttf::fusion::tracks::TrackView& view) const;

  std::unique_ptr<ttf::fusion::strategies::Strategy> strategy;
  std::vector<ttf::fusion::sensors::KnownSensor> sensors;  // by SensorId
  std::optional<ttf::fusion::ego::EgoPath> ego;            // with odometry
  MeasurementId odometry{};                                // the newest sample's
  bool odometry_stopped = false;                           // said, and no sample has come since
  std::size_t most_objects;                                // the largest number of confirmed tracks
  std::size_t most_observations;                           // in one list
  std::uint32_t step = 0;                                  // the number of the fusion instant, from 1
  std::uint64_t unlisted = 0;                              // the strategy's count at the last fusion instant
};

// Decides whether a list's age is known. A list's stamp counts the rounds of the cycle counter as its sender
// does; the reader adds `rounds` to get its own count (nodes/host/step.h). A living gateway repeats an old list
// of a dead sensor, which would be shifted in the same way and seem new. So a new number of rounds is believed
// only if two lists in a row have it: a repeated list has no successor.
class RoundsBelieved {
 public:
  // Returns whether to believe the age of a list that was not seen before. Nodes that began together differ by
  // 0 rounds.
  bool believed(std::int64_t rounds);

 private:
  std::int64_t rounds_ = 0;
  std::optional<std::int64_t> claimed_;
};

// Ports: any number, one per sensor list. A list of unknown age is discarded.
//
// A list of odometry moves the vehicle on (fusion/ego/ego_path.h), ahead of the other lists of the same instant. These are
// placed by the pose at their own instants. A list from before the odometry began has no pose, and is discarded, as is a
// sample that is not the newest one, or is from the future.
class FusionStep final : public host::Step {
 public:
  static constexpr std::string_view kName = "fusion";  // in a schedule

  FusionStep(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
             std::shared_ptr<FusionHost> host);
  void run(host::StepContext& context) override;

 private:
  // Returns the instant of a fresh list, and no value if it is to be discarded.
  std::optional<GlobalTime> instant_of(std::size_t port, host::Input& input, GlobalTime now);
  bool take_odometry(const host::StepContext& context, const host::Input& input, GlobalTime measured);
  bool take_objects(const host::StepContext& context, std::size_t port, const host::Input& input, GlobalTime measured);
  void record(const host::StepContext& context, const host::Input& input, GlobalTime measured) const;
  void record_stop(const host::StepContext& context) const;
  void record_result(const host::StepContext& context) const;

  std::shared_ptr<FusionHost> host_;
  Duration round_;                                                // the schedule's round
  std::vector<std::optional<sensors::ObservationCodec>> codecs_;  // per port; none for odometry
  std::vector<RoundsBelieved> rounds_;                            // per port
  std::array<std::size_t, 4> odometry_{};                         // the signals of its element
  std::vector<ttf::fusion::sensors::Observation> observations_;
};

// Port `image`.
class ImageOutput final : public host::Step {
 public:
  ImageOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
              std::shared_ptr<FusionHost> host);
  void run(host::StepContext& context) override;

 private:
  const schedules::model::Cluster& cluster_;
  std::shared_ptr<FusionHost> host_;
  schedules::model::CycleInstant use_;  // the instant at which the feature service reads
  ImageSignals signals_;
  std::uint32_t sequence_ = 0;
  std::vector<ttf::fusion::tracks::TrackView> views_;
  std::vector<recording::records::ImageObject> objects_;
};

}  // namespace ttf::nodes::fusion
