#include "bus/cni/list_buffer.h"

#include <algorithm>
#include <cstring>

#include "bus/wire/pdu_codec.h"
#include "core/check.h"

namespace ttf::bus::cni {
namespace {

std::size_t capacity(const schedules::model::PduLayout& layout) {
  return static_cast<std::size_t>(layout.fragment_bytes) * static_cast<std::size_t>(layout.max_fragments());
}

}  // namespace

OutgoingList::OutgoingList(const schedules::model::PduLayout& layout)
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

IncomingList::IncomingList(const schedules::model::PduLayout& layout)
    : layout_(&layout), sequence_signal_(wire::header_signal(layout, "sequence")),
      fragment_signal_(wire::header_signal(layout, "fragment")), count_signal_(wire::header_signal(layout, "count")),
      collecting_bytes_(capacity(layout)), complete_bytes_(capacity(layout)),
      present_(static_cast<std::size_t>(layout.max_fragments())) {
  for (std::size_t s = 0; s < layout.element.size(); ++s) {
    const schedules::model::Signal& signal = layout.element[s];
    const std::uint32_t highest = wire::highest_code(signal);
    if (highest < (std::uint64_t{1} << signal.bits) - 1) bounded_.push_back({s, highest});
  }
}

// Returns the distance of `raw` from list `of` on the circle: positive is newer (up to half the circle),
// negative older.
std::int64_t IncomingList::ahead(std::uint32_t raw, std::uint32_t of) const {
  const std::int64_t circle = std::int64_t{1} << layout_->header[sequence_signal_].bits;
  const std::int64_t difference = (static_cast<std::int64_t>(raw) - of) & (circle - 1);
  return difference > circle / 2 ? difference - circle : difference;
}

bool IncomingList::well_formed(std::span<const std::byte> payload, int fragment, int count) const {
  if (count > layout_->max_elements || fragment >= layout_->fragments_of(count)) return false;
  const int here = std::min(count - fragment * layout_->elements_per_fragment, layout_->elements_per_fragment);
  for (const Bounded& bounded : bounded_)
    for (int i = 0; i < here; ++i)
      if (wire::read_element_raw(*layout_, payload, i, bounded.signal) > bounded.highest) return false;
  return true;
}

// Counts consecutive stale lists; returns true at the one that proves a restarted sender.
bool IncomingList::restarted(std::uint32_t raw) {
  if (stale_lists_ > 0 && raw == stale_raw_) return false;  // another fragment, or the other channel
  stale_lists_ = stale_lists_ > 0 && ahead(raw, stale_raw_) > 0 ? stale_lists_ + 1 : 1;
  stale_raw_ = raw;
  return stale_lists_ == kRestartLists;
}

// Begins to collect list `sequence`; an incomplete list that it displaces is torn.
void IncomingList::begin(std::uint32_t sequence, int count) {
  if (collecting_ && collecting_sequence_ == sequence && collecting_count_ == count) return;
  if (collecting_) torn_ = collecting_sequence_;
  collecting_ = true;
  collecting_sequence_ = sequence;
  collecting_count_ = count;
  collecting_fragments_ = layout_->fragments_of(count);
  collecting_present_ = 0;
  std::fill(present_.begin(), present_.end(), false);
}

ArrivalEffect IncomingList::store(std::span<const std::byte> payload, int fragment) {
  const auto index = static_cast<std::size_t>(fragment);
  if (present_[index]) return ArrivalEffect::kDuplicate;
  present_[index] = true;
  ++collecting_present_;
  std::copy(payload.begin(), payload.end(), collecting_bytes_.begin() + fragment * layout_->fragment_bytes);
  if (collecting_present_ < collecting_fragments_) return torn_ ? ArrivalEffect::kTorn : ArrivalEffect::kIncomplete;
  std::swap(collecting_bytes_, complete_bytes_);
  complete_ = true;
  complete_sequence_ = collecting_sequence_;
  complete_fragments_ = collecting_fragments_;
  collecting_ = false;
  return ArrivalEffect::kCompleted;
}

// Returns whether the newest list already has this fragment, to the last bit. Most arriving fragments are such
// repetitions: on the other channel, and in every cycle until the next list.
bool IncomingList::repeats(std::span<const std::byte> payload, int fragment) const {
  const auto index = static_cast<std::size_t>(fragment);
  const bool there =
      collecting_ ? fragment < collecting_fragments_ && present_[index] : complete_ && fragment < complete_fragments_;
  const std::byte* const known = (collecting_ ? collecting_bytes_ : complete_bytes_).data() + index * payload.size();
  return there && std::memcmp(known, payload.data(), payload.size()) == 0;
}

ArrivalEffect IncomingList::arrive(std::span<const std::byte> payload, std::optional<int> expected) {
  torn_.reset();
  if (expected && repeats(payload, *expected)) {
    arrived_sequence_ = collecting_ ? collecting_sequence_ : complete_sequence_;
    stale_lists_ = 0;
    return ArrivalEffect::kDuplicate;
  }
  const std::uint32_t raw = wire::read_header_raw(*layout_, payload, sequence_signal_);
  const auto fragment = static_cast<int>(wire::read_header_raw(*layout_, payload, fragment_signal_));
  const auto count = static_cast<int>(wire::read_header_raw(*layout_, payload, count_signal_));
  if ((expected && fragment != *expected) || !well_formed(payload, fragment, count)) return ArrivalEffect::kMalformed;
  if (!collecting_ && !complete_) {
    arrived_sequence_ = raw;
    begin(raw, count);
    return store(payload, fragment);
  }
  const std::uint32_t newest = collecting_ ? collecting_sequence_ : complete_sequence_;
  const std::int64_t difference = ahead(raw, newest);
  arrived_sequence_ = static_cast<std::uint32_t>(newest + difference);
  // The second channel's copy of the latest list, even if the next list has begun.
  if (complete_ && arrived_sequence_ == complete_sequence_ && (!collecting_ || difference < 0)) {
    stale_lists_ = 0;
    return ArrivalEffect::kDuplicate;
  }
  if (difference < 0) {
    if (!restarted(raw)) return ArrivalEffect::kStale;
    arrived_sequence_ = raw;
  }
  stale_lists_ = 0;
  begin(arrived_sequence_, count);
  return store(payload, fragment);
}

std::optional<ListView> IncomingList::latest() const {
  if (!complete_) return std::nullopt;
  return ListView{complete_sequence_,
                  complete_fragments_,
                  {complete_bytes_.data(),
                   static_cast<std::size_t>(complete_fragments_) * static_cast<std::size_t>(layout_->fragment_bytes)}};
}

}  // namespace ttf::bus::cni
