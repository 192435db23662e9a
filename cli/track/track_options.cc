#include "cli/track/track_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/drive/drive_setup.h"
#include "core/counted.h"
#include "core/decimal.h"
#include "core/errors.h"

namespace ttf::cli::track {
namespace {

using recording::replay::ReplayConfig;

[[noreturn]] void refuse_option(const char* option, const std::string& text, std::string expected) {
  throw InputError({"command line", 0, option, text, std::move(expected)});
}

// A parsed SENSOR=VALUE: the sensor's number, and the value.
struct OfSensor {
  std::size_t sensor;
  std::string value;
};

std::size_t sensor_named(const char* option, const std::string& text, const std::string& name,
                         const ReplayConfig& config) {
  std::vector<std::string> names;
  for (std::size_t s = 0; s < config.sensors.size(); ++s) {
    if (config.sensors[s].first == name) return s;
    names.push_back(config.sensors[s].first);
  }
  refuse_option(option, text, fmt::format("must begin with a sensor ({})", joined(names)));
}

OfSensor of_sensor(const char* option, const std::string& text, const ReplayConfig& config) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse_option(option, text, "must be SENSOR=VALUE");
  return {sensor_named(option, text, text.substr(0, equals), config), text.substr(equals + 1)};
}

Duration duration_option(const char* option, const std::string& text, std::string_view value, Range<Duration> allowed) {
  const std::optional<Duration> duration = parse_duration(value);
  if (!duration || !allowed.contains(*duration))
    refuse_option(option, text,
                  fmt::format("must be SENSOR= and {}..{} s with its unit, as in 40ms",
                              scaled_text(allowed.low.ns, 1'000'000'000), scaled_text(allowed.high.ns, 1'000'000'000)));
  return *duration;
}

void apply_noise(const std::string& text, ReplayConfig& config) {
  const char* option = "--noise";
  const std::size_t equals = text.find('='), colon = text.rfind(':', equals);
  if (equals == std::string::npos || colon == std::string::npos)
    refuse_option(option, text, "must be SENSOR:WHAT=SIGMA, as in radar:range=0.3");
  const std::size_t s = sensor_named(option, text, text.substr(0, colon), config);
  const std::string what = text.substr(colon + 1, equals - colon - 1);
  const recording::replay::NamedSigma sigma = recording::replay::sigma_of(config.sensors[s].second.noise, what);
  if (sigma.value == nullptr)
    refuse_option(option, text, fmt::format("must name one of {}", recording::replay::sigma_names()));
  const char* end = text.data() + text.size();
  double value = 0;
  const auto [read, error] = std::from_chars(text.data() + equals + 1, end, value);
  if (error != std::errc{} || read != end || !sigma.allowed.contains(value))
    refuse_option(option, text,
                  fmt::format("must be a number {:g}..{:g} {}", sigma.allowed.low, sigma.allowed.high, sigma.unit));
  *sigma.value = value;
}

}  // namespace

void apply_sensor_options(const TrackOptions& options, ReplayConfig& config) {
  for (const std::string& text : options.noise) apply_noise(text, config);
  for (const std::string& text : options.worst_delay) {
    const OfSensor given = of_sensor("--worst-delay", text, config);
    config.sensors[given.sensor].second.worst_delay =
        duration_option("--worst-delay", text, given.value, recording::replay::kDelayAllowed);
  }
  for (const std::string& text : options.period) {
    const OfSensor given = of_sensor("--period", text, config);
    config.sensors[given.sensor].second.period =
        duration_option("--period", text, given.value, recording::replay::kPeriodAllowed);
  }
}

recording::replay::SimulatedArrivals simulated_arrivals(const TrackOptions& options, const ReplayConfig& config) {
  recording::replay::SimulatedArrivals simulated;
  simulated.delays.resize(config.sensors.size());
  for (const std::string& text : options.delay) {
    const OfSensor given = of_sensor("--delay", text, config);
    const std::size_t dots = given.value.find("..");
    const std::string_view value = given.value;
    const Duration least = duration_option("--delay", text, value.substr(0, dots), recording::replay::kDelayAllowed);
    const Duration most = dots == std::string::npos ? least
                                                    : duration_option("--delay", text, value.substr(dots + 2),
                                                                      recording::replay::kDelayAllowed);
    if (most < least) refuse_option("--delay", text, "must be LEAST..MOST");
    if (simulated.delays[given.sensor]) refuse_option("--delay", text, "must name each sensor once");
    simulated.delays[given.sensor] = {least, most};
  }
  simulated.shuffle = options.shuffle;
  simulated.seed = drive::seed_of(options.seed);
  return simulated;
}

}  // namespace ttf::cli::track
