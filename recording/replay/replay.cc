#include "recording/replay/replay.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <set>

#include "core/check.h"

namespace ttf::recording::replay {
namespace {

// The classes of the configuration are those of the rows by their names. No row reports the others.
fusion::config::TrackerConfig with_ids_of(const std::vector<std::string>& classes,
                                          fusion::config::TrackerConfig config) {
  for (fusion::config::ClassPrior& prior : config.classes) {
    const auto found = std::find(classes.begin(), classes.end(), prior.name);
    prior.id = found == classes.end() ? fusion::sensors::kNoClass
                                      : static_cast<fusion::sensors::ClassId>(found - classes.begin());
  }
  return config;
}

class Replay {
 public:
  Replay(const RecordedLists& recorded, const ReplaySetup& setup, const TrackSink& sink)
      : recorded_(recorded), setup_(setup), sink_(sink),
        strategy_(fusion::strategies::make_strategy(setup.strategy, with_ids_of(recorded.classes, setup.tracker),
                                                    setup.timings)) {
    account_.sensors.resize(recorded.sensors.size());
  }

  ReplayAccount run() {
    for (const RecordedList& list : recorded_.lists) {
      while (const std::optional<GlobalTime> next = strategy_->next_release()) {
        if (*next >= list.arrival) break;
        fuse(*next);
      }
      receive(list);
    }
    while (const std::optional<GlobalTime> next = strategy_->next_release()) fuse(*next);
    TTF_CHECK(waiting_.empty() && strategy_->unlisted() == 0, "{} lists still wait, {} without a fate", waiting_.size(),
              strategy_->unlisted());
    account_.tracks = tracks_.size();
    return account_;
  }

 private:
  struct Waiting {
    MeasurementId id;
    GlobalTime measured{}, arrival{};
    bool held = false;
  };

  void receive(const RecordedList& list) {
    SensorAccount& account = account_.sensors[index_of(list.id.sensor)];
    ++account.lists;
    account.observations += list.observations.size();
    account.longest_delay = std::max(account.longest_delay, list.arrival - list.measured);
    waiting_.push_back({list.id, list.measured, list.arrival});
    strategy_->accept(list.view());
    fuse(list.arrival);
  }

  void fuse(GlobalTime now) {
    now_ = now;
    strategy_->fuse(now);
    bool taken_in = false;
    for (const fusion::strategies::FusedList& list : strategy_->last_fused()) {
      if (list.disposition == fusion::strategies::Disposition::kHeld)
        hold(list);
      else
        taken_in = settle(list) || taken_in;
    }
    if (taken_in) show();
  }

  void hold(const fusion::strategies::FusedList& list) {
    Waiting& waiting = *find(list);
    if (waiting.held) return;
    waiting.held = true;
    ++account_.sensors[index_of(list.id.sensor)].held;
  }

  // Returns whether the list is in the tracks now.
  bool settle(const fusion::strategies::FusedList& list) {
    SensorAccount& account = account_.sensors[index_of(list.id.sensor)];
    auto waiting = find(list);
    // If a list arrives again while the first copy waits, the later copy is the duplicate.
    if (list.disposition == fusion::strategies::Disposition::kDuplicate) waiting = std::prev(waiting_.end());
    account.longest_hold = std::max(account.longest_hold, now_ - waiting->arrival);
    waiting_.erase(waiting);
    switch (list.disposition) {
      case fusion::strategies::Disposition::kFused: ++account.in_order; return true;
      case fusion::strategies::Disposition::kFusedLate: ++account.late; return true;
      case fusion::strategies::Disposition::kDroppedTooOld: ++account.too_old; return false;
      case fusion::strategies::Disposition::kDuplicate: ++account.duplicates; return false;
      case fusion::strategies::Disposition::kHeld: break;
    }
    TTF_CHECK(false, "disposition {}", static_cast<int>(list.disposition));
  }

  std::vector<Waiting>::iterator find(const fusion::strategies::FusedList& list) {
    const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& one) {
      return one.id == list.id && one.measured == list.measured;
    });
    TTF_CHECK(found != waiting_.end(), "the fate of a list that does not wait");
    return found;
  }

  void show() {
    std::span<const fusion::tracks::TrackView> tracks = strategy_->tracks();
    if (setup_.predict) {
      strategy_->image(now_, image_);
      tracks = image_;
    }
    for (const fusion::tracks::TrackView& track : tracks) tracks_.insert(track.id);
    account_.rows += tracks.size();
    sink_(now_, tracks);
  }

  const RecordedLists& recorded_;
  const ReplaySetup& setup_;
  const TrackSink& sink_;
  std::unique_ptr<fusion::strategies::Strategy> strategy_;
  GlobalTime now_{};
  std::vector<Waiting> waiting_;  // accepted, without a fate yet
  std::vector<fusion::tracks::TrackView> image_;
  std::set<TrackId> tracks_;
  ReplayAccount account_;
};

}  // namespace

ReplayAccount replay(const RecordedLists& recorded, const ReplaySetup& setup, const TrackSink& sink) {
  return Replay(recorded, setup, sink).run();
}

recording::rows::TrackRow track_row_of(const fusion::tracks::TrackView& view, GlobalTime known,
                                       const std::vector<std::string>& classes) {
  recording::rows::TrackRow row;
  row.time_ns = view.valid_at.ns;
  row.known_ns = known.ns;
  row.track = static_cast<int>(index_of(view.id));
  row.x = view.state(0);
  row.y = view.state(1);
  row.vx = view.state(2);
  row.vy = view.state(3);
  std::size_t next = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j) row.covariance[next++] = view.covariance(i, j);
  row.heading = view.heading;
  row.sigma_heading = view.sigma_heading;
  if (view.has_length) row.length = view.length;
  if (view.has_width) row.width = view.width;
  const fusion::sensors::ThirdAxis& third = view.unfiltered.third;
  if (third.has_z) row.z = third.z;
  if (third.has_height) row.height = third.height;
  const fusion::sensors::ClassId best = view.unfiltered.classes.best();
  if (best != fusion::sensors::kNoClass) row.class_name = classes.at(static_cast<std::size_t>(best));
  row.class_share = view.unfiltered.classes.share();
  row.coasting = view.coasting;
  return row;
}

}  // namespace ttf::recording::replay
