#include "bus/wire/pdu_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/check.h"

namespace ttf::bus::wire {
namespace {

// Eight bytes of a payload that hold all bits of a signal form one number, most significant byte first.
constexpr std::size_t kWindow = 8;
std::size_t window_start(std::size_t payload_bytes, int first) {
  return std::min(static_cast<std::size_t>(first) / 8, payload_bytes - kWindow);
}
std::uint64_t big_endian(std::uint64_t value) {
  return std::endian::native == std::endian::big ? value : __builtin_bswap64(value);
}
// Returns the distance of bits first .. first + count - 1 from the number's lower end.
int window_shift(std::size_t start, int first, int count) {
  return static_cast<int>(8 * (start + kWindow)) - first - count;
}

// Reads bits first .. first + count - 1 of the payload, most significant bit first.
std::uint32_t read_bits(std::span<const std::byte> payload, int first, int count) {
  std::uint64_t value = 0;
  if (payload.size() >= kWindow) {
    const std::size_t start = window_start(payload.size(), first);
    std::memcpy(&value, payload.data() + start, kWindow);
    value = big_endian(value) >> window_shift(start, first, count);
    return static_cast<std::uint32_t>(value & ((std::uint64_t{1} << count) - 1));
  }
  const int last = first + count - 1;
  for (int byte = first / 8; byte <= last / 8; ++byte)
    value = (value << 8) | static_cast<std::uint64_t>(payload[static_cast<std::size_t>(byte)]);
  return static_cast<std::uint32_t>((value >> (7 - last % 8)) & ((std::uint64_t{1} << count) - 1));
}

void write_bits(std::span<std::byte> payload, int first, int count, std::uint32_t value) {
  if (payload.size() >= kWindow) {
    const std::size_t start = window_start(payload.size(), first);
    const int shift = window_shift(start, first, count);
    const std::uint64_t mask = ((std::uint64_t{1} << count) - 1) << shift;
    std::uint64_t window = 0;
    std::memcpy(&window, payload.data() + start, kWindow);
    window = big_endian((big_endian(window) & ~mask) | ((static_cast<std::uint64_t>(value) << shift) & mask));
    std::memcpy(payload.data() + start, &window, kWindow);
    return;
  }
  const int last = first + count - 1, shift = 7 - last % 8;
  std::uint64_t mask = ((std::uint64_t{1} << count) - 1) << shift;
  std::uint64_t bits = (static_cast<std::uint64_t>(value) << shift) & mask;
  for (int at = last / 8; at >= first / 8; --at, mask >>= 8, bits >>= 8) {
    std::byte& byte = payload[static_cast<std::size_t>(at)];
    byte = (byte & ~static_cast<std::byte>(mask)) | static_cast<std::byte>(bits);
  }
}

const schedules::model::Signal& signal_at(const std::vector<schedules::model::Signal>& signals, std::size_t index) {
  TTF_CHECK(index < signals.size(), "signal {} of {}", index, signals.size());
  return signals[index];
}

void check_payload(const schedules::model::PduLayout& layout, std::size_t size) {
  TTF_CHECK(size == static_cast<std::size_t>(layout.fragment_bytes), "{} bytes for {} of {}", size, layout.name,
            layout.fragment_bytes);
}

int element_start(const schedules::model::PduLayout& layout, int index) {
  TTF_CHECK(index >= 0 && index < layout.elements_per_fragment, "element {} in {}", index, layout.name);
  return layout.header_bits + index * layout.element_bits;
}

}  // namespace

std::size_t header_signal(const schedules::model::PduLayout& layout, std::string_view name) {
  const auto signal = schedules::model::find_signal(layout.header, name);
  TTF_CHECK(signal.has_value(), "{} has no header signal {}", layout.name, name);
  return *signal;
}

std::uint32_t to_raw(const schedules::model::Signal& signal, double physical, int* saturated) {
  TTF_CHECK(!std::isnan(physical), "{} is not a number", signal.name);
  const double bounded = physical < signal.low ? signal.low : physical > signal.high ? signal.high : physical;
  if (bounded != physical && saturated != nullptr) ++*saturated;
  // Rounded half up by hand: llround() is a call. Steps are non-negative and far below 2^52, so the rest is exact.
  const double steps = (bounded - signal.low) / signal.resolution;
  const auto whole = static_cast<std::int64_t>(steps);
  const std::int64_t raw = whole + (steps - static_cast<double>(whole) >= 0.5 ? 1 : 0);
  // `high` may lie up to half a resolution above the last code; the result must not wrap to zero.
  return static_cast<std::uint32_t>(std::min(raw, (std::int64_t{1} << signal.bits) - 1));
}

double to_physical(const schedules::model::Signal& signal, std::uint32_t raw, int* out_of_range) {
  if (raw <= highest_code(signal)) return signal.low + static_cast<double>(raw) * signal.resolution;
  if (out_of_range != nullptr) ++*out_of_range;
  return signal.high;
}

std::uint32_t highest_code(const schedules::model::Signal& signal) { return to_raw(signal, signal.high); }

std::uint32_t read_header_raw(const schedules::model::PduLayout& layout, std::span<const std::byte> payload,
                              std::size_t signal) {
  check_payload(layout, payload.size());
  const schedules::model::Signal& s = signal_at(layout.header, signal);
  return read_bits(payload, s.bit_offset, s.bits);
}

void write_header_raw(const schedules::model::PduLayout& layout, std::span<std::byte> payload, std::size_t signal,
                      std::uint32_t raw) {
  check_payload(layout, payload.size());
  const schedules::model::Signal& s = signal_at(layout.header, signal);
  write_bits(payload, s.bit_offset, s.bits, raw);
}

std::uint32_t read_element_raw(const schedules::model::PduLayout& layout, std::span<const std::byte> payload, int index,
                               std::size_t signal) {
  check_payload(layout, payload.size());
  const schedules::model::Signal& s = signal_at(layout.element, signal);
  return read_bits(payload, element_start(layout, index) + s.bit_offset, s.bits);
}

void write_element_raw(const schedules::model::PduLayout& layout, std::span<std::byte> payload, int index,
                       std::size_t signal, std::uint32_t raw) {
  check_payload(layout, payload.size());
  const schedules::model::Signal& s = signal_at(layout.element, signal);
  write_bits(payload, element_start(layout, index) + s.bit_offset, s.bits, raw);
}

}  // namespace ttf::bus::wire
