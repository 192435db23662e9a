// Lists as long on a CAN as their layout allows: every element present, and every free bit chosen for the
// most stuff bits. Or lists as short as possible.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "bus/wire/pdu_codec.h"
#include "nodes/host/step.h"
#include "schedules/analysis/can_load.h"
#include "schedules/model/cluster.h"

namespace ttf::sim::drives {

enum class Filling { kDense, kSparse };

// The bits of a CAN FD frame with the stuff bits between them: after five equal ones the other one.
class Wire {
 public:
  void put(bool bit) {
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ < 5) return;
    last_ = !bit;
    run_ = 1;
  }
  void put(std::uint32_t value, int bits) {
    for (int b = bits - 1; b >= 0; --b) put(((value >> b) & 1u) != 0);
  }
  // The next bit for the most or the fewest stuff bits.
  bool next(Filling filling) const { return filling == Filling::kDense ? last_ : !last_; }

 private:
  bool last_ = true;  // the idle bus
  int run_ = 0;
};

// Fills a fragment; the sequence number, fragment, count and time stamp stay.
inline void fill(std::span<std::byte> fragment, const schedules::model::PduLayout& layout, std::uint32_t identifier,
                 Filling filling) {
  const auto data_code = [](int bytes) {  // the CAN FD frame around them
    constexpr int kLengths[] = {12, 16, 20, 24, 32, 48, 64};
    return bytes <= 8 ? bytes
                      : static_cast<int>(std::lower_bound(std::begin(kLengths), std::end(kLengths), bytes) -
                                         std::begin(kLengths)) +
                            9;
  };
  Wire wire;
  wire.put(0, 1);  // start of frame
  wire.put(identifier, 11);
  wire.put(0b00101, 5);                                                       // RRS, IDE, FDF, res, BRS
  wire.put(static_cast<std::uint32_t>(data_code(layout.fragment_bytes)), 5);  // ESI, DLC
  std::vector<bool> free(8 * fragment.size(), true);
  for (const schedules::model::Signal& signal : layout.header)
    for (const std::string_view fixed : {"sequence", "fragment", "count", "timestamp"})
      if (signal.name == fixed) std::fill_n(free.begin() + signal.bit_offset, signal.bits, false);
  for (std::size_t b = 0; b < free.size(); ++b) {
    std::byte& byte = fragment[b / 8];
    const std::byte mask{static_cast<unsigned char>(0x80u >> (b % 8))};
    if (free[b]) byte = wire.next(filling) ? byte | mask : byte & ~mask;
    wire.put((byte & mask) != std::byte{0});
  }
}

// Rewrites the content of `output`.
inline void fill(nodes::host::Output& output, std::uint32_t identifier, Filling filling) {
  const bus::cni::ListView list = output.view();
  std::vector<std::byte> bytes(list.bytes.begin(), list.bytes.end());
  const auto size = static_cast<std::size_t>(output.layout().fragment_bytes);
  for (std::size_t f = 0; f < static_cast<std::size_t>(list.fragments); ++f)
    fill(std::span(bytes).subspan(f * size, size), output.layout(), identifier, filling);
  output.copy({list.sequence, list.fragments, bytes});
}

// A sensor device whose every measurement is such a list, and a preprocessing that turns it into such a list.
class FilledStep final : public nodes::host::Step {
 public:
  // The first list has the number `first`.
  FilledStep(const schedules::model::Cluster& cluster, const schedules::model::Task& task, std::uint32_t first,
             Filling filling)
      : filling_(filling), first_(first) {
    const schedules::model::PortBinding& out = task.writes.at(0);
    for (const schedules::model::CanMessage& message : cluster.can(out.medium).messages)
      if (message.pdu == out.pdu) identifier_ = message.identifier;
    sensor_ = cluster.pdu(out.pdu).sensor;
  }
  void run(nodes::host::StepContext& context) override {
    nodes::host::Output& out = context.outputs[0];
    const int count = filling_ == Filling::kDense ? out.layout().max_elements : 0;
    if (context.inputs.empty()) {
      out.begin(first_ + context.measurement, count, GlobalTime{});
    } else {
      const std::uint32_t sequence = context.inputs[0].list.value().sequence;
      out.begin(sequence, count, context.strobes[index_of(sensor_)].find(sequence - first_, 32).value().at);
    }
    fill(out, identifier_, filling_);
  }

 private:
  Filling filling_;
  std::uint32_t first_, identifier_ = 0;
  SensorId sensor_{};
};

// A device without measurements.
class SilentStep final : public nodes::host::Step {
 public:
  void run(nodes::host::StepContext&) override {}
};

}  // namespace ttf::sim::drives
