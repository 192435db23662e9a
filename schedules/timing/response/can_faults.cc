#include "schedules/timing/response/can_faults.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "schedules/timing/response/recurrence.h"

namespace ttf::schedules::timing::response {
namespace {

// Returns x^n e^-x / n!.
double poisson(int n, double x) {
  double probability = std::exp(-x);
  for (int i = 1; i <= n; ++i) probability *= x / i;
  return probability;
}

// The message below its higher priorities, with a number of faults as fixed work.
struct FaultedMessage {
  std::vector<Source> delaying;
  std::int64_t blocking = 0;  // B'
  std::int64_t each = 0;      // cost of a fault
  std::int64_t tail = 0, jitter = 0;
};

FaultedMessage faulted_message(std::int64_t bit, std::span<const CanMessage> higher, const CanMessage& message,
                               std::int64_t longest_lower) {
  FaultedMessage faulted;
  std::int64_t longest = message.transmission;
  for (const CanMessage& other : higher) {
    TTF_CHECK(other.period >= 1 && other.transmission >= 1, "period {}, transmission {}", other.period,
              other.transmission);
    faulted.delaying.push_back({other.period, other.jitter + bit, other.transmission});
    longest = std::max(longest, other.transmission);
  }
  faulted.blocking = std::max(longest_lower, message.transmission);
  faulted.each = kCanErrorBits * bit + longest;
  faulted.tail = message.transmission;
  faulted.jitter = message.jitter;
  return faulted;
}

// Returns R_K; nullopt if it exceeds `most`.
std::optional<std::int64_t> response_with(const FaultedMessage& faulted, int faults, std::int64_t most) {
  Effort effort;
  const Int128 fixed = faulted.blocking + static_cast<Int128>(faults) * faulted.each;
  const auto window = least_window(fixed, faulted.delaying, 0, effort);
  if (!window || static_cast<Int128>(*window) + faulted.tail + faulted.jitter > most) return std::nullopt;
  return *window + faulted.tail + faulted.jitter;
}

}  // namespace

FaultyResponses responses_with_faults(std::int64_t bit, double faults_per_unit, std::span<const CanMessage> higher,
                                      const CanMessage& message, std::int64_t longest_lower) {
  TTF_CHECK(faults_per_unit >= 0.0 && std::isfinite(faults_per_unit), "{} faults", faults_per_unit);
  TTF_CHECK(bit >= 1 && bit <= kLongestArgument / kCanErrorBits && message.transmission >= 1 && message.period >= 1,
            "bit {}, transmission {}, period {}", bit, message.transmission, message.period);
  const FaultedMessage faulted = faulted_message(bit, higher, message, longest_lower);
  const std::int64_t most = std::min(message.deadline, message.period);
  FaultyResponses responses;
  double in_time = 0.0;
  for (int faults = 0; faults <= kMostFaults; ++faults) {
    const auto longest = response_with(faulted, faults, most);
    if (!longest) break;
    const double span = faults_per_unit * static_cast<double>(*longest - message.jitter);
    double probability = poisson(faults, span);
    for (const FaultyResponse& fewer : responses.in_time) {
      const double rest = faults_per_unit * static_cast<double>(*longest - fewer.longest);
      probability -= fewer.probability * poisson(faults - fewer.faults, rest);
    }
    probability = std::max(0.0, probability);  // rounding
    responses.in_time.push_back({faults, *longest, probability});
    in_time += probability;
  }
  responses.miss_probability = std::clamp(1.0 - in_time, 0.0, 1.0);
  return responses;
}

}  // namespace ttf::schedules::timing::response
