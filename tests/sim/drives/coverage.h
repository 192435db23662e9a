// The track of each true object, at every use of an image.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fusion/metrics/object_pairs.h"
#include "schedules/analysis/ages.h"
#include "tests/sim/drives/drive_fixture.h"

namespace ttf::sim::drives {

inline constexpr double kGate_m = 1.5;  // an image object further from a true object is not of it

// From then on, an object visible from the start is confirmed in every used image. The time is a window of
// the slowest sensor's lists, after its first period, and the greatest age at use.
inline TrueTime confirmation_time(const Drive& drive) {
  Duration period{}, age{};
  for (const schedules::analysis::AgePath& path : schedules::analysis::measurement_ages(drive.cluster)) {
    const schedules::model::Sensor& sensor = drive.cluster.sensor(path.sensor);
    period = std::max(period, sensor.scheduled ? drive.cluster.cycle() * sensor.at.repetition : sensor.period);
    age = std::max({age, path.newest_worst, path.buffered_newest_worst});
  }
  return sim::engine::kFirstCycle + period * (1 + drive.scenario.tracker.confirm_window) + age;
}

// The track of each true object at every use: one to one, within the gate.
class Coverage final : public recording::records::Sink {
 public:
  struct Object {
    int uses = 0, shown = 0;
    std::set<TrackId> tracks;
    TrackId first{}, last{};
    TrueTime first_missed{};
  };
  explicit Coverage(TrueTime from) : from_(from) {}
  using recording::records::Sink::on;
  std::map<ObjectId, Object> objects;

  void on(const recording::records::FeatureUsed& used) override {
    judge();
    if (used.stamp.true_time >= from_) use_ = Use{used.stamp.true_time, {used.objects.begin(), used.objects.end()}};
  }
  void on(const recording::records::TruthState& truth) override {
    if (!truth_.empty() && truth_.front().at != truth.at) {
      judge();
      truth_.clear();
    }
    if (!truth_.empty() && truth_.front().node != truth.node) return;
    truth_.push_back(truth);
  }
  void finish() { judge(); }

 private:
  struct Use {
    TrueTime at;
    std::vector<recording::records::FeatureObject> objects;
  };
  // The truth of a use's instant comes before or after it.
  void judge() {
    if (!use_ || truth_.empty() || truth_.front().at != use_->at) return;
    std::vector<fusion::metrics::Point> truth, shown;
    for (const recording::records::TruthState& state : truth_) truth.push_back({state.x, state.y});
    for (const recording::records::FeatureObject& object : use_->objects)
      shown.push_back({object.image.x, object.image.y});
    std::vector<std::optional<TrackId>> track(truth.size());
    for (const fusion::metrics::ObjectPair& pair : fusion::metrics::object_pairs(truth, shown, kGate_m))
      track[pair.truth] = use_->objects[pair.estimate].image.track;
    for (std::size_t t = 0; t < truth.size(); ++t) {
      Object& object = objects[truth_[t].object];
      ++object.uses;
      if (track[t]) {
        ++object.shown;
        if (object.tracks.empty()) object.first = *track[t];
        object.last = *track[t];
        object.tracks.insert(*track[t]);
      } else if (object.first_missed == TrueTime{}) {
        object.first_missed = use_->at;
      }
    }
    use_.reset();
  }

  TrueTime from_;
  std::optional<Use> use_;
  std::vector<recording::records::TruthState> truth_;  // at one instant
};

}  // namespace ttf::sim::drives
