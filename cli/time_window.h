// The window of a diagram or of a capture that is held against a schedule, as the command line gives it.
#pragma once

#include <optional>

#include "core/time.h"

namespace ttf::cli {

// True time; `to` is absent where the log's end, or a default length, is meant.
struct TimeWindow {
  TrueTime from{};
  std::optional<TrueTime> to;
};

// From seconds, negative where not given. Throws InputError for what is no time of a run (not a number, or beyond
// 30 years) and for a window that ends before it begins.
TimeWindow time_window(double from_s, double to_s);

}  // namespace ttf::cli
