#include "schedules/synthesis/solver/differences.h"

#include <algorithm>

#include "core/check.h"

namespace ttf::schedules::synthesis::solver {

Differences::Differences(const std::vector<Window>& windows)
    : count_(windows.size() + 1), most_(count_ * count_, 0), has_kept_(count_, 0) {
  const auto window = [&](std::size_t number) { return number == 0 ? Window{0, 0} : windows[number - 1]; };
  for (std::size_t from = 0; from < count_; ++from)
    for (std::size_t to = 0; to < count_; ++to)
      if (from != to) most_[from * count_ + to] = window(to).last - window(from).first;
}

bool Differences::add_most(std::size_t from, std::size_t to, Ticks most) {
  if (most >= most_[from * count_ + to]) return true;
  if (most < -most_[to * count_ + from]) return false;
  ++changes_;
  const Ticks* const behind = &most_[to * count_];
  for (std::size_t begin = 0; begin < count_; ++begin) {
    Ticks* const row = &most_[begin * count_];
    const Ticks reached = row[from] + most;
    if (reached >= row[to]) continue;
    keep(begin);
    for (std::size_t end = 0; end < count_; ++end) row[end] = std::min(row[end], reached + behind[end]);
  }
  return true;
}

void Differences::keep(std::size_t row) {
  if (marks_.empty() || has_kept_[row] != 0) return;
  has_kept_[row] = 1;
  kept_rows_.push_back(row);
  const auto begin = most_.begin() + static_cast<std::ptrdiff_t>(row * count_);
  kept_.insert(kept_.end(), begin, begin + static_cast<std::ptrdiff_t>(count_));
}

void Differences::mark() {
  marks_.push_back({kept_rows_.size(), kept_.size()});
  std::ranges::fill(has_kept_, 0);
}

void Differences::go_back() {
  TTF_CHECK(!marks_.empty(), "no mark is left of {} numbers", count_);
  const Mark mark = marks_.back();
  marks_.pop_back();
  while (kept_rows_.size() > mark.rows) {
    const auto row = kept_.end() - static_cast<std::ptrdiff_t>(count_);
    std::copy(row, kept_.end(), most_.begin() + static_cast<std::ptrdiff_t>(kept_rows_.back() * count_));
    kept_rows_.pop_back();
    kept_.resize(kept_.size() - count_);
  }
  std::ranges::fill(has_kept_, 0);  // a row kept twice for one mark is restored to the first
}

}  // namespace ttf::schedules::synthesis::solver
