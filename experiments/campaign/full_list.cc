#include "experiments/campaign/full_list.h"

#include <span>
#include <string_view>

#include "bus/wire/pdu_codec.h"

namespace ttf::experiments::campaign {
namespace {

// Writes the lower bits of the value, as many as the signal has.
void write_header(const schedules::model::PduLayout& layout, std::span<std::byte> payload, std::string_view name,
                  std::uint32_t value) {
  const std::size_t signal = bus::wire::header_signal(layout, name);
  const int bits = layout.header[signal].bits;
  bus::wire::write_header_raw(layout, payload, signal, bits >= 32 ? value : value & ((1u << bits) - 1));
}

}  // namespace

bus::cni::ListView full_list(const schedules::model::PduLayout& layout, std::uint32_t number,
                             std::vector<std::byte>& bytes) {
  const auto size = static_cast<std::size_t>(layout.fragment_bytes);
  const int fragments = layout.max_fragments();
  bytes.assign(size * static_cast<std::size_t>(fragments), std::byte{0});
  for (int fragment = 0; fragment < fragments; ++fragment) {
    const auto payload = std::span<std::byte>(bytes).subspan(size * static_cast<std::size_t>(fragment), size);
    write_header(layout, payload, "sequence", number);
    write_header(layout, payload, "fragment", static_cast<std::uint32_t>(fragment));
    write_header(layout, payload, "count", static_cast<std::uint32_t>(layout.max_elements));
  }
  return {number, fragments, bytes};
}

}  // namespace ttf::experiments::campaign
