// Draws task sets, messages and chains as the automotive field has them: S. Kramer, D. Ziegenbein, A. Hamann, "Real
// world automotive benchmarks for free", WATERS 2015, tables III to VII.
//
// A period's share is that of its runnables (table III). Angle-synchronous ones, 15 %, are left out, and the other
// shares fill their place. The average execution time of a runnable is Weibull distributed above its period's least
// value, with the period's mean (table IV). Shape and scale follow from this mean and from P(X > largest) = 0.0005. A
// value beyond the largest is drawn again. The worst case is the average times a factor, uniform in its period's
// range (table V).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/random.h"

namespace ttf::schedules::timing {

// A runnable as a task of its own. Times are nanoseconds.
struct WatersTask {
  std::int64_t period = 0;
  std::int64_t average = 0;  // execution time
  std::int64_t worst = 0;    // at least the average; it may exceed the period
};

struct WatersMessage {
  std::int64_t period = 0;
  int data_bytes = 0;  // 0..8, uniform: the tables have no frames
};

// A row of the tables: one period. Execution times are microseconds.
struct WatersRow {
  std::int64_t period_ms = 0;
  int share_percent = 0;
  double least_us = 0, mean_us = 0, largest_us = 0;  // average execution times
  double least_factor = 0, largest_factor = 0;       // worst case / average
};
std::span<const WatersRow> waters_rows();

WatersTask draw_waters_task(RandomStream& stream);
WatersMessage draw_waters_message(RandomStream& stream);

// Draws tasks until the next would exceed a load (sum worst / period), or until there are `most`. `load` is above 0.
std::vector<WatersTask> draw_waters_tasks(RandomStream& stream, double load, std::size_t most);

// Draws a chain over tasks: places in `periods`, in the order of the data. It has one, two or three distinct periods
// (70, 20, 10 %), with 2 to 5 tasks each (30, 40, 20, 10 %; tables VI and VII), and no task twice. Returns nullopt if
// the drawn periods have too few tasks.
std::optional<std::vector<std::size_t>> draw_waters_chain(RandomStream& stream, std::span<const std::int64_t> periods);

}  // namespace ttf::schedules::timing
