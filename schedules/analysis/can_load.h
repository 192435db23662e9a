// Worst-case and best-case times of CAN frames, and the load of a bus: the only place of these formulas.
//
// Classic CAN, 11-bit identifier, s data bytes (Davis, Burns, Bril, Lukkien: "Controller Area Network
// schedulability analysis: refuted, revisited and revised", Real-Time Systems 35, 2007, equation 1):
//   C = (34 + 8 s + 13 + floor((34 + 8 s - 1) / 4)) tau
// 34 bits from SOF to the end of the CRC are stuffed, at worst every fourth bit after the first. 13 bits are not
// (CRC delimiter, ACK and its delimiter, 7 EOF, 3 intermission).
//
// CAN FD with bit-rate switching (ISO 11898-1:2015): SOF to BRS (17 bits) and the 13 unstuffed bits are at the
// nominal rate. ESI, DLC, data, stuff count and CRC are at the data rate. SOF to IDE (14 bits) need 3 stuff bits
// at worst; FDF, res and BRS alternate, so that a new run begins with BRS. Dynamic stuffing ends with the data.
// Stuff count (4 bits) and CRC (17 bits up to 16 bytes, else 21) have 6 or 7 fixed stuff bits: one first and one
// after every fourth bit. The two bits in which the rate changes (BRS, CRC delimiter) count at the nominal rate,
// which is safe.
#pragma once

#include <cstdint>
#include <optional>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The checker refuses a private CAN with a higher worst load: the rest is for repeated frames after errors.
inline constexpr double kCanLoadLimit = 0.8;

// Returns the smallest frame length that holds `bytes`: 0..8, on CAN FD also 12, 16, 20, 24, 32, 48, 64. Returns
// nullopt if no frame holds them.
std::optional<int> can_data_length(bool flexible_data_rate, int bytes);

// The bits of a frame from its start to the end of the intermission, by their rate.
struct CanBits {
  std::int64_t nominal = 0;
  std::int64_t data = 0;
};
// Counts no stuff bits except CAN FD's fixed ones; `bytes` must fit a frame.
CanBits can_unstuffed_bits(const model::CanBus& bus, int bytes);
// Rounded up to whole nanoseconds.
Duration can_duration(const model::CanBus& bus, CanBits bits);

// The bits behind a frame's acceptance by its receivers: the last bit of its end of frame, which they do not wait
// for, and the intermission (ISO 11898-1:2015, 10.9).
inline constexpr std::int64_t kBitsAfterAcceptance = 1 + 3;
// Returns their time, rounded down.
Duration can_after_acceptance(const model::CanBus& bus);

// Times from start of frame to the end of the intermission; `bytes` must fit a frame.
Duration can_worst_case(const model::CanBus& bus, int bytes);  // any data
Duration can_best_case(const model::CanBus& bus, int bytes);   // without stuff bits except the fixed ones

// Returns the time from start of frame to its acceptance, without stuff bits except the fixed ones.
Duration can_soonest_arrival(const model::CanBus& bus, int bytes);

// Returns the time of all fragments of a full list of this message.
Duration can_list_worst_case(const model::CanBus& bus, const model::PduLayout& layout);

// Returns the share of time of the messages if every list is full and at its shortest period, other load
// included.
double can_worst_load(const model::Cluster& cluster, const model::CanBus& bus);

// Returns the time from the queueing of a full list of `message` to the acceptance of its last frame. It includes one
// frame of lower priority that has just begun, and every list of higher priority (lower identifier) at its
// shortest period. All instances of the busy period count (Davis et al.), so that a list may be queued before the last
// one of its message is sent. With `errors_apart`, errors come at least so long apart
// (schedules/timing/response/can.h). Returns nullopt if the response has no bound.
std::optional<Duration> can_response_by_theory(const model::Cluster& cluster, const model::CanBus& bus,
                                               const model::CanMessage& message,
                                               std::optional<Duration> errors_apart = std::nullopt);

// The same without errors. The bus' other load, if there is one, counts as having the highest priority, with one longest
// frame beyond its share. The response then holds for lists that are sent before the next one is queued.
std::optional<Duration> can_worst_response(const model::Cluster& cluster, const model::CanBus& bus,
                                           const model::CanMessage& message);

}  // namespace ttf::schedules::analysis
