#include "recording/replay/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/counted.h"
#include "core/decimal.h"

namespace ttf::recording::replay {
namespace {

using fusion::config::Birth;
using fusion::config::TrackerConfig;

std::string seconds(Duration duration) { return scaled_text(duration.ns, 1'000'000'000) + " s"; }

struct Facts {
  const TrackerConfig& tracker;
  RowCounts counts;
  std::uint64_t bearings = 0, beyond_a_turn = 0;
  std::uint64_t lists = 0, observations = 0, used = 0, too_old = 0, duplicates = 0;
  Duration longest_delay{};
  std::uint64_t gaps = 0, longer_than_delete_after = 0;  // between successive instants of measuring
  Duration middle_gap{};
  bool made_nothing = false;

  std::uint64_t rows() const { return counts.sound + counts.damaged; }
};

bool most(std::uint64_t part, std::uint64_t whole) { return 2 * part > whole; }

void note_gaps(const RecordedLists& recorded, Facts& facts) {
  std::vector<GlobalTime> instants;
  for (const RecordedList& list : recorded.lists) instants.push_back(list.measured);
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  std::vector<Duration> gaps;
  for (std::size_t i = 1; i < instants.size(); ++i) gaps.push_back(instants[i] - instants[i - 1]);
  if (gaps.empty()) return;
  facts.gaps = gaps.size();
  facts.longer_than_delete_after = static_cast<std::uint64_t>(
      std::count_if(gaps.begin(), gaps.end(), [&](Duration gap) { return gap > facts.tracker.delete_after; }));
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  facts.middle_gap = *middle;
}

// Each cause returns its sentence, or nothing where it does not apply.
std::string damaged_rows(const Facts& facts) {
  if (!most(facts.counts.damaged, facts.rows())) return "";
  return fmt::format("{} of {} were damaged and left out", facts.counts.damaged, counted(facts.rows(), "row"));
}

std::string too_old(const Facts& facts) {
  if (!most(facts.too_old, facts.lists - facts.duplicates)) return "";
  return fmt::format(
      "{} of {} were dropped as too old: a list is taken in up to {} lists back (history_scans), and the longest delay "
      "is {}",
      facts.too_old, counted(facts.lists - facts.duplicates, "list"), facts.tracker.history_scans,
      seconds(facts.longest_delay));
}

std::string too_few(const Facts& facts) {
  if (!facts.made_nothing || facts.tracker.birth != Birth::kMOfN ||
      facts.used >= static_cast<std::uint64_t>(facts.tracker.confirm_hits))
    return "";
  return fmt::format("{} used, and a track is confirmed by {} hits (confirm_hits)",
                     facts.used == 1 ? "1 list was" : fmt::format("{} lists were", facts.used),
                     facts.tracker.confirm_hits);
}

std::string long_gaps(const Facts& facts) {
  if (!facts.made_nothing || !most(facts.longer_than_delete_after, facts.gaps)) return "";
  return fmt::format(
      "{} of {} between successive lists are longer than {}, after which a track without observation ends "
      "(delete_after); the middle gap is {}",
      facts.longer_than_delete_after, counted(facts.gaps, "gap"), seconds(facts.tracker.delete_after),
      seconds(facts.middle_gap));
}

// A new track whose velocity is unknown is nowhere after a long gap.
std::string uncertain_after_gaps(const Facts& facts) {
  const double reach = facts.tracker.initial_velocity_sigma * facts.middle_gap.seconds();
  if (!facts.made_nothing || facts.middle_gap > facts.tracker.delete_after ||
      facts.middle_gap <= facts.tracker.coast_after || reach <= facts.tracker.delete_position_sigma)
    return "";
  return fmt::format(
      "the middle gap between successive lists is {}: after it the position of a new track is uncertain by {:.3g} m "
      "(initial_velocity_sigma {:g} m/s), and a track ends above {:g} m (delete_position_sigma)",
      seconds(facts.middle_gap), reach, facts.tracker.initial_velocity_sigma, facts.tracker.delete_position_sigma);
}

std::string degrees(const Facts& facts) {
  if (!facts.made_nothing || !most(facts.beyond_a_turn, facts.bearings)) return "";
  return fmt::format("{} of {} are beyond a whole turn of 6.283 rad: they may be in degrees", facts.beyond_a_turn,
                     counted(facts.bearings, "bearing"));
}

std::string received_before(const Facts& facts) {
  if (!facts.made_nothing || !most(facts.duplicates, facts.lists)) return "";
  return fmt::format("{} of {} were heard before: they have the sensor and the time of another list", facts.duplicates,
                     counted(facts.lists, "list"));
}

// Where no other cause is known.
std::string never_confirmed(const Facts& facts) {
  if (!facts.made_nothing) return "";
  const std::string seen =
      fmt::format("{} in {} never", counted(facts.observations, "observation"), counted(facts.used, "used list"));
  if (facts.tracker.birth == Birth::kExistence)
    return fmt::format("{} gave a track the probability {:g} to exist (confirm_existence)", seen,
                       facts.tracker.confirm_existence);
  return fmt::format("{} hit one object {} times in {} lists (confirm_hits, confirm_window)", seen,
                     facts.tracker.confirm_hits, facts.tracker.confirm_window);
}

using Cause = std::string (*)(const Facts&);
constexpr Cause kCauses[] = {damaged_rows, too_old, too_few, degrees, long_gaps, uncertain_after_gaps, received_before};

}  // namespace

ReplayVerdict judge(const std::vector<recording::rows::ObservationRow>& rows, RowCounts counts,
                    const RecordedLists& recorded, const ReplaySetup& setup, const ReplayAccount& account) {
  Facts facts{setup.tracker, counts};
  for (const recording::rows::ObservationRow& row : rows) {
    if (row.kind == recording::rows::ObservationRow::Kind::kPosition) continue;
    ++facts.bearings;
    facts.beyond_a_turn += std::abs(row.z[1]) > 2.0 * std::numbers::pi;
  }
  for (const SensorAccount& sensor : account.sensors) {
    facts.lists += sensor.lists;
    facts.observations += sensor.observations;
    facts.used += sensor.in_order + sensor.late;
    facts.too_old += sensor.too_old;
    facts.duplicates += sensor.duplicates;
    facts.longest_delay = std::max(facts.longest_delay, sensor.longest_delay);
  }
  note_gaps(recorded, facts);

  ReplayVerdict verdict;
  verdict.made_nothing = facts.made_nothing = account.tracks == 0;
  verdict.dropped_most =
      most(facts.counts.damaged, facts.rows()) || most(facts.too_old, facts.lists - facts.duplicates);
  if (verdict.did_its_work()) return verdict;
  verdict.headline = verdict.made_nothing ? fmt::format("no track came of {}", counted(facts.lists, "list"))
                                          : "most of the input was dropped";
  for (const Cause cause : kCauses)
    if (std::string sentence = cause(facts); !sentence.empty()) verdict.reasons.push_back(std::move(sentence));
  if (verdict.reasons.empty()) verdict.reasons.push_back(never_confirmed(facts));
  return verdict;
}

}  // namespace ttf::recording::replay
