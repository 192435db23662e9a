// Packing and unpacking of PDU fragments: fixed-point signals, most significant bit first (schedules/model/pdu.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "schedules/model/pdu.h"

namespace ttf::bus::wire {

// Converts physical to raw. Physical values outside [low, high] saturate and add one to `saturated`, if given.
// NaN is our bug and fails a check.
std::uint32_t to_raw(const schedules::model::Signal& signal, double physical, int* saturated = nullptr);
// Converts raw to physical. A code above highest_code(), which no sender writes, becomes `high` and adds one
// to `out_of_range`, if given.
double to_physical(const schedules::model::Signal& signal, std::uint32_t raw, int* out_of_range = nullptr);
// Returns the code of `high`, the largest in use. It may be smaller than the largest code of the signal's bits.
std::uint32_t highest_code(const schedules::model::Signal& signal);

// Returns the index of the header signal of that name. The loader has found the name in the layout, so its
// absence is our bug and fails a check. Every layout has "sequence", "fragment" and "count".
std::size_t header_signal(const schedules::model::PduLayout& layout, std::string_view name);

// Reads or writes one signal of the header, or of element `index`, in a payload of exactly fragment_bytes.
std::uint32_t read_header_raw(const schedules::model::PduLayout& layout, std::span<const std::byte> payload,
                              std::size_t signal);
void write_header_raw(const schedules::model::PduLayout& layout, std::span<std::byte> payload, std::size_t signal,
                      std::uint32_t raw);
std::uint32_t read_element_raw(const schedules::model::PduLayout& layout, std::span<const std::byte> payload, int index,
                               std::size_t signal);
void write_element_raw(const schedules::model::PduLayout& layout, std::span<std::byte> payload, int index,
                       std::size_t signal, std::uint32_t raw);

}  // namespace ttf::bus::wire
