#include "fusion/strategies/strategy.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/check.h"
#include "fusion/strategies/late/late_updates.h"
#include "fusion/strategies/scheduled_instants.h"
#include "fusion/tracks/timeline.h"
#include "fusion/tracks/track_history.h"

namespace ttf::fusion::strategies {
namespace {

constexpr GlobalTime kLongAgo{std::numeric_limits<std::int64_t>::min()};

// The common part of the three strategies: the waiting lists, the tracks with their history, and the account of
// dispositions. The strategies differ only in the waiting lists that they may fuse.
class HistoryStrategy : public Strategy {
 public:
  HistoryStrategy(const config::TrackerConfig& config, std::span<const SensorTiming> sensors,
                  std::unique_ptr<tracks::TrackHistory> history)
      : config_(config), sensors_(sensors.begin(), sensors.end()), history_(std::move(history)),
        estimator_(&history_->estimator()) {
    pending_.reserve(kMaxPending);
    for (std::size_t i = 0; i < kMaxPending; ++i) {
      pending_.emplace_back(config.max_observations);
      free_.push_back(kMaxPending - 1 - i);
    }
    waiting_.reserve(kMaxPending);
    seen_.resize(kMaxPending);
    between_.reserve(kMaxListedArrivals);
    report_.reserve(kMaxListedArrivals + kMaxPending);
    views_.reserve(static_cast<std::size_t>(config.max_objects));
    newest_.reserve(sensors_.size());
    newest_stamps_.reserve(sensors_.size());
    newest_received_.resize(sensors_.size());
    any_received_.resize(sensors_.size());
    longest_delay_.resize(sensors_.size());
    for (const SensorTiming& s : sensors_)
      TTF_CHECK(!s.scheduled || s.period.ns > 0, "sensor {}: period of {} ns", index_of(s.sensor), s.period.ns);
  }

  void accept(const sensors::ObservationList& list) final {
    const bool waiting = std::any_of(waiting_.begin(), waiting_.end(), [&](std::size_t w) {
      return pending_[w].id == list.id && pending_[w].measured == list.measured;
    });
    if (waiting || history_->contains(list.id, list.measured)) {
      note_between({list.id, list.measured, Disposition::kDuplicate});
      return;
    }
    if (free_.empty()) {
      // The room is full: the oldest list is fused now, and still older ones will be late.
      tracks();
      const std::size_t oldest = waiting_.front();
      waiting_.erase(waiting_.begin());
      note_between(take(pending_[oldest]));
      free_.push_back(oldest);
    }
    const std::size_t slot = free_.back();
    free_.pop_back();
    pending_[slot].assign(list);
    seen_[slot] = 0;
    const auto place = std::find_if(waiting_.begin(), waiting_.end(), [&](std::size_t w) {
      return tracks::before(list.id, list.measured, pending_[w].id, pending_[w].measured);
    });
    waiting_.insert(place, slot);
  }

  void fuse(GlobalTime now) final {
    report_.assign(between_.begin(), between_.end());
    between_.clear();
    now_ = now;
    // A list with a stamp from the future does not count as received: it says nothing about its sensor.
    for (const std::size_t slot : waiting_)
      if (pending_[slot].measured <= now && !std::exchange(seen_[slot], 1)) receive(pending_[slot]);
    std::size_t kept = 0;
    bool blocked = false;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      const std::size_t slot = waiting_[i];
      tracks::StoredList& list = pending_[slot];
      // Goes in chronological order: a waiting list holds back all younger ones. A stamp from the future is
      // wrong; its fusion would make all later lists late.
      blocked = blocked || fuses_from(list) > now;
      if (blocked) {
        report_.push_back({list.id, list.measured, Disposition::kHeld});
        waiting_[kept++] = slot;
        continue;
      }
      report_.push_back(take(list));
      free_.push_back(slot);
    }
    waiting_.resize(kept);
    count();
  }

  std::optional<GlobalTime> next_release() const final {
    if (waiting_.empty()) return std::nullopt;
    return fuses_from(pending_[waiting_.front()]);
  }
  std::span<const FusedList> last_fused() const final { return report_; }
  std::uint64_t unlisted() const final { return unlisted_; }
  // Most callers want the image only, so that the views wait until they are asked for.
  std::span<const tracks::TrackView> tracks() const final {
    if (!viewed_) {
      const tracks::TrackSet& set = history_->current();
      for (const tracks::Track& track : set.tracks)
        if (track.confirmed && !given_up(track, set.time, now_, config_, *estimator_))
          views_.push_back(view_of(track, set.time, set.time, config_, *estimator_));
      viewed_ = true;
    }
    return views_;
  }
  std::span<const MeasurementId> newest() const final { return newest_; }
  GlobalTime newest_measured() const final { return history_->current().time; }
  int confirmed_count() const final { return confirmed_; }
  int tentative_count() const final { return tentative_; }

  void image(GlobalTime at, std::vector<tracks::TrackView>& out) const final {
    out.clear();
    const tracks::TrackSet& set = history_->current();
    for (const tracks::Track& track : set.tracks)
      if (track.confirmed && !given_up(track, set.time, at, config_, *estimator_))
        out.push_back(view_of(track, set.time, at, config_, *estimator_));
  }

 protected:
  // Returns the instant from which a list may be fused if no other list arrives; an instant in the past means
  // now.
  virtual GlobalTime may_fuse_from(const tracks::StoredList& list) const = 0;

  const config::TrackerConfig& config() const { return config_; }
  // Returns the longest delay of sensor s's lists, as measured at fusion instants.
  std::optional<Duration> longest_delay(std::size_t s) const { return longest_delay_[s]; }

  std::size_t sensor_count() const { return sensors_.size(); }
  const SensorTiming& sensor(std::size_t s) const { return sensors_[s]; }
  // Returns whether a list of sensor s that is not older than `instant` has arrived.
  bool arrived_since(std::size_t s, GlobalTime instant) const {
    return any_received_[s] && newest_received_[s] >= instant;
  }

 private:
  // Bounds the report: any number of lists may arrive between two fusion instants.
  void note_between(const FusedList& what) {
    if (between_.size() < kMaxListedArrivals)
      between_.push_back(what);
    else
      ++unlisted_;
  }

  GlobalTime fuses_from(const tracks::StoredList& list) const { return std::max(list.measured, may_fuse_from(list)); }

  void receive(const tracks::StoredList& list) {
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      if (sensors_[s].sensor != list.id.sensor) continue;
      newest_received_[s] = any_received_[s] ? std::max(newest_received_[s], list.measured) : list.measured;
      any_received_[s] = 1;
      longest_delay_[s] = std::max(longest_delay_[s].value_or(Duration{}), now_ - list.measured);
    }
  }

  // The history may exchange the list for another.
  FusedList take(tracks::StoredList& list) {
    FusedList result{list.id, list.measured, Disposition::kFused};
    switch (history_->exchange(list)) {
      case tracks::TrackHistory::Insertion::kInOrder: break;
      case tracks::TrackHistory::Insertion::kLate: result.disposition = Disposition::kFusedLate; break;
      case tracks::TrackHistory::Insertion::kTooOld: result.disposition = Disposition::kDroppedTooOld; return result;
    }
    result.innovations = history_->innovations();
    const auto known = std::find_if(newest_.begin(), newest_.end(),
                                    [&](const MeasurementId& id) { return id.sensor == result.id.sensor; });
    if (known == newest_.end()) {
      newest_.push_back(result.id);
      newest_stamps_.push_back(result.measured);
    } else if (GlobalTime& stamp = newest_stamps_[static_cast<std::size_t>(known - newest_.begin())];
               result.measured > stamp) {
      *known = result.id;
      stamp = result.measured;
    }
    return result;
  }

  void count() {
    views_.clear();
    viewed_ = false;
    confirmed_ = tentative_ = 0;
    const tracks::TrackSet& set = history_->current();
    for (const tracks::Track& track : set.tracks)
      if (!given_up(track, set.time, now_, config_, *estimator_)) ++(track.confirmed ? confirmed_ : tentative_);
  }

  config::TrackerConfig config_;
  std::vector<SensorTiming> sensors_;
  std::unique_ptr<tracks::TrackHistory> history_;
  const estimators::Estimator* estimator_;   // the history's
  std::vector<tracks::StoredList> pending_;  // storage
  std::vector<std::size_t> free_, waiting_;  // waiting: chronological
  std::vector<char> seen_;                   // by slot: a fusion instant has seen the list
  std::vector<FusedList> report_, between_;  // between_: since the last fusion instant
  std::uint64_t unlisted_ = 0;
  mutable std::vector<tracks::TrackView> views_;  // at the last fusion instant, once viewed_
  mutable bool viewed_ = true;
  int confirmed_ = 0, tentative_ = 0;
  std::vector<MeasurementId> newest_;
  std::vector<GlobalTime> newest_stamps_;  // of newest_
  std::vector<GlobalTime> newest_received_;
  std::vector<char> any_received_;
  std::vector<std::optional<Duration>> longest_delay_;
  GlobalTime now_{};
};

class Buff final : public HistoryStrategy {
  using HistoryStrategy::HistoryStrategy;

 private:
  GlobalTime may_fuse_from(const tracks::StoredList& list) const override {
    if (config().buff_waits == config::BuffWaiting::kFixedLag) return list.measured + config().fixed_lag;
    GlobalTime from = kLongAgo;
    for (std::size_t s = 0; s < sensor_count(); ++s)
      if (sensor(s).sensor != list.id.sensor && !arrived_since(s, list.measured))
        from = std::max(from, settled_from(s, list.measured));
    return from;
  }

  // Returns when all measurements of sensor s until `instant` have arrived or never will.
  GlobalTime settled_from(std::size_t s, GlobalTime instant) const {
    const auto longest = longest_delay(s);
    const bool by_measured = config().buff_waits == config::BuffWaiting::kMeasured && longest;
    return by_measured ? instant + *longest : sensor(s).settling.settled_from(instant);
  }
};

class Adva final : public HistoryStrategy {
  using HistoryStrategy::HistoryStrategy;

 private:
  GlobalTime may_fuse_from(const tracks::StoredList&) const override { return kLongAgo; }
};

class TimeTriggered final : public HistoryStrategy {
  using HistoryStrategy::HistoryStrategy;

 private:
  GlobalTime may_fuse_from(const tracks::StoredList& list) const override {
    const GlobalTime mine = scheduled_instant(list);
    GlobalTime from = kLongAgo;
    for (std::size_t s = 0; s < sensor_count(); ++s) {
      const SensorTiming& other = sensor(s);
      if (other.sensor == list.id.sensor || !other.scheduled || mine < other.first) continue;
      // The other sensor's newest instant that is not after this measurement's.
      const ScheduledInstants instants = instants_of(other);
      const GlobalTime instant = instants.newest_at(mine);
      if (!arrived_since(s, instant - instants.tolerance()))
        from = std::max(from, other.settling.settled_from(instant));
    }
    return from;
  }

  static ScheduledInstants instants_of(const SensorTiming& timing) { return {timing.first, timing.period}; }

  // Returns the list's instant on the schedule, or its own stamp if none matches. Two sensors that measure at
  // the same instant so wait for each other, whichever stamp is smaller.
  GlobalTime scheduled_instant(const tracks::StoredList& list) const {
    for (std::size_t s = 0; s < sensor_count(); ++s)
      if (sensor(s).sensor == list.id.sensor && sensor(s).scheduled)
        if (const std::optional<GlobalTime> instant = instants_of(sensor(s)).of(list.measured)) return *instant;
    return list.measured;
  }
};

using Maker = std::unique_ptr<Strategy> (*)(const config::TrackerConfig& config, std::span<const SensorTiming> sensors,
                                            std::unique_ptr<tracks::TrackHistory> history);
template <class Kind>
std::unique_ptr<Strategy> make(const config::TrackerConfig& config, std::span<const SensorTiming> sensors,
                               std::unique_ptr<tracks::TrackHistory> history) {
  return std::make_unique<Kind>(config, sensors, std::move(history));
}
// In the order of StrategyKind.
constexpr std::array<Maker, kStrategyCount> kMakers{make<Buff>, make<Adva>, make<TimeTriggered>};
static_assert(std::find(kMakers.begin(), kMakers.end(), nullptr) == kMakers.end(), "every strategy can be made");

}  // namespace

std::string late_refusal(StrategyKind kind, oosm::Kind late, std::span<const SensorTiming> sensors) {
  const TakesLate takes_late = row_of(kind).takes_late;
  if (takes_late == TakesLate::kByRewinding || late == oosm::Kind::kRewind) return {};
  if (takes_late == TakesLate::kByClones && late != oosm::Kind::kClone)
    return "must be rewind or clone with strategy " + std::string(name_of(kind));
  const bool scheduled =
      std::all_of(sensors.begin(), sensors.end(), [](const SensorTiming& sensor) { return sensor.scheduled; });
  if (late == oosm::Kind::kClone && !scheduled)
    return "must not be clone if a sensor measures freely: the schedule must state the instants beforehand";
  return {};
}

std::unique_ptr<Strategy> make_strategy(StrategyKind kind, const config::TrackerConfig& config,
                                        std::span<const SensorTiming> sensors) {
  const bool rewinds = row_of(kind).takes_late == TakesLate::kByRewinding || config.late == oosm::Kind::kRewind;
  const std::string refusal = late_refusal(kind, config.late, sensors);
  TTF_CHECK(refusal.empty(), "late {}", refusal);
  std::unique_ptr<tracks::TrackHistory> history;
  if (rewinds)
    history = std::make_unique<tracks::Timeline>(config, config.max_observations);
  else
    history = std::make_unique<late::LateUpdates>(config, config.max_observations, sensors);
  return kMakers[static_cast<std::size_t>(kind)](config, sensors, std::move(history));
}

}  // namespace ttf::fusion::strategies
