#include "bus/list_buffer.h"

#include <algorithm>

#include "bus/wire/pdu_codec.h"
#include "core/check.h"

namespace ttf::bus {
namespace {

std::size_t capacity(const schedules::PduLayout& layout) {
  return static_cast<std::size_t>(layout.fragment_bytes) * static_cast<std::size_t>(layout.max_fragments());
}

}  // namespace

OutgoingList::OutgoingList(const schedules::PduLayout& layout)
    : bytes_(capacity(layout)), fragment_bytes_(static_cast<std::size_t>(layout.fragment_bytes)) {}

void OutgoingList::write(const ListView& list) {
  TTF_CHECK(list.fragments > 0 && list.bytes.size() == static_cast<std::size_t>(list.fragments) * fragment_bytes_ &&
                list.bytes.size() <= bytes_.size(),
            "{} bytes in {} fragments", list.bytes.size(), list.fragments);
  std::copy(list.bytes.begin(), list.bytes.end(), bytes_.begin());
  sequence_ = list.sequence;
  fragments_ = list.fragments;
}

std::span<const std::byte> OutgoingList::fragment(int index) const {
  if (index < 0 || index >= fragments_) return {};
  return {bytes_.data() + static_cast<std::size_t>(index) * fragment_bytes_, fragment_bytes_};
}

IncomingList::IncomingList(const schedules::PduLayout& layout)
    : layout_(&layout),
      sequence_signal_(wire::header_signal(layout, "sequence")),
      fragment_signal_(wire::header_signal(layout, "fragment")),
      count_signal_(wire::header_signal(layout, "count")),
      collecting_bytes_(capacity(layout)),
      complete_bytes_(capacity(layout)),
      present_(static_cast<std::size_t>(layout.max_fragments())) {}

std::uint32_t IncomingList::unwrap(std::uint32_t raw) const {
  const int bits = layout_->header[sequence_signal_].bits;
  if (bits >= 32) return raw;
  // The value nearest to the last one seen; counting starts at zero, so nothing before it.
  const std::int64_t modulus = std::int64_t{1} << bits;
  const std::int64_t last = collecting_ ? collecting_sequence_ : complete_ ? complete_sequence_ : 0;
  std::int64_t difference = (raw - last) % modulus;
  if (difference < 0) difference += modulus;
  if (difference > modulus / 2) difference -= modulus;
  const std::int64_t value = last + difference;
  return static_cast<std::uint32_t>(value < 0 ? value + modulus : value);
}

ArrivalEffect IncomingList::arrive(std::span<const std::byte> payload) {
  torn_.reset();
  const std::uint32_t raw = wire::read_header_raw(*layout_, payload, sequence_signal_);
  const auto fragment = static_cast<int>(wire::read_header_raw(*layout_, payload, fragment_signal_));
  const auto count = static_cast<int>(wire::read_header_raw(*layout_, payload, count_signal_));
  if (count > layout_->max_elements || fragment >= layout_->fragments_of(count)) return ArrivalEffect::kMalformed;
  const std::uint32_t sequence = unwrap(raw);
  arrived_sequence_ = sequence;
  if (complete_ && sequence == complete_sequence_ && (!collecting_ || collecting_sequence_ != sequence))
    return ArrivalEffect::kDuplicate;

  if (!collecting_ || collecting_sequence_ != sequence || collecting_count_ != count) {
    if (collecting_) torn_ = collecting_sequence_;
    collecting_ = true;
    collecting_sequence_ = sequence;
    collecting_count_ = count;
    collecting_fragments_ = layout_->fragments_of(count);
    collecting_present_ = 0;
    std::fill(present_.begin(), present_.end(), false);
  }
  const auto index = static_cast<std::size_t>(fragment);
  if (present_[index]) return ArrivalEffect::kDuplicate;
  present_[index] = true;
  ++collecting_present_;
  std::copy(payload.begin(), payload.end(), collecting_bytes_.begin() + fragment * layout_->fragment_bytes);
  if (collecting_present_ < collecting_fragments_) return torn_ ? ArrivalEffect::kTorn : ArrivalEffect::kIncomplete;

  std::swap(collecting_bytes_, complete_bytes_);
  complete_ = true;
  read_ = false;
  complete_sequence_ = sequence;
  complete_fragments_ = collecting_fragments_;
  collecting_ = false;
  return ArrivalEffect::kCompleted;
}

std::optional<ListView> IncomingList::latest() const {
  if (!complete_) return std::nullopt;
  return ListView{complete_sequence_, complete_fragments_,
                  {complete_bytes_.data(), static_cast<std::size_t>(complete_fragments_) *
                                               static_cast<std::size_t>(layout_->fragment_bytes)}};
}

bool IncomingList::mark_read() {
  const bool first = complete_ && !read_;
  read_ = complete_;
  return first;
}

}  // namespace ttf::bus
