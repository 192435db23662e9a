#include "cli/time_window.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace ttf::cli {
namespace {

constexpr double kLongest_s = 1e9;  // its nanoseconds fit the type with a wide margin

TrueTime at_seconds(const char* option, double s) {
  if (!(s <= kLongest_s))
    throw InputError({"command line", 0, option, fmt::format("{}", s), fmt::format("must be 0..{} s", kLongest_s)});
  return {s > 0.0 ? static_cast<std::int64_t>(s * 1e9 + 0.5) : 0};
}

}  // namespace

TimeWindow time_window(double from_s, double to_s) {
  TimeWindow window{at_seconds("--from", from_s), std::nullopt};
  if (to_s < 0.0) return window;
  window.to = at_seconds("--to", to_s);
  if (*window.to <= window.from)
    throw InputError({"command line", 0, "--to", fmt::format("{}", to_s), "must be after --from"});
  return window;
}

}  // namespace ttf::cli
