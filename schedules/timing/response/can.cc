#include "schedules/timing/response/can.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/timing/response/recurrence.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr std::int64_t kNsInASecond = 1'000'000'000;

Source message_source(const CanMessage& message) {
  for (const std::int64_t time : {message.period, message.transmission, message.deadline, message.jitter})
    TTF_CHECK(time >= 0 && time <= kLongestArgument, "a time of {}", time);
  TTF_CHECK(message.frame >= 0 && message.frame <= message.transmission, "a frame of {} in {}", message.frame,
            message.transmission);
  return {message.period, message.jitter, message.transmission};
}

// n + ceil(t / T_e) - 1 errors in a window t.
Source error_source(const CanErrors& errors, std::int64_t each) {
  TTF_CHECK(errors.at_once >= 1 && errors.interarrival >= 1, "{} errors at once, then {} apart", errors.at_once,
            errors.interarrival);
  TTF_CHECK(errors.at_once - 1 <= kLongestArgument / errors.interarrival, "{} errors at once, then {} apart",
            errors.at_once, errors.interarrival);
  return {errors.interarrival, (errors.at_once - 1) * errors.interarrival, each};
}

}  // namespace

std::int64_t can_frame_bits(CanIdentifier identifier, int data_bytes) {
  TTF_CHECK(data_bytes >= 0 && data_bytes <= 8, "{} data bytes in a classic CAN frame", data_bytes);
  return (identifier == CanIdentifier::k11Bits ? 55 : 80) + 10 * static_cast<std::int64_t>(data_bytes);
}

std::int64_t can_time_ns(std::int64_t bits, std::int64_t bits_per_second) {
  TTF_CHECK(bits >= 0 && bits <= kLongestArgument && bits_per_second >= 1, "{} bits at {} bit/s", bits,
            bits_per_second);
  const Int128 ns = ceil_of(static_cast<Int128>(bits) * kNsInASecond, bits_per_second);
  TTF_CHECK(ns <= kLongestArgument, "{} bits at {} bit/s", bits, bits_per_second);
  return static_cast<std::int64_t>(ns);
}

Response can_response(const CanBus& bus, std::span<const CanMessage> higher, const CanMessage& message,
                      std::int64_t longest_lower) {
  TTF_CHECK(bus.bit >= 1 && bus.bit <= kLongestArgument / kCanErrorBits, "a bit of {}", bus.bit);
  TTF_CHECK(longest_lower >= 0 && longest_lower <= kLongestArgument, "a frame of {}", longest_lower);
  Level level{.blocking = longest_lower,
              .own = message_source(message),
              .others = {},
              .tail = message.one_frame(),
              .tick = bus.bit,
              .errors = {}};
  std::int64_t longest = message.one_frame();
  for (const CanMessage& other : higher) {
    level.others.push_back(message_source(other));
    longest = std::max(longest, other.one_frame());
  }
  if (!bus.errors) return longest_response(level);
  level.errors = error_source(*bus.errors, kCanErrorBits * bus.bit + longest);
  Response response = longest_response(level);
  if (response.quality == Quality::kExact) response.quality = Quality::kBound;
  return response;
}

std::vector<Response> can_responses(const CanBus& bus, std::span<const CanMessage> by_identifier) {
  std::vector<Response> responses(by_identifier.size());
  std::int64_t longest_lower = 0;
  for (std::size_t i = by_identifier.size(); i-- > 0;) {
    responses[i] = can_response(bus, by_identifier.first(i), by_identifier[i], longest_lower);
    longest_lower = std::max(longest_lower, by_identifier[i].one_frame());
  }
  return responses;
}

std::optional<PriorityOrder> audsley_can(const CanBus& bus, std::span<const CanMessage> messages) {
  return audsley(messages.size(),
                 [&](std::size_t message, std::span<const std::size_t> higher, std::span<const std::size_t> lower) {
                   std::vector<CanMessage> above;
                   for (const std::size_t one : higher) above.push_back(messages[one]);
                   std::int64_t longest_lower = 0;
                   for (const std::size_t one : lower)
                     longest_lower = std::max(longest_lower, messages[one].one_frame());
                   return can_response(bus, above, messages[message], longest_lower).keeps(messages[message].deadline);
                 });
}

}  // namespace ttf::schedules::timing::response
