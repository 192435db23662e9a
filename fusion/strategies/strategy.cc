#include "fusion/strategies/strategy.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/check.h"
#include "fusion/strategies/late/late_updates.h"
#include "fusion/strategies/scheduled_instants.h"
#include "fusion/tracks/timeline.h"
#include "fusion/tracks/track_history.h"

namespace ttf::fusion::strategies {
namespace {

constexpr GlobalTime kLongAgo{std::numeric_limits<std::int64_t>::min()};

// What the three share: the scans that wait, the tracks with their history, and the account of what happened. They
// differ in which waiting scan may be fused.
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

  void accept(const sensors::Scan& scan) final {
    const bool waiting = std::any_of(waiting_.begin(), waiting_.end(), [&](std::size_t w) {
      return pending_[w].id == scan.id && pending_[w].measured == scan.measured;
    });
    if (waiting || history_->contains(scan.id, scan.measured)) {
      note_between({scan.id, scan.measured, Disposition::kDuplicate});
      return;
    }
    if (free_.empty()) {
      // More waits than there is room for: the oldest waits no longer, what it overtakes is repaired as late.
      const std::size_t oldest = waiting_.front();
      waiting_.erase(waiting_.begin());
      note_between(take(pending_[oldest]));
      free_.push_back(oldest);
    }
    const std::size_t slot = free_.back();
    free_.pop_back();
    pending_[slot].assign(scan);
    seen_[slot] = 0;
    const auto place = std::find_if(waiting_.begin(), waiting_.end(), [&](std::size_t w) {
      return tracks::before(scan.id, scan.measured, pending_[w].id, pending_[w].measured);
    });
    waiting_.insert(place, slot);
  }

  void fuse(GlobalTime now) final {
    report_.assign(between_.begin(), between_.end());
    between_.clear();
    now_ = now;
    // A stamp from the future tells nothing of what else may still come from its sensor.
    for (const std::size_t slot : waiting_)
      if (pending_[slot].measured <= now && !std::exchange(seen_[slot], 1)) receive(pending_[slot]);
    std::size_t kept = 0;
    bool blocked = false;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      const std::size_t slot = waiting_[i];
      const tracks::StoredScan& scan = pending_[slot];
      // In chronological order: what must wait holds back all that is younger. A stamp from the future is
      // wrong, and would make everything after it late.
      blocked = blocked || fuses_from(scan) > now;
      if (blocked) {
        report_.push_back({scan.id, scan.measured, Disposition::kHeld});
        waiting_[kept++] = slot;
        continue;
      }
      report_.push_back(take(scan));
      free_.push_back(slot);
    }
    waiting_.resize(kept);
    show(now);
  }

  std::optional<GlobalTime> next_release() const final {
    if (waiting_.empty()) return std::nullopt;
    return fuses_from(pending_[waiting_.front()]);
  }
  std::span<const FusedScan> last_fused() const final { return report_; }
  std::uint64_t unlisted() const final { return unlisted_; }
  std::span<const tracks::TrackView> tracks() const final { return views_; }
  std::span<const MeasurementId> newest() const final { return newest_; }
  GlobalTime newest_measured() const final { return history_->current().time; }
  int confirmed_count() const final { return static_cast<int>(views_.size()); }
  int tentative_count() const final { return tentative_; }

  void image(GlobalTime at, std::vector<tracks::TrackView>& out) const final {
    out.clear();
    const tracks::TrackSet& set = history_->current();
    for (const tracks::Track& track : set.tracks)
      if (track.confirmed && !given_up(track, set.time, at, config_, *estimator_))
        out.push_back(view_of(track, set.time, at, config_, *estimator_));
  }

 protected:
  // From when on a scan may be fused if nothing more arrives; over, where it may be now.
  virtual GlobalTime may_fuse_from(const tracks::StoredScan& scan) const = 0;

  const config::TrackerConfig& config() const { return config_; }
  // The longest that a list of sensor s was on its way, as far as fusion instants tell.
  std::optional<Duration> longest_delay(std::size_t s) const { return longest_delay_[s]; }

  std::size_t sensor_count() const { return sensors_.size(); }
  const SensorTiming& sensor(std::size_t s) const { return sensors_[s]; }
  // A scan of sensor s that is not older than `instant` has arrived.
  bool arrived_since(std::size_t s, GlobalTime instant) const {
    return any_received_[s] && newest_received_[s] >= instant;
  }

 private:
  // How many scans arrive between two fusion instants is not ours to say.
  void note_between(const FusedScan& what) {
    if (between_.size() < kMaxListedArrivals)
      between_.push_back(what);
    else
      ++unlisted_;
  }

  GlobalTime fuses_from(const tracks::StoredScan& scan) const { return std::max(scan.measured, may_fuse_from(scan)); }

  void receive(const tracks::StoredScan& scan) {
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      if (sensors_[s].sensor != scan.id.sensor) continue;
      newest_received_[s] = any_received_[s] ? std::max(newest_received_[s], scan.measured) : scan.measured;
      any_received_[s] = 1;
      longest_delay_[s] = std::max(longest_delay_[s].value_or(Duration{}), now_ - scan.measured);
    }
  }

  FusedScan take(const tracks::StoredScan& scan) {
    Disposition disposition = Disposition::kFused;
    switch (history_->insert(scan.view())) {
      case tracks::TrackHistory::Insertion::kInOrder: break;
      case tracks::TrackHistory::Insertion::kLate: disposition = Disposition::kFusedLate; break;
      case tracks::TrackHistory::Insertion::kTooOld: disposition = Disposition::kDroppedTooOld; break;
    }
    const FusedScan result{scan.id, scan.measured, disposition};
    if (disposition == Disposition::kDroppedTooOld) return result;
    const auto known = std::find_if(newest_.begin(), newest_.end(),
                                    [&](const MeasurementId& id) { return id.sensor == scan.id.sensor; });
    if (known == newest_.end()) {
      newest_.push_back(scan.id);
      newest_stamps_.push_back(scan.measured);
    } else if (GlobalTime& stamp = newest_stamps_[static_cast<std::size_t>(known - newest_.begin())];
               scan.measured > stamp) {
      *known = scan.id;
      stamp = scan.measured;
    }
    return result;
  }

  void show(GlobalTime now) {
    views_.clear();
    tentative_ = 0;
    const tracks::TrackSet& set = history_->current();
    for (const tracks::Track& track : set.tracks) {
      if (given_up(track, set.time, now, config_, *estimator_)) continue;
      if (track.confirmed)
        views_.push_back(view_of(track, set.time, set.time, config_, *estimator_));
      else
        ++tentative_;
    }
  }

  config::TrackerConfig config_;
  std::vector<SensorTiming> sensors_;
  std::unique_ptr<tracks::TrackHistory> history_;
  const estimators::Estimator* estimator_;   // the history's
  std::vector<tracks::StoredScan> pending_;  // storage
  std::vector<std::size_t> free_, waiting_;  // waiting: chronological
  std::vector<char> seen_;                   // by a fusion instant, of those that wait
  std::vector<FusedScan> report_, between_;  // between_: what happened since the last fusion instant
  std::uint64_t unlisted_ = 0;
  std::vector<tracks::TrackView> views_;
  int tentative_ = 0;
  std::vector<MeasurementId> newest_;
  std::vector<GlobalTime> newest_stamps_;  // of these
  std::vector<GlobalTime> newest_received_;
  std::vector<char> any_received_;
  std::vector<std::optional<Duration>> longest_delay_;
  GlobalTime now_{};
};

class Buff final : public HistoryStrategy {
  using HistoryStrategy::HistoryStrategy;

 private:
  GlobalTime may_fuse_from(const tracks::StoredScan& scan) const override {
    if (config().buff_waits == config::BuffWaiting::kFixedLag) return scan.measured + config().fixed_lag;
    GlobalTime from = kLongAgo;
    for (std::size_t s = 0; s < sensor_count(); ++s)
      if (sensor(s).sensor != scan.id.sensor && !arrived_since(s, scan.measured))
        from = std::max(from, settled_from(s, scan.measured));
    return from;
  }

  // When all that sensor s measured until `instant` has arrived, or never will.
  GlobalTime settled_from(std::size_t s, GlobalTime instant) const {
    const auto longest = longest_delay(s);
    const bool by_measured = config().buff_waits == config::BuffWaiting::kMeasured && longest;
    return by_measured ? instant + *longest : sensor(s).settling.settled_from(instant);
  }
};

class Adva final : public HistoryStrategy {
  using HistoryStrategy::HistoryStrategy;

 private:
  GlobalTime may_fuse_from(const tracks::StoredScan&) const override { return kLongAgo; }
};

class TimeTriggered final : public HistoryStrategy {
  using HistoryStrategy::HistoryStrategy;

 private:
  GlobalTime may_fuse_from(const tracks::StoredScan& scan) const override {
    const GlobalTime mine = scheduled_instant(scan);
    GlobalTime from = kLongAgo;
    for (std::size_t s = 0; s < sensor_count(); ++s) {
      const SensorTiming& other = sensor(s);
      if (other.sensor == scan.id.sensor || !other.scheduled || mine < other.first) continue;
      // The other sensor's newest instant that is not after this measurement's.
      const ScheduledInstants instants = instants_of(other);
      const GlobalTime instant = instants.newest_at(mine);
      if (!arrived_since(s, instant - instants.tolerance()))
        from = std::max(from, other.settling.settled_from(instant));
    }
    return from;
  }

  static ScheduledInstants instants_of(const SensorTiming& timing) { return {timing.first, timing.period}; }

  // Instants are compared on the schedule, not by their stamps: two sensors that measure at the same instant
  // wait for each other whichever stamp happens to be smaller. A measurement that fits no instant stands for
  // itself.
  GlobalTime scheduled_instant(const tracks::StoredScan& scan) const {
    for (std::size_t s = 0; s < sensor_count(); ++s)
      if (sensor(s).sensor == scan.id.sensor && sensor(s).scheduled)
        if (const std::optional<GlobalTime> instant = instants_of(sensor(s)).of(scan.measured)) return *instant;
    return scan.measured;
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

std::string late_refusal(StrategyKind kind, oosm::Kind late, std::span<const SensorTiming> sensors,
                         bool only_positions) {
  const TakesLate takes_late = row_of(kind).takes_late;
  if (takes_late == TakesLate::kByGoingBack || late == oosm::Kind::kRewind) return {};
  if (takes_late == TakesLate::kByClones && late != oosm::Kind::kClone)
    return fmt::format("must be rewind or clone with strategy {}", name_of(kind));
  if (!only_positions)
    return "must be rewind where a sensor measures range and bearing: the other methods take positions";
  const bool scheduled =
      std::all_of(sensors.begin(), sensors.end(), [](const SensorTiming& sensor) { return sensor.scheduled; });
  if (late == oosm::Kind::kClone && !scheduled)
    return "must not be clone where a sensor measures freely: the schedule must know the instants beforehand";
  return {};
}

std::unique_ptr<Strategy> make_strategy(StrategyKind kind, const config::TrackerConfig& config,
                                        std::span<const SensorTiming> sensors) {
  const bool goes_back = row_of(kind).takes_late == TakesLate::kByGoingBack || config.late == oosm::Kind::kRewind;
  const std::string refusal = late_refusal(kind, config.late, sensors, true);
  TTF_CHECK(refusal.empty(), "late {}", refusal);
  std::unique_ptr<tracks::TrackHistory> history;
  if (goes_back)
    history = std::make_unique<tracks::Timeline>(config, config.max_observations);
  else
    history = std::make_unique<late::LateUpdates>(config, config.max_observations, sensors);
  return kMakers[static_cast<std::size_t>(kind)](config, sensors, std::move(history));
}

}  // namespace ttf::fusion::strategies
