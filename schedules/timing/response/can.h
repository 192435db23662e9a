// Longest responses of CAN messages: R. Davis, A. Burns, R. Bril, J. Lukkien, Real-Time Systems 35, 2007.
//
//   busy period   t = E(t) + B + sum_hep ceil((t + J_k) / T_k) C_k
//   instance q    w = E(w + C) + B + q C + sum_hp ceil((w + J_k + tau) / T_k) C_k
//   response      R = max_q (J + w - q T + C)            over all instances q of the busy period
//
// B is the longest frame of a lower priority and tau one bit. K. Tindell, A. Burns and A. Wellings (Control
// Engineering Practice 3(8), 1995) looked at the first instance alone, which is too little. Errors come at most n at
// once and then at least T_e apart. Each costs an error frame of up to 31 bits and one frame that is sent again:
//   E(t) = (n + ceil(t / T_e) - 1) (31 tau + max_hep C_k)
//
// Frames have their longest form: s data bytes take 55 + 10 s bits with an identifier of 11 bits, 80 + 10 s with one
// of 29, stuff bits and intermission included (equation 1). A response ends with the intermission. CAN FD:
// schedules/analysis/can_load.h.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/priorities.h"
#include "schedules/timing/response/response.h"

namespace ttf::schedules::timing::response {

enum class CanIdentifier : std::uint8_t { k11Bits, k29Bits };

inline constexpr std::int64_t kCanErrorBits = 31;  // the longest error frame with the intermission behind it

// Returns the bits of the longest frame with 0..8 data bytes.
std::int64_t can_frame_bits(CanIdentifier identifier, int data_bytes);
// Returns the time of this many bits, rounded up to whole nanoseconds.
std::int64_t can_time_ns(std::int64_t bits, std::int64_t bits_per_second);

struct CanMessage {
  std::int64_t period = 0;        // T, at least 1: the least time between two arrivals
  std::int64_t transmission = 0;  // C, at least 1: can_time_ns() of can_frame_bits()
  std::int64_t deadline = 0;      // D, after the arrival; may exceed T. Only audsley_can() reads it
  std::int64_t jitter = 0;        // J, from an arrival to the queue
  // A list of equal frames that are queued at once has C for all of them, and the length of one here; 0: C is one frame.
  // Higher priorities go before its last frame, too.
  std::int64_t frame = 0;

  std::int64_t one_frame() const { return frame > 0 ? frame : transmission; }
};

struct CanErrors {
  std::int64_t at_once = 1;       // n, at least 1
  std::int64_t interarrival = 0;  // T_e, at least 1
};

struct CanBus {
  std::int64_t bit = 0;             // tau, at least 1
  std::optional<CanErrors> errors;  // nullopt: none
};

// Takes messages by identifier, the highest priority first. Exact without errors, in the limit of arrivals just too
// late for an arbitration; with errors a bound. Errors count as load: too many of them leave no bound.
std::vector<Response> can_responses(const CanBus& bus, std::span<const CanMessage> by_identifier);

// The same for one message. `longest_lower` is the longest transmission of a lower priority, 0 without one.
Response can_response(const CanBus& bus, std::span<const CanMessage> higher, const CanMessage& message,
                      std::int64_t longest_lower);

// Audsley's algorithm, which is optimal here; deadline monotonic is not. Returns nullopt if no order meets all
// deadlines.
std::optional<PriorityOrder> audsley_can(const CanBus& bus, std::span<const CanMessage> messages);

}  // namespace ttf::schedules::timing::response
