#include "schedules/synthesis/solver/tree.h"

#include <algorithm>
#include <bit>

#include "core/random.h"

namespace ttf::schedules::synthesis::solver {
namespace {

constexpr std::size_t kNoLevel = std::numeric_limits<std::size_t>::max();

}  // namespace

Tree::Tree(const Model& model, std::vector<std::size_t> order, bool exhaustive, std::uint64_t seed)
    : model_(model), order_(std::move(order)), exhaustive_(exhaustive), seed_(seed), words_((order_.size() + 63) / 64),
      dead_ends_(order_.size(), 0), offsets_(order_.size(), 0), level_(order_.size(), kNoLevel),
      on_resource_(model.problem.resources.size()), cursors_(order_.size()), blames_(order_.size(), Blame(words_, 0)) {}

Tree::End Tree::run(std::int64_t most_nodes) {
  if (model_.contradictory) return End::kExhausted;
  if (order_.empty()) return End::kFound;
  std::size_t level = 0;
  most_nodes_ = most_nodes;
  cursors_[0] = cursor_for(order_[0]);
  for (;;) {
    if (place_next(level)) {
      if (++level == order_.size()) return End::kFound;
      if (++nodes_ >= most_nodes) return End::kGaveUp;
      cursors_[level] = cursor_for(order_[level]);
      std::ranges::fill(blames_[level], 0);
      continue;
    }
    ++dead_ends_[order_[level]];
    if (nodes_ >= most_nodes) return End::kGaveUp;
    const Blame blame = blames_[level];
    std::size_t back = words_;
    while (back > 0 && blame[back - 1] == 0) --back;
    if (back == 0) return End::kExhausted;  // nothing placed is to blame
    const std::size_t target = back * 64 - 1 - static_cast<std::size_t>(std::countl_zero(blame[back - 1]));
    while (level > target) unplace(--level);
    for (std::size_t word = 0; word < words_; ++word) blames_[target][word] |= blame[word];
    blames_[target][target / 64] &= ~(std::uint64_t{1} << (target % 64));
  }
}

// Begins beside a neighbour of a chain that is placed, so that data rests least there; else at the window's beginning.
Tree::Cursor Tree::cursor_for(std::size_t activity) const {
  const Window& window = model_.windows[activity];
  const Ticks period = model_.problem.activities[activity].period;
  Cursor cursor;
  Ticks start = window.first;
  for (const Membership& membership : model_.memberships[activity]) {
    const auto& along = model_.problem.chains[membership.chain].activities;
    const ChainTerms& terms = model_.chains[membership.chain];
    if (membership.at > 0 && level_[along[membership.at - 1]] != kNoLevel) {
      const Ticks ready = offsets_[along[membership.at - 1]] + terms.ready[membership.at - 1];
      start = window.first + modulo(ready - window.first, period);
      cursor.upwards = true;
      break;
    }
    if (membership.at + 1 < along.size() && level_[along[membership.at + 1]] != kNoLevel) {
      const Ticks latest = offsets_[along[membership.at + 1]] - terms.ready[membership.at];
      start = window.last - modulo(window.last - latest, period);
      cursor.upwards = false;
    }
  }
  if (start == window.first && seed_ != 0 && !model_.memberships[activity].empty()) {
    RandomStream draws({.seed = seed_, .purpose = Purpose::kSynthesis, .index = static_cast<std::uint32_t>(activity)});
    start += draws.integer(0, std::min(period, window.last - window.first + 1) - 1);
  }
  if (cursor.upwards) {
    start = std::clamp(start, window.first, window.last);
    cursor.runs[0] = {start, window.last};
    cursor.runs[1] = {window.first, start - 1};
    cursor.next = cursor.runs[0].first;
  } else {
    start = std::clamp(start, window.first, window.last);
    cursor.runs[0] = {window.first, start};
    cursor.runs[1] = {start + 1, window.last};
    cursor.next = cursor.runs[0].last;
  }
  return cursor;
}

bool Tree::place_next(std::size_t level) {
  const std::size_t activity = order_[level];
  Cursor& cursor = cursors_[level];
  const Ticks stride = exhaustive_ ? 1 : std::max<Ticks>(1, model_.problem.activities[activity].duration);
  Interval interval{};
  while (cursor.run < 2) {
    const Interval& run = cursor.runs[cursor.run];
    const Ticks at =
        cursor.upwards ? model_.on_grid_from(activity, cursor.next) : model_.on_grid_to(activity, cursor.next);
    if (at < run.first || at > run.last) {
      if (++cursor.run < 2) cursor.next = cursor.upwards ? cursor.runs[1].first : cursor.runs[1].last;
    } else if (forbidden(activity, at, cursor.upwards, interval, blames_[level])) {
      cursor.next = cursor.upwards ? interval.last + 1 : interval.first - 1;
      if (++leaps_ % kLeapsOfAStep == 0 && ++nodes_ >= most_nodes_) return false;
    } else {
      cursor.next = cursor.upwards ? at + stride : at - stride;
      place(level, at);
      return true;
    }
  }
  return false;
}

void Tree::place(std::size_t level, Ticks offset) {
  const std::size_t activity = order_[level];
  offsets_[activity] = offset;
  level_[activity] = level;
  const Activity& placed = model_.problem.activities[activity];
  if (placed.resource && placed.duration > 0) on_resource_[*placed.resource].push_back(activity);
}

void Tree::unplace(std::size_t level) {
  const std::size_t activity = order_[level];
  level_[activity] = kNoLevel;
  const Activity& placed = model_.problem.activities[activity];
  if (placed.resource && placed.duration > 0) on_resource_[*placed.resource].pop_back();
}

}  // namespace ttf::schedules::synthesis::solver
