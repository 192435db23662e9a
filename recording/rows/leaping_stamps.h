// Finds single stamps that leap: a clock or a hand has damaged them.
//
// Rows may stand in any order, so a stamp may go back. It leaps if the stamps above and below it are near each other,
// and it is near neither. Near is within a reach: a second, or 20 middle steps between
// successive stamps. In a shuffled file the middle step is long, and nothing leaps. A row has two stamps, of its
// measurement and its arrival. It leaps only if both do. Successive rows with the same stamps are one.
//
// The ends of a file that mostly ascends are judged, too. The first stamp leaps if it lies beyond all others, the last
// if it lies before all others. Fewer than 8 stamps give no order to judge by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ttf::recording::rows {

struct RowStamps {
  std::int64_t time = 0, arrival = 0;  // in one unit; less than 2^63 apart
};

struct Leap {
  std::size_t row = 0;
  std::int64_t above = 0, below = 0;  // times of the nearest rows that do not leap; at an end of the file the same
};

// Returns the rows that leap, in their order. `second` is a second in the stamps' unit. The other rows contain no leap.
// The time is linear in the rows. kMostPasses bounds it for files that are made to be slow.
inline constexpr int kMostPasses = 100;
std::vector<Leap> leaping_stamps(std::span<const RowStamps> rows, std::int64_t second);

}  // namespace ttf::recording::rows
