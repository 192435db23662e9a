// Connected components by union-find with path halving; the least node of each component is its root. The
// constructor allocates all storage.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/ids.h"

namespace ttf::fusion::association {

class Components {
 public:
  explicit Components(std::size_t most) : parent_(most) {}

  std::size_t capacity() const { return parent_.size(); }
  void reset(std::size_t nodes) { std::iota(parent_.begin(), parent_.begin() + static_cast<std::ptrdiff_t>(nodes), 0); }
  void join(int first, int second) {
    const int a = root(first), b = root(second);
    parent_[index_of(std::max(a, b))] = std::min(a, b);
  }
  int root(int node) {
    while (parent_[index_of(node)] != node) {
      int& parent = parent_[index_of(node)];
      parent = parent_[index_of(parent)];
      node = parent;
    }
    return node;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace ttf::fusion::association
