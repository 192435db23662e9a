#include "fusion/metrics/track_life.h"

#include <algorithm>
#include <limits>

#include "core/check.h"

namespace ttf::fusion::metrics {

// Compares integers, so that 4 of 5 is 80 %.
Coverage ObjectLife::coverage() const {
  if (5 * tracked >= 4 * instants) return Coverage::kMostlyTracked;
  return 5 * tracked < instants ? Coverage::kMostlyLost : Coverage::kPartlyTracked;
}

ObjectLife& TrackLives::life_of(Identity object, TrueTime at) {
  const auto place = std::lower_bound(lives_.begin(), lives_.end(), object,
                                      [](const ObjectLife& life, Identity name) { return life.object < name; });
  if (place != lives_.end() && place->object == object) return *place;
  ObjectLife life;
  life.object = object;
  life.born = at;
  return *lives_.insert(place, life);
}

void TrackLives::step(TrueTime at, std::span<const Identity> objects, std::span<const Match> matches) {
  TTF_CHECK(!now_ || at > *now_, "{} ns after {} ns", at.ns, now_->ns);
  now_ = at;
  for (const Identity object : objects) {
    ObjectLife& life = life_of(object, at);
    TTF_CHECK(life.instants == 0 || life.last < at, "object {} listed twice at {} ns", object, at.ns);
    life.last = at;
    ++life.instants;
    ++life.missed_in_a_row;  // a match resets it
  }
  for (const Match& match : matches) {
    ObjectLife& life = life_of(match.object, at);
    TTF_CHECK(life.last == at && life.missed_in_a_row > 0, "object {} at {} ns matched twice, or not listed",
              match.object, at.ns);
    if (life.confirmed && life.missed_in_a_row > 1) ++life.fragmentations;
    if (!life.confirmed) life.confirmed = at;
    life.missed_in_a_row = 0;
    ++life.tracked;
    life.switches += match.switched;
  }
}

LifeSummary TrackLives::summary() const {
  LifeSummary all;
  all.objects = lives_.size();
  double fractions = 0.0, delays_s = 0.0;
  for (const ObjectLife& life : lives_) {
    switch (life.coverage()) {
      case Coverage::kMostlyTracked: ++all.mostly_tracked; break;
      case Coverage::kPartlyTracked: ++all.partly_tracked; break;
      case Coverage::kMostlyLost: ++all.mostly_lost; break;
    }
    all.fragmentations += life.fragmentations;
    all.switches += life.switches;
    all.lost += life.fragmentations + life.switches > 0;
    fractions += life.fraction_tracked();
    if (const auto delay = life.confirmed_after()) {
      ++all.confirmed;
      delays_s += delay->seconds();
      all.worst_confirmed_after = std::max(all.worst_confirmed_after, *delay);
    }
  }
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  all.mean_fraction_tracked = all.objects == 0 ? kNothing : fractions / static_cast<double>(all.objects);
  all.mean_confirmed_after_s = all.confirmed == 0 ? kNothing : delays_s / static_cast<double>(all.confirmed);
  return all;
}

}  // namespace ttf::fusion::metrics
