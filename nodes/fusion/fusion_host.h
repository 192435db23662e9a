// The fusion node: decodes what its controller received, hands it to a strategy, and writes the real-time image.
//
// It knows only bytes from its controller, the schedule and its own clock. Its tasks share one FusionHost: `fusion` at
// every fusion instant, or one of them for each sensor's list whenever that arrives (BUFF and ADVA), `image_output`
// before the image's slots. The image is predicted to the instant at which the feature service will use it, which the
// schedule says beforehand; predicting never touches the filter state.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fusion/config/tracker_config.h"
#include "fusion/strategies/strategy.h"
#include "nodes/fusion/image_codec.h"
#include "nodes/host/step.h"
#include "nodes/sensing/observation_codec.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::fusion {

// What the schedule promises the strategy about each sensor (schedules/analysis/settled.h computes until when it is
// waited for).
std::vector<ttf::fusion::strategies::SensorTiming> sensor_timings(const schedules::model::Cluster& cluster);

// The tracker of a scenario, its sensors by their ids in this cluster. Throws InputError, naming the scenario's file,
// for a name that none of them has.
ttf::fusion::config::TrackerConfig tracker_in(const schedules::model::Cluster& cluster,
                                              ttf::fusion::config::TrackerConfig tracker,
                                              const std::string& scenario_file);

// `tracker`: as tracker_in() gives it.
struct FusionHost {
  FusionHost(const schedules::model::Cluster& cluster, ttf::fusion::strategies::StrategyKind kind,
             const ttf::fusion::config::TrackerConfig& tracker);
  std::unique_ptr<ttf::fusion::strategies::Strategy> strategy;
  std::vector<ttf::fusion::sensors::KnownSensor> sensors;  // by SensorId
  std::size_t most_objects;                                // confirmed tracks there can be
  std::size_t most_observations;                           // in one list
  std::uint32_t step = 0;                                  // numbered fusion instants, from 1
  std::uint64_t unlisted = 0;                              // of the strategy's, up to the last one
};

// Whether a list's age is known. Its stamp counts the rounds of the cycle counter as its sender does; the reader brings
// it to its own count by `rounds` (nodes/host/step.h). An old list, which a living gateway repeats for a dead sensor,
// would be brought as well, and seem new. So another count is believed only when two lists in a row have it: a repeated
// list has no second one.
class RoundsBelieved {
 public:
  // A list that was not heard before. Nodes that began together agree: 0.
  bool believed(std::int64_t rounds);

 private:
  std::int64_t rounds_ = 0;
  std::optional<std::int64_t> claimed_;
};

// Ports: one per sensor list, any number. A list whose age is not known is discarded.
class FusionStep final : public host::Step {
 public:
  FusionStep(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
             std::shared_ptr<FusionHost> host);
  void run(host::StepContext& context) override;

 private:
  void record(const host::StepContext& context, const host::Input& input, GlobalTime measured) const;
  void record_result(const host::StepContext& context) const;

  std::shared_ptr<FusionHost> host_;
  Duration round_;                                 // of the schedule
  std::vector<sensing::ObservationCodec> codecs_;  // per port
  std::vector<RoundsBelieved> rounds_;             // per port
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
  schedules::model::CycleInstant use_;  // when the feature service reads
  ImageSignals signals_;
  std::uint32_t sequence_ = 0;
  std::vector<ttf::fusion::tracks::TrackView> views_;
  std::vector<recording::records::ImageObject> objects_;
};

}  // namespace ttf::nodes::fusion
