// The rules that forbid offsets in the search tree. Each returns the whole interval around the offset that it forbids.
#include <algorithm>
#include <functional>
#include <numeric>

#include "schedules/synthesis/checker.h"
#include "schedules/synthesis/solver/tree.h"

namespace ttf::schedules::synthesis::solver {
namespace {

constexpr std::size_t kUnplaced = std::numeric_limits<std::size_t>::max();

}  // namespace

void Tree::blame_for(std::size_t activity, Blame& blame) const {
  const std::size_t level = level_[activity];
  if (level != kUnplaced) blame[level / 64] |= std::uint64_t{1} << (level % 64);
}

void Tree::blame_chain(std::size_t chain, std::size_t but, Blame& blame) const {
  for (const std::size_t activity : model_.problem.chains[chain].activities)
    if (activity != but) blame_for(activity, blame);
}

bool Tree::forbidden(std::size_t activity, Ticks offset, bool upwards, Interval& interval, Blame& blame) const {
  if (by_distance(activity, offset, interval, blame) || by_resource(activity, offset, upwards, interval, blame))
    return true;
  bool found = false;
  offsets_[activity] = offset;
  for (const Membership& membership : model_.memberships[activity])
    if ((found = by_chain(membership, offset, interval, blame))) break;
  return found || by_sum(activity, offset, interval, blame) || by_span(activity, offset, interval, blame);
}

bool Tree::by_distance(std::size_t activity, Ticks offset, Interval& interval, Blame& blame) const {
  for (const Distance& distance : model_.distances[activity]) {
    if (level_[distance.other] == kUnplaced) continue;
    const Ticks first = offsets_[distance.other] + distance.least, last = offsets_[distance.other] + distance.most;
    if (offset >= first && offset <= last) continue;
    blame_for(distance.other, blame);
    interval = offset < first ? Interval{-kNoLimit, first - 1} : Interval{last + 1, kNoLimit};
    return true;
  }
  return false;
}

// Two activities overlap if the second begins -duration + 1..duration - 1 behind the first, modulo the common divisor. Leaps on over
// what others forbid next, as often as it helps.
bool Tree::by_resource(std::size_t activity, Ticks offset, bool upwards, Interval& interval, Blame& blame) const {
  const Activity& own = model_.problem.activities[activity];
  if (!own.resource || own.duration == 0) return false;
  const std::vector<std::size_t>& others = on_resource_[*own.resource];
  Ticks at = offset;
  const Window& window = model_.windows[activity];
  std::size_t free = 0;  // so many in a row do not forbid `at`
  for (std::size_t next = 0; free < others.size() && at >= window.first && at <= window.last;
       next = (next + 1) % others.size()) {
    const std::size_t other = others[next];
    if (!share_a_lane(own, model_.problem.activities[other])) {
      ++free;
      continue;
    }
    const Activity& standing = model_.problem.activities[other];
    const Ticks common = standing.turn > 0 ? meeting_time(own, standing) : model_.common(activity, other);
    const Ticks duration = standing.duration;
    Ticks behind = modulo(at - offsets_[other], common);
    if (behind >= duration && behind <= common - own.duration) {
      ++free;
      continue;
    }
    blame_for(other, blame);
    free = 0;
    if (own.duration + duration > common) {
      interval = {-kNoLimit, kNoLimit};
      return true;
    }
    if (behind > common - own.duration) behind -= common;
    at = upwards ? model_.on_grid_from(activity, at - behind + duration)
                 : model_.on_grid_to(activity, at - behind - own.duration);
  }
  if (at == offset) return false;
  interval = upwards ? Interval{offset, at - 1} : Interval{at + 1, offset};
  return true;
}

// The least age of a chain, from activities that are placed or on trial. Rests beside what is not placed are known by their sum, modulo
// the common divisor of their moduli. From the end backwards, instances are followed as long as all is known (model.h: x_j).
Ticks Tree::least_age(std::size_t chain) const {
  const auto& along = model_.problem.chains[chain].activities;
  const ChainTerms& terms = model_.chains[chain];
  const auto known = [&](std::size_t at) { return level_[along[at]] != kUnplaced; };
  const auto period = [&](std::size_t at) { return model_.problem.activities[along[at]].period; };
  const std::size_t last = along.size() - 1;
  bool all = known(last), followed = all, any = all;
  Ticks least = terms.base, begin = offsets_[along[last]], ready = 0;
  Ticks modulus = 0, since = 0;  // the gap's rests count modulo both
  for (std::size_t at = last; at-- > 0;) {
    all &= known(at);
    followed &= terms.stride[at] > 0;
    ready += terms.ready[at];
    const Ticks own = followed ? std::min(terms.stride[at + 1], period(at)) : terms.modulus[at];
    // An instance that is followed between others is the one that is read: the rests before and behind it are one.
    const bool between = followed && at + 1 < last && !known(at + 1) && terms.stride[at + 1] > period(at + 1);
    if (!between) modulus = std::gcd(modulus, since);
    since = own;
    if (!known(at)) continue;
    const Ticks rest = any ? modulo(begin - ready - offsets_[along[at]], std::gcd(modulus, since)) : 0;
    least += rest;
    followed &= terms.stride[at] == period(at) || known(at + 1);
    begin = !followed || terms.stride[at] == period(at) ? offsets_[along[at]] : begin - rest - ready;
    any = true;
    ready = modulus = since = 0;
  }
  if (all && !terms.harmonic) least = std::max(least, age(model_.problem, model_.problem.chains[chain], {offsets_}));
  return least;
}

// The distance from the nearest activity before or behind a place in a chain that is placed: its rests' sum, and their modulus.
Tree::Rest Tree::rest_beside(const Membership& membership, Ticks offset, bool before) const {
  const auto& along = model_.problem.chains[membership.chain].activities;
  const ChainTerms& terms = model_.chains[membership.chain];
  Ticks ready = 0, modulus = 0;
  for (std::size_t at = membership.at; before ? at > 0 : at + 1 < along.size();) {
    const std::size_t link = before ? --at : at++;
    ready += terms.ready[link];
    modulus = std::gcd(modulus, terms.modulus[link]);
    if (level_[along[at]] == kUnplaced) continue;
    const Ticks distance = before ? offset - offsets_[along[at]] : offsets_[along[at]] - offset;
    return {modulo(distance - ready, modulus), modulus};
  }
  return {};
}

// How far off a weighted sum of ages may come within its limit. Upwards, a rest before the activity grows until it falls to 0, and
// a rest behind it falls until it grows to its most. Between such points the sum is linear.
Tree::Interval Tree::leap(std::size_t activity, Ticks offset, Ticks excess, std::span<const std::size_t> chains,
                          std::span<const Ticks> weights) const {
  Ticks up = kNoLimit, down = kNoLimit, slope = 0;
  for (const Membership& membership : model_.memberships[activity]) {
    const auto found = std::ranges::find(chains, membership.chain);
    if (found == chains.end()) continue;
    const Ticks weight = weights[static_cast<std::size_t>(found - chains.begin())];
    if (const Rest rest = rest_beside(membership, offset, true); rest.modulus > 0) {
      up = std::min(up, rest.modulus - rest.ticks);
      down = std::min(down, rest.ticks + 1);
      slope += weight;
    }
    if (const Rest rest = rest_beside(membership, offset, false); rest.modulus > 0) {
      up = std::min(up, rest.ticks + 1);
      down = std::min(down, rest.modulus - rest.ticks);
      slope -= weight;
    }
    if (!model_.chains[membership.chain].harmonic) up = down = 1;
  }
  if (slope < 0) up = std::min(up, (excess - slope - 1) / -slope);
  if (slope > 0) down = std::min(down, (excess + slope - 1) / slope);
  return {offset - down + 1, offset + up - 1};
}

bool Tree::by_chain(const Membership& membership, Ticks offset, Interval& interval, Blame& blame) const {
  const ChainTerms& terms = model_.chains[membership.chain];
  if (terms.limit >= kNoLimit) return false;
  const auto& along = model_.problem.chains[membership.chain].activities;
  const std::size_t own = along[membership.at];
  level_[own] = order_.size();  // on trial
  Ticks least = least_age(membership.chain);
  if (least <= terms.limit) {
    level_[own] = kUnplaced;
    return false;
  }
  // An activity without which the chain is too old is not to blame; the latest are tried first.
  std::vector<std::pair<std::size_t, std::size_t>> members;  // level, activity
  for (const std::size_t activity : along)
    if (activity != own && level_[activity] != kUnplaced) members.emplace_back(level_[activity], activity);
  std::ranges::sort(members, std::greater<>());
  for (const auto& [level, activity] : members) {
    level_[activity] = kUnplaced;
    const Ticks without = least_age(membership.chain);
    if (without > terms.limit)
      least = without;
    else
      level_[activity] = level, blame_for(activity, blame);
  }
  level_[own] = kUnplaced;
  const Ticks weight = 1;
  interval = leap(own, offset, least - terms.limit, {&membership.chain, 1}, {&weight, 1});
  for (const auto& [level, activity] : members) level_[activity] = level;
  return true;
}

bool Tree::by_sum(std::size_t activity, Ticks offset, Interval& interval, Blame& blame) const {
  for (const std::size_t sum : model_.sums_of[activity]) {
    const SumLimit& limit = model_.sums[sum];
    level_[activity] = order_.size();
    Ticks total = 0;
    for (std::size_t at = 0; at < limit.chains.size(); ++at) total += limit.weights[at] * least_age(limit.chains[at]);
    level_[activity] = kUnplaced;
    if (total <= limit.most) continue;
    for (const std::size_t chain : limit.chains) blame_chain(chain, activity, blame);
    interval = leap(activity, offset, total - limit.most, limit.chains, limit.weights);
    return true;
  }
  return false;
}

bool Tree::by_span(std::size_t activity, Ticks offset, Interval& interval, Blame& blame) const {
  const Ticks duration = model_.problem.activities[activity].duration;
  for (const std::size_t span : model_.spans_of[activity]) {
    const SpanLimit& limit = model_.spans[span];
    for (const std::size_t other : limit.activities) {
      if (level_[other] == kUnplaced) continue;
      const Ticks first = offsets_[other] + model_.problem.activities[other].duration - limit.most;
      const Ticks last = offsets_[other] + limit.most - duration;
      if (offset >= first && offset <= last) continue;
      blame_for(other, blame);
      interval = offset < first ? Interval{-kNoLimit, first - 1} : Interval{last + 1, kNoLimit};
      return true;
    }
  }
  return false;
}

}  // namespace ttf::schedules::synthesis::solver
