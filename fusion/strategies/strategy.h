// The three strategies that fuse lists which arrive late and out of order (paper, section II-B), behind one
// interface.
//
// BUFF  holds a list back until chronological order is certain: for every other sensor, a list that is not older has
//       arrived, or none can arrive any more (fusion/strategies/settling.h). Then it fuses in order. Instead it can
//       wait for the longest delay measured so far, or for a fixed lag (BuffWaiting); a list that comes still later
//       is late.
// ADVA  fuses lists as they come. A late list is taken in exactly: the tracker rewinds to the instant before it, takes
//       it in, and takes in all later lists again, associations included. The result is bit-identical to receiving
//       everything in order.
// TT    uses the schedule, which gives the instants of all measurements beforehand. A list waits only for scheduled
//       older measurements of other sensors that have not arrived and are not yet due. A measurement is due at the
//       first fusion instant at which the schedule has it arrived (fusion/strategies/settling.h).
//
// A list that is lost, torn, or of a dead sensor counts as absent. No strategy waits for it longer than the
// schedule allows, and the result is that of the arrived lists in order. A restarted sensor counts its lists
// anew, so number and instant together identify a list.
//
// A list that breaks the schedule may come after younger ones were fused. It is taken in as by ADVA and
// reported as late. Lists older than the history are dropped and reported. A list with a stamp from the future
// waits until that instant.
//
// Rewinding is the default. With TrackerConfig::late, ADVA takes late lists in by any method for single states,
// and TT by clones (fusion/strategies/late/late_updates.h), unless late_refusal() objects. BUFF has no late
// lists by design; for repairs it always rewinds. Order of lists: (measured, sensor, sequence).
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
#include "fusion/tracks/innovations.h"
#include "fusion/tracks/view.h"

namespace ttf::fusion::strategies {

// kCount is the number of strategies.
enum class StrategyKind : std::uint8_t { kBuff = 0, kAdva = 1, kTt = 2, kCount };
inline constexpr std::size_t kStrategyCount = static_cast<std::size_t>(StrategyKind::kCount);

// The knowledge by which a strategy is certain that no older list is to come.
enum class ReliesOn : std::uint8_t {
  kUnsaid,    // not stated; no strategy has it
  kNothing,   // it fuses without certainty
  kDelays,    // the longest delay of each sensor's lists
  kSchedule,  // the scheduled instants of measuring and of fusing
};
// The methods (TrackerConfig::late) by which a strategy can take late lists in.
enum class TakesLate : std::uint8_t {
  kUnsaid,         // not stated; no strategy has it
  kByRewinding,    // only rewinding, whatever the configuration says: by design no list is late
  kByClones,       // rewinding, or clones where the schedule states the instants
  kByEveryMethod,  // all methods
};

struct StrategyRow {
  StrategyKind kind{};
  std::string_view name;  // in files, options and logs
  ReliesOn relies_on{};
  TakesLate takes_late{};
};
// In the order of StrategyKind.
inline constexpr std::array<StrategyRow, kStrategyCount> kStrategies{{
    {StrategyKind::kBuff, "buff", ReliesOn::kDelays, TakesLate::kByRewinding},
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
// Returns the name, empty for any other value.
constexpr std::string_view name_of(StrategyKind kind) {
  return kind < StrategyKind::kCount ? row_of(kind).name : std::string_view{};
}
constexpr std::optional<StrategyKind> strategy_named(std::string_view name) {
  for (const StrategyRow& row : kStrategies)
    if (row.name == name) return row.kind;
  return std::nullopt;
}

// The schedule's knowledge of a sensor.
struct SensorTiming {
  SensorId sensor{};
  Settling settling;       // when its measurements have arrived at the latest
  bool scheduled = false;  // the instants below are known beforehand
  GlobalTime first{};
  Duration period{};
  bool measures_ranges = false;  // range, bearing and range rate; else positions
};

enum class Disposition : std::uint8_t { kFused = 1, kFusedLate = 2, kHeld = 3, kDroppedTooOld = 4, kDuplicate = 5 };
struct FusedList {
  MeasurementId id;
  GlobalTime measured{};
  Disposition disposition = Disposition::kFused;
  tracks::Innovations innovations{};  // a fused list has them
};

// The most lists that can wait; one more fuses the oldest at once.
inline constexpr std::size_t kMaxPending = 32;
// The most lists between two fusion instants whose dispositions are certain to be listed. An accept() decides
// at most one list, a duplicate or the oldest waiting one; the fusion instant decides the waiting ones. With
// more accepted lists, the first kMaxListedArrivals are listed and the others counted.
inline constexpr std::size_t kMaxListedArrivals = 64;

class Strategy {
 public:
  virtual ~Strategy() = default;
  // Takes a list from the controller, as a copy; fuses nothing yet.
  virtual void accept(const sensors::ObservationList& list) = 0;
  // Fuses all lists that may be fused at the fusion instant `now`.
  virtual void fuse(GlobalTime now) = 0;
  // Returns the first instant after the last fusion instant from which a held list may be fused though no other
  // list arrives. Without a held list there is no value.
  virtual std::optional<GlobalTime> next_release() const = 0;
  // Returns the dispositions since the fusion instant before the last one, held lists included.
  virtual std::span<const FusedList> last_fused() const = 0;
  // Returns the number of dispositions since construction that last_fused() had no room for
  // (kMaxListedArrivals).
  virtual std::uint64_t unlisted() const = 0;
  // Writes the confirmed tracks, predicted to `at`, into `out`, which keeps its capacity; leaves out tracks
  // that are given up by then (fusion/tracks/track.h). Never changes the filter's state. If `at` is before the
  // newest measurement, the tracks are of that measurement's instant.
  virtual void image(GlobalTime at, std::vector<tracks::TrackView>& out) const = 0;
  // Returns the confirmed tracks at the instant of the newest fused measurement, without those given up by the
  // last fuse().
  virtual std::span<const tracks::TrackView> tracks() const = 0;
  // Returns the newest fused measurement of each sensor that has one; newest_measured() is the newest instant
  // of all.
  virtual std::span<const MeasurementId> newest() const = 0;
  virtual GlobalTime newest_measured() const = 0;
  virtual int confirmed_count() const = 0;
  virtual int tentative_count() const = 0;
};

// Returns why a strategy cannot use this method for late lists, empty if it can. The text is the required value
// of TrackerConfig::late, in the words of a Finding.
std::string late_refusal(StrategyKind kind, oosm::Kind late, std::span<const SensorTiming> sensors);

std::unique_ptr<Strategy> make_strategy(StrategyKind kind, const config::TrackerConfig& config,
                                        std::span<const SensorTiming> sensors);

}  // namespace ttf::fusion::strategies
