#include "nodes/host/step.h"

#include <algorithm>

#include "bus/wire/pdu_codec.h"
#include "core/check.h"

namespace ttf::nodes::host {
namespace {

std::uint32_t low_bits(std::uint64_t value, int bits) {
  return static_cast<std::uint32_t>(bits >= 32 ? value : value & ((std::uint64_t{1} << bits) - 1));
}

std::size_t fragment_bytes(const schedules::model::PduLayout& layout) {
  return static_cast<std::size_t>(layout.fragment_bytes);
}

}  // namespace

Output::Output(std::string_view port, PduId pdu, const schedules::model::PduLayout& layout)
    : port_(port), pdu_(pdu), layout_(&layout) {
  bytes_.resize(static_cast<std::size_t>(layout.max_fragments()) * fragment_bytes(layout));
}

void Output::begin(std::uint32_t sequence, int count, GlobalTime time_stamp) {
  TTF_CHECK(count >= 0 && count <= layout_->max_elements, "{} elements in {} of {}", count, layout_->name,
            layout_->max_elements);
  sequence_ = sequence;
  fragments_ = layout_->fragments_of(count);
  written_ = true;
  std::fill_n(bytes_.begin(), static_cast<std::size_t>(fragments_) * fragment_bytes(*layout_), std::byte{0});
  const std::size_t sequence_signal = bus::wire::header_signal(*layout_, "sequence");
  const std::size_t fragment_signal = bus::wire::header_signal(*layout_, "fragment");
  const std::size_t count_signal = bus::wire::header_signal(*layout_, "count");
  const auto stamp_signal = schedules::model::find_signal(layout_->header, "timestamp");
  for (int f = 0; f < fragments_; ++f) {
    const std::span<std::byte> payload(bytes_.data() + static_cast<std::size_t>(f) * fragment_bytes(*layout_),
                                       fragment_bytes(*layout_));
    bus::wire::write_header_raw(*layout_, payload, sequence_signal,
                                low_bits(sequence, layout_->header[sequence_signal].bits));
    bus::wire::write_header_raw(*layout_, payload, fragment_signal, static_cast<std::uint32_t>(f));
    bus::wire::write_header_raw(*layout_, payload, count_signal, static_cast<std::uint32_t>(count));
    if (stamp_signal) {
      // The nearest microsecond; instants before the start of the drive wrap like all others.
      const std::int64_t us = (time_stamp.ns + 500 - (time_stamp.ns + 500 < 0 ? 999 : 0)) / 1000;
      bus::wire::write_header_raw(*layout_, payload, *stamp_signal,
                                  low_bits(static_cast<std::uint64_t>(us), layout_->header[*stamp_signal].bits));
    }
  }
}

void Output::set(int index, std::size_t signal, double physical) {
  const int fragment = index / layout_->elements_per_fragment;
  const std::span<std::byte> payload(bytes_.data() + static_cast<std::size_t>(fragment) * fragment_bytes(*layout_),
                                     fragment_bytes(*layout_));
  bus::wire::write_element_raw(*layout_, payload, index % layout_->elements_per_fragment, signal,
                               bus::wire::to_raw(layout_->element[signal], physical, &saturated_));
}

// Half a resolution, less a rounding error, reaches the next code.
void Output::set_at_least(int index, std::size_t signal, double physical) {
  constexpr double kUp = 0.5 - 1e-9;
  const schedules::model::Signal& s = layout_->element[signal];
  set(index, signal, physical < s.high ? std::min(s.high, physical + kUp * s.resolution) : physical);
}

void Output::copy(const bus::cni::ListView& list) {
  TTF_CHECK(list.bytes.size() <= bytes_.size(), "{} bytes into {}", list.bytes.size(), bytes_.size());
  std::copy(list.bytes.begin(), list.bytes.end(), bytes_.begin());
  sequence_ = list.sequence;
  fragments_ = list.fragments;
  written_ = true;
}

int Output::take_saturated() {
  const int count = saturated_;
  saturated_ = 0;
  return count;
}

bus::cni::ListView Output::view() const {
  return {sequence_, fragments_,
          std::span<const std::byte>(bytes_.data(), static_cast<std::size_t>(fragments_) * fragment_bytes(*layout_))};
}

void StrobeLatch::strobe(std::uint32_t sequence, GlobalTime at) { entries_[count_++ % kDepth] = {sequence, at}; }

std::optional<Strobe> StrobeLatch::find(std::uint32_t sequence, int bits) const {
  for (std::size_t back = 1; back <= std::min(count_, kDepth); ++back) {
    const Strobe& strobe = entries_[(count_ - back) % kDepth];
    if (low_bits(strobe.sequence ^ sequence, bits) == 0) return strobe;
  }
  return std::nullopt;
}

std::optional<Strobe> strobe_of(const StepContext& context, const Input& raw, SensorId sensor) {
  if (!raw.list) return std::nullopt;
  const int bits = raw.layout->header[bus::wire::header_signal(*raw.layout, "sequence")].bits;
  return context.strobes[index_of(sensor)].find(raw.list->sequence, bits);
}

std::optional<Strobe> measurement_of(StepContext& context, SensorId sensor) {
  Input& raw = context.inputs[0];
  if (!raw.fresh || !raw.list) return std::nullopt;
  const auto measurement = strobe_of(context, raw, sensor);
  raw.discarded = !measurement;
  return measurement;
}

GlobalTime time_stamp(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, GlobalTime near,
                      Duration round) {
  const std::size_t signal = bus::wire::header_signal(layout, "timestamp");
  const int bits = layout.header[signal].bits;
  const std::int64_t modulus = std::int64_t{1} << bits;
  const std::int64_t raw = bus::wire::read_header_raw(layout, list.bytes.first(fragment_bytes(layout)), signal);
  const std::int64_t near_us = near.ns / 1000;
  // The candidate in (near - modulus/2, near + modulus/2].
  std::int64_t difference = (raw - near_us) % modulus;
  if (difference < 0) difference += modulus;
  if (difference > modulus / 2) difference -= modulus;
  const GlobalTime here{(near_us + difference) * 1000};
  const Duration half{round.ns / 2};
  if (here - near <= half && near - here <= half) return here;
  std::int64_t apart = (raw * 1000 - near.ns) % round.ns;
  if (apart > half.ns) apart -= round.ns;
  if (apart < -half.ns) apart += round.ns;
  return near + Duration{apart};
}

GlobalTime past_time_stamp(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, GlobalTime now,
                           Duration round) {
  return time_stamp(layout, list, now - Duration{round.ns / 8 * 3}, round);
}

int element_count(const schedules::model::PduLayout& layout, const bus::cni::ListView& list) {
  return static_cast<int>(bus::wire::read_header_raw(layout, list.bytes.first(fragment_bytes(layout)),
                                                     bus::wire::header_signal(layout, "count")));
}

double element_value(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, int index,
                     std::size_t signal) {
  const auto fragment = static_cast<std::size_t>(index / layout.elements_per_fragment);
  const auto payload = list.bytes.subspan(fragment * fragment_bytes(layout), fragment_bytes(layout));
  return bus::wire::to_physical(
      layout.element[signal],
      bus::wire::read_element_raw(layout, payload, index % layout.elements_per_fragment, signal));
}

}  // namespace ttf::nodes::host
