// How long CAN frames take at worst and at best, and what that makes of a bus' load: the one home of these formulas.
//
// Classic CAN, 11-bit identifier, s data bytes (Davis, Burns, Bril, Lukkien: "Controller Area Network schedulability
// analysis: refuted, revisited and revised", Real-Time Systems 35, 2007, equation 1):
//   C = (34 + 8 s + 13 + floor((34 + 8 s - 1) / 4)) tau
// 34 bits from SOF to the CRC's end are stuffed, at worst every fourth bit after the first; 13 are not (CRC delimiter,
// ACK and its delimiter, 7 EOF, 3 intermission).
//
// CAN FD with bit-rate switching (ISO 11898-1:2015): SOF to BRS (17 bits) and the 13 unstuffed bits at the nominal
// rate; ESI, DLC, data, stuff count and CRC at the data rate. SOF to IDE (14 bits) need 3 stuff bits at worst; FDF, res
// and BRS alternate, so that counting begins anew with BRS. Dynamic stuffing ends with the data; stuff count (4 bits)
// and CRC (17 bits up to 16 bytes, else 21) carry fixed stuff bits, one first and one after every fourth bit: 6 or 7.
// The two bits in which the rate changes (BRS, CRC delimiter) are counted at the nominal rate, which is on the safe
// side.
#pragma once

#include <cstdint>
#include <optional>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// A private CAN loaded more than this at worst is refused: the rest is for repeated frames after errors.
inline constexpr double kCanLoadLimit = 0.8;

// The smallest length a frame can have that holds `bytes`: 0..8, on CAN FD also 12, 16, 20, 24, 32, 48, 64; nothing
// where no frame does.
std::optional<int> can_data_length(bool flexible_data_rate, int bytes);

// Bits of a frame from its start to the end of the intermission, by the rate they are sent at.
struct CanBits {
  std::int64_t nominal = 0;
  std::int64_t data = 0;
};
// Without stuff bits but CAN FD's fixed ones; `bytes` must fit a frame.
CanBits can_unstuffed_bits(const model::CanBus& bus, int bytes);
// Rounded up to whole nanoseconds.
Duration can_duration(const model::CanBus& bus, CanBits bits);

// From start of frame to the end of the intermission; `bytes` must fit a frame.
Duration can_worst_case(const model::CanBus& bus, int bytes);  // any data
Duration can_best_case(const model::CanBus& bus, int bytes);   // no stuff bits but the fixed ones

// From start of frame to when its receivers have it: can_best_case() without the intermission.
Duration can_soonest_arrival(const model::CanBus& bus, int bytes);

// All fragments of a full list of this message.
Duration can_list_worst_case(const model::CanBus& bus, const model::PduLayout& layout);

// Share of time the messages take when every list is full and comes at its shortest period, other load included.
double can_worst_load(const model::Cluster& cluster, const model::CanBus& bus);

// From the instant a full list of `message` is queued to the end of its last frame: one frame of lower priority that
// has just begun, and every list of higher priority (lower identifier) at its shortest period; the bus' other load
// stretches it as if it had the highest priority, and a longest frame of it comes beyond its share. Nothing where that
// never ends.
std::optional<Duration> can_worst_response(const model::Cluster& cluster, const model::CanBus& bus,
                                           const model::CanMessage& message);

}  // namespace ttf::schedules::analysis
