// The history of the taken measurements in the order of their stamps, oldest first: a ring of fixed capacity.
// Entry is a value with a member `stamp`.
#pragma once

#include <array>

#include "core/check.h"
#include "fusion/oosm/method.h"

namespace ttf::fusion::oosm {

template <class Entry, int Capacity> class History {
  static_assert(Capacity >= 2, "a start and one measurement");

 public:
  int size() const { return size_; }
  Entry& operator[](int i) { return entries_[place(i)]; }
  const Entry& operator[](int i) const { return entries_[place(i)]; }
  Entry& newest() { return (*this)[size_ - 1]; }
  const Entry& newest() const { return (*this)[size_ - 1]; }
  const Entry& oldest() const { return (*this)[0]; }

  void clear() { first_ = size_ = 0; }

  // Returns the number of entries that are not after `stamp`; searches from the newest on.
  int not_after(const Stamp& stamp) const {
    int n = size_;
    while (n > 0 && (*this)[n - 1].stamp > stamp) --n;
    return n;
  }

  // Makes room at place i, 0 < i <= size(), by moving younger entries; a full ring forgets its oldest. Returns
  // the place, i or i - 1, which still holds an old entry.
  int open(int i) {
    TTF_CHECK(i > 0 && i <= size_, "place {} of {}", i, size_);
    if (size_ == Capacity) {
      first_ = place(1);
      --size_;
      --i;
    }
    ++size_;
    for (int j = size_ - 1; j > i; --j) (*this)[j] = (*this)[j - 1];
    return i;
  }

  // Makes room behind the newest entry in the same way.
  Entry& append() {
    if (size_ == Capacity)
      first_ = place(1);
    else
      ++size_;
    return newest();
  }

 private:
  std::size_t place(int i) const {
    const int at = first_ + i;
    return static_cast<std::size_t>(at < Capacity ? at : at - Capacity);
  }

  std::array<Entry, Capacity> entries_{};
  int first_ = 0;
  int size_ = 0;
};

}  // namespace ttf::fusion::oosm
