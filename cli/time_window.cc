#include "cli/time_window.h"

#include <cstdint>

#include "cli/decimal_option.h"
#include "core/errors.h"

namespace ttf::cli {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::int64_t kLongest_s = 1'000'000'000;  // its nanoseconds fit the type with a wide margin

std::optional<TrueTime> at_seconds(const char* option, const std::optional<std::string>& text) {
  if (!text) return std::nullopt;
  return TrueTime{decimal_option(option, *text, kNsPerSecond, {0, kLongest_s * kNsPerSecond}, " s")};
}

}  // namespace

std::pair<CLI::Option*, CLI::Option*> add_time_window(CLI::App& command, TimeWindowOptions& options,
                                                      const std::string& from_help, const std::string& to_help) {
  const auto add = [&](const char* name, std::optional<std::string>& text, const std::string& help) {
    return command.add_option(name, text, help)->type_name("SECONDS");
  };
  return {add("--from", options.from, from_help), add("--to", options.to, to_help)};
}

TimeWindow time_window(const TimeWindowOptions& options) {
  const TimeWindow window{at_seconds("--from", options.from), at_seconds("--to", options.to)};
  if (window.to && *window.to <= window.begin())
    throw InputError({"command line", 0, "--to", *options.to, "must be after --from"});
  return window;
}

}  // namespace ttf::cli
