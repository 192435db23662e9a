// Packing and unpacking of PDU fragments: fixed-point signals, most significant bit first (schedules/model/pdu.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "schedules/model/pdu.h"

namespace ttf::bus::wire {

// Raw <-> physical. Physical values outside [low, high] saturate; `saturated` (if given) is counted up. NaN is a bug of
// ours and fails a check.
std::uint32_t to_raw(const schedules::model::Signal& signal, double physical, int* saturated = nullptr);
// No sender writes a code above highest_code(); one that arrives all the same decodes to `high`, and `out_of_range` (if
// given) is counted up.
double to_physical(const schedules::model::Signal& signal, std::uint32_t raw, int* out_of_range = nullptr);
// The code of `high`, the largest in use: below the largest of the signal's bits where the range ends before them.
std::uint32_t highest_code(const schedules::model::Signal& signal);

// Index of the header signal of that name, for names that the loader has found in the layout ("sequence", "fragment"
// and "count" in every one): a layout without it is a bug of ours and fails a check.
std::size_t header_signal(const schedules::model::PduLayout& layout, std::string_view name);

// One signal of the header or of element `index` in a fragment's payload. The payload must be fragment_bytes long.
std::uint32_t read_header_raw(const schedules::model::PduLayout& layout, std::span<const std::byte> payload,
                              std::size_t signal);
void write_header_raw(const schedules::model::PduLayout& layout, std::span<std::byte> payload, std::size_t signal,
                      std::uint32_t raw);
std::uint32_t read_element_raw(const schedules::model::PduLayout& layout, std::span<const std::byte> payload, int index,
                               std::size_t signal);
void write_element_raw(const schedules::model::PduLayout& layout, std::span<std::byte> payload, int index,
                       std::size_t signal, std::uint32_t raw);

}  // namespace ttf::bus::wire
