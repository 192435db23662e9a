#include "schedules/analysis/can_load.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "core/int128.h"
#include "schedules/timing/response/can.h"

namespace ttf::schedules::analysis {
namespace {

constexpr int kStuffedClassic = 34;  // SOF to the end of the CRC, without data
constexpr int kUnstuffed = 13;       // CRC delimiter to the end of the intermission
constexpr int kArbitrationFd = 17;   // SOF, identifier, RRS, IDE, FDF, res, BRS
constexpr int kStuffedFd = 14;       // part of these, SOF to IDE: FDF, res and BRS alternate, so a run ends there
constexpr int kControlFd = 5;        // ESI, DLC

}  // namespace

std::optional<int> can_data_length(bool flexible_data_rate, int bytes) {
  constexpr std::array<int, 7> kLong{12, 16, 20, 24, 32, 48, 64};
  if (bytes < 0 || bytes > (flexible_data_rate ? 64 : 8)) return std::nullopt;
  if (bytes <= 8) return bytes;
  return *std::lower_bound(kLong.begin(), kLong.end(), bytes);
}

CanBits can_unstuffed_bits(const model::CanBus& bus, int bytes) {
  const auto length = can_data_length(bus.flexible_data_rate, bytes);
  TTF_CHECK(length.has_value(), "{} bytes in a frame on {}", bytes, bus.name);
  const int payload = 8 * *length;
  if (!bus.flexible_data_rate) return {kStuffedClassic + payload + kUnstuffed, 0};
  const int check = *length <= 16 ? 4 + 17 + 6 : 4 + 21 + 7;
  return {kArbitrationFd + kUnstuffed, kControlFd + payload + check};
}

Duration can_duration(const model::CanBus& bus, CanBits bits) {
  const Int128 rates = static_cast<Int128>(bus.nominal_bit_rate) * bus.data_bit_rate;
  const Int128 work =
      (static_cast<Int128>(bits.nominal) * bus.data_bit_rate + static_cast<Int128>(bits.data) * bus.nominal_bit_rate) *
      1'000'000'000;
  return {static_cast<std::int64_t>((work + rates - 1) / rates)};
}

Duration can_worst_case(const model::CanBus& bus, int bytes) {
  CanBits bits = can_unstuffed_bits(bus, bytes);
  const int payload = 8 * *can_data_length(bus.flexible_data_rate, bytes);
  // After the first bit, every fourth bit can need a stuff bit.
  if (bus.flexible_data_rate) {
    bits.nominal += (kStuffedFd - 1) / 4;
    bits.data += (1 + kControlFd + payload - 1) / 4;  // BRS begins a run
  } else {
    bits.nominal += (kStuffedClassic + payload - 1) / 4;
  }
  return can_duration(bus, bits);
}

Duration can_best_case(const model::CanBus& bus, int bytes) {
  return can_duration(bus, can_unstuffed_bits(bus, bytes));
}

Duration can_soonest_arrival(const model::CanBus& bus, int bytes) {
  CanBits bits = can_unstuffed_bits(bus, bytes);
  bits.nominal -= kBitsAfterAcceptance;
  return can_duration(bus, bits);
}

Duration can_after_acceptance(const model::CanBus& bus) {
  return {kBitsAfterAcceptance * 1'000'000'000 / bus.nominal_bit_rate};
}

Duration can_list_worst_case(const model::CanBus& bus, const model::PduLayout& layout) {
  return can_worst_case(bus, layout.fragment_bytes) * layout.max_fragments();
}

double can_worst_load(const model::Cluster& cluster, const model::CanBus& bus) {
  double load = bus.other_load;
  for (const model::CanMessage& message : bus.messages)
    load += can_list_worst_case(bus, cluster.pdu(message.pdu)).seconds() / message.shortest_period.seconds();
  return load;
}

namespace {

timing::response::CanMessage theory_message(const model::Cluster& cluster, const model::CanBus& bus,
                                            const model::CanMessage& message) {
  const model::PduLayout& layout = cluster.pdu(message.pdu);
  return {.period = message.shortest_period.ns,
          .transmission = can_list_worst_case(bus, layout).ns,
          .deadline = message.shortest_period.ns,
          .jitter = 0,
          .frame = can_worst_case(bus, layout.fragment_bytes).ns};
}

// Other traffic of a share u with frames of C comes at most u t + C in a window t: within ceil((t + T) / T) C, T = C / u.
timing::response::CanMessage other_traffic(const model::CanBus& bus) {
  const std::int64_t frame = can_worst_case(bus, bus.flexible_data_rate ? 64 : 8).ns;
  const auto period = static_cast<std::int64_t>(std::floor(static_cast<double>(frame) / bus.other_load));
  return {.period = period, .transmission = frame, .deadline = period, .jitter = period, .frame = frame};
}

}  // namespace

std::optional<Duration> can_response_by_theory(const model::Cluster& cluster, const model::CanBus& bus,
                                               const model::CanMessage& message, std::optional<Duration> errors_apart) {
  if (can_worst_load(cluster, bus) >= 1.0) return std::nullopt;
  std::vector<timing::response::CanMessage> higher;
  std::int64_t longest_lower = 0;
  for (const model::CanMessage& other : bus.messages) {
    const timing::response::CanMessage one = theory_message(cluster, bus, other);
    if (other.identifier < message.identifier) higher.push_back(one);
    if (other.identifier > message.identifier) longest_lower = std::max(longest_lower, one.frame);
  }
  if (bus.other_load > 0.0) higher.push_back(other_traffic(bus));
  timing::response::CanBus line{.bit = can_duration(bus, {1, 0}).ns, .errors = std::nullopt};
  if (errors_apart) line.errors = timing::response::CanErrors{.at_once = 1, .interarrival = errors_apart->ns};
  const timing::response::Response found =
      timing::response::can_response(line, higher, theory_message(cluster, bus, message), longest_lower);
  if (!found.bounded()) return std::nullopt;
  return Duration{found.longest} - can_after_acceptance(bus);
}

std::optional<Duration> can_worst_response(const model::Cluster& cluster, const model::CanBus& bus,
                                           const model::CanMessage& message) {
  if (bus.other_load == 0.0) return can_response_by_theory(cluster, bus, message);
  if (can_worst_load(cluster, bus) >= 1.0) return std::nullopt;
  Duration fixed = can_list_worst_case(bus, cluster.pdu(message.pdu));
  Duration blocking{};
  for (const model::CanMessage& other : bus.messages)
    if (other.identifier > message.identifier)
      blocking = std::max(blocking, can_worst_case(bus, cluster.pdu(other.pdu).fragment_bytes));
  // Undescribed traffic may have any priority: it counts as having the highest.
  if (bus.other_load > 0.0) blocking += can_worst_case(bus, bus.flexible_data_rate ? 64 : 8);
  fixed += blocking;
  // Davis et al., equation 3, iterated from below to its fixed point; it ends because the load is below one.
  Duration response = fixed;
  while (true) {
    Duration next = fixed;
    for (const model::CanMessage& other : bus.messages)
      if (other.identifier < message.identifier)
        next += can_list_worst_case(bus, cluster.pdu(other.pdu)) * (response.ns / other.shortest_period.ns + 1);
    next.ns = static_cast<std::int64_t>(std::ceil(static_cast<double>(next.ns) / (1.0 - bus.other_load)));
    if (next == response) return response - can_after_acceptance(bus);
    response = next;
  }
}

}  // namespace ttf::schedules::analysis
