// The three ways to fuse observations that arrive late and out of order (paper, section II-B), behind one
// interface.
//
// BUFF  keeps a scan back until chronological order is certain: for every other sensor, a scan that is not
//       older has arrived, or none can arrive any more (fusion/strategies/settling.h). Then fuses in order. Or until
//       the delays that were measured so far, or a fixed lag, say so (BuffWaiting): then what is later still is taken
//       in late.
// ADVA  takes scans as they come. One that is older than what is fused already is taken in exactly: the
//       tracker goes back to before it, takes it in, and takes in again what came after, associations
//       included. That is bit-identical to having received everything in order.
// TT    relies on the schedule: the instants of all measurements are known beforehand. A scan waits only for
//       scheduled older measurements of other sensors that have not arrived and are not yet due; one that
//       misses its due instant is not waited for: the first fusion instant at which the schedule has it
//       arrived (fusion/strategies/settling.h).
//
// A list that is lost, torn, or of a sensor that is dead was never there: no strategy waits for it longer than the
// schedule says it could still come, and what is fused is what in-order processing of the lists that did come gives. A
// sensor that restarts counts its lists anew: a list is known again by its number and its instant together.
//
// Whatever a strategy fused too early (a broken promise) is repaired as in ADVA and reported as late. Scans
// older than the history are dropped and reported; one with a stamp from the future waits until its time.
//
// Going back is the default; by TrackerConfig::late, ADVA takes late scans in by any method for single states, and TT
// by clones (fusion/strategies/late/late_updates.h), where late_refusal() has nothing against it. BUFF takes nothing
// late by design: what it must repair nevertheless it always goes back for.
// Order among scans: (measured, sensor, sequence).
//
// After construction nothing allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/ids.h"
#include "core/time.h"
#include "fusion/config/tracker_config.h"
#include "fusion/sensors/observation.h"
#include "fusion/strategies/settling.h"
#include "fusion/tracks/tracker.h"

namespace ttf::fusion::strategies {

// kCount is no strategy: it counts them.
enum class StrategyKind : std::uint8_t { kBuff = 0, kAdva = 1, kTt = 2, kCount };
inline constexpr std::size_t kStrategyCount = static_cast<std::size_t>(StrategyKind::kCount);

// What a strategy knows from that nothing older is to come.
enum class ReliesOn : std::uint8_t {
  kUnsaid,    // no strategy's
  kNothing,   // it does not ask
  kDelays,    // how long lists are on their way at most
  kSchedule,  // the instants of measuring and of fusing, which must be known beforehand
};
// How it can take late lists in, by TrackerConfig::late.
enum class TakesLate : std::uint8_t {
  kUnsaid,         // no strategy's
  kByGoingBack,    // always, whatever the configuration says: none is late by design
  kByClones,       // by going back, or by clones where the schedule knows the instants
  kByEveryMethod,  // there is
};

struct StrategyRow {
  StrategyKind kind{};
  std::string_view name;  // as files, options and logs give it
  ReliesOn relies_on{};
  TakesLate takes_late{};
};
// In the order of StrategyKind.
inline constexpr std::array<StrategyRow, kStrategyCount> kStrategies{{
    {StrategyKind::kBuff, "buff", ReliesOn::kDelays, TakesLate::kByGoingBack},
    {StrategyKind::kAdva, "adva", ReliesOn::kNothing, TakesLate::kByEveryMethod},
    {StrategyKind::kTt, "tt", ReliesOn::kSchedule, TakesLate::kByClones},
}};
inline constexpr std::array<StrategyKind, kStrategyCount> kAllStrategies = [] {
  std::array<StrategyKind, kStrategyCount> all{};
  for (std::size_t i = 0; i < kStrategyCount; ++i) all[i] = static_cast<StrategyKind>(i);
  return all;
}();
static_assert(std::equal(kStrategies.begin(), kStrategies.end(), kAllStrategies.begin(),
                         [](const StrategyRow& row, StrategyKind kind) {
                           return row.kind == kind && !row.name.empty() && row.relies_on != ReliesOn::kUnsaid &&
                                  row.takes_late != TakesLate::kUnsaid;
                         }),
              "every strategy has its row, in its place, and the row says all");
inline constexpr auto kStrategyNames = [] {
  std::array<std::pair<std::string_view, StrategyKind>, kStrategyCount> names{};
  for (std::size_t i = 0; i < kStrategyCount; ++i) names[i] = {kStrategies[i].name, kStrategies[i].kind};
  return names;
}();

constexpr const StrategyRow& row_of(StrategyKind kind) {
  TTF_CHECK(kind < StrategyKind::kCount, "strategy {}", static_cast<int>(kind));
  return kStrategies[static_cast<std::size_t>(kind)];
}
// Empty for what is no strategy.
constexpr std::string_view name_of(StrategyKind kind) {
  return kind < StrategyKind::kCount ? row_of(kind).name : std::string_view{};
}
constexpr std::optional<StrategyKind> strategy_named(std::string_view name) {
  for (const StrategyRow& row : kStrategies)
    if (row.name == name) return row.kind;
  return std::nullopt;
}

// What the schedule promises about a sensor.
struct SensorTiming {
  SensorId sensor{};
  Settling settling;       // when its measurements have arrived at the latest
  bool scheduled = false;  // the instants below are known beforehand
  GlobalTime first{};
  Duration period{};
};

enum class Disposition : std::uint8_t { kFused = 1, kFusedLate = 2, kHeld = 3, kDroppedTooOld = 4, kDuplicate = 5 };
struct FusedScan {
  MeasurementId id;
  GlobalTime measured{};
  Disposition disposition = Disposition::kFused;
};

// Most scans that can wait: of one more, the oldest is fused at once.
inline constexpr std::size_t kMaxPending = 32;
// Most scans accepted between two fusion instants whose fate is certain to be listed. An accept() settles at most one,
// a duplicate or the oldest that waits, and the fusion instant what waits then; of what accepting more settles, the
// first kMaxListedArrivals are listed and the rest is counted.
inline constexpr std::size_t kMaxListedArrivals = 64;

class Strategy {
 public:
  virtual ~Strategy() = default;
  // Takes a scan from the controller (copied). Fuses nothing yet.
  virtual void accept(const sensors::Scan& scan) = 0;
  // The fusion instant: fuses what may be fused at `now`.
  virtual void fuse(GlobalTime now) = 0;
  // The first instant after the last fusion instant from which a scan that is held may be fused though nothing arrives;
  // nothing where none is held.
  virtual std::optional<GlobalTime> next_release() const = 0;
  // What became of each scan at the last fusion instant or since the one before it, and which are held.
  virtual std::span<const FusedScan> last_fused() const = 0;
  // How many fates since construction last_fused() had no room for (kMaxListedArrivals).
  virtual std::uint64_t unlisted() const = 0;
  // Confirmed tracks predicted to `at`, into `out` (which keeps its capacity), without those that are given up by then
  // (fusion/tracks/track.h). Never touches the filter state; where `at` is before the newest measurement, the tracks
  // are shown as of that measurement.
  virtual void image(GlobalTime at, std::vector<tracks::TrackView>& out) const = 0;
  // Confirmed tracks at the instant of the newest fused measurement, without those that were given up by the last
  // fuse().
  virtual std::span<const tracks::TrackView> tracks() const = 0;
  // The newest fused measurement of each sensor that has one, and the newest of all.
  virtual std::span<const MeasurementId> newest() const = 0;
  virtual GlobalTime newest_measured() const = 0;
  virtual int confirmed_count() const = 0;
  virtual int tentative_count() const = 0;
};

// Why a strategy cannot take late scans in by that method: what TrackerConfig::late must be instead, in the words of a
// Finding; empty where it can. only_positions: no sensor measures anything but positions.
std::string late_refusal(StrategyKind kind, oosm::Kind late, std::span<const SensorTiming> sensors,
                         bool only_positions);

std::unique_ptr<Strategy> make_strategy(StrategyKind kind, const config::TrackerConfig& config,
                                        std::span<const SensorTiming> sensors);

}  // namespace ttf::fusion::strategies
