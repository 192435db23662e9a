// Faults slightly off the specification: signals so little early, late or misshapen that receivers disagree
// about them (H. Kopetz, "A comparison of TTP/C and FlexRay", TU Wien report 10/2001). And a sync node whose
// clock shows every receiver another time.
#include <algorithm>

#include "sim/faults/families.h"
#include "sim/faults/frame_fault.h"

namespace ttf::sim::faults {
namespace {

using ttf::faults::ByzantinePattern;

// A signal never ends before it is sent.
template <class Signal> void shift_by(Signal& signal, Duration shift, TrueTime now) {
  const Duration possible = std::max(shift, now - signal.end);
  signal.start += possible;
  signal.end += possible;
}

std::uint32_t part(const medium::Arriving& signal) {
  return static_cast<std::uint32_t>(2 * index_of(signal.receiver) + index_of(signal.channel));
}

class SosTiming final : public FrameFault {
 public:
  using FrameFault::FrameFault;

  bool leaving(medium::Leaving& signal) override {
    if (!befalls(signal)) return true;
    const std::int64_t shift = fault().shift.ns;
    acted("a frame of {} on {} is {} ns {}", name(signal.sender), letter(signal.channel), shift < 0 ? -shift : shift,
          shift < 0 ? "early" : "late");
    if (fault().receivers.empty()) shift_by(signal, fault().shift, plant().now());
    return true;
  }
  bool arriving(medium::Arriving& signal) override {
    if (!fault().receivers.empty() && befallen_as_sent(signal) && at_receiver(signal.receiver))
      shift_by(signal, fault().shift, plant().now());
    return true;
  }
};

class SosValue final : public FrameFault {
 public:
  using FrameFault::FrameFault;

  bool leaving(medium::Leaving& signal) override {
    if (befalls(signal))
      acted("only some receivers can decode a frame of {} on {}", name(signal.sender), letter(signal.channel));
    return true;
  }
  bool arriving(medium::Arriving& signal) override {
    if (!befallen_as_sent(signal)) return true;
    const bool lost =
        fault().receivers.empty() ? frame_draws(part(signal)).uniform() < 0.5 : at_receiver(signal.receiver);
    if (lost) signal.signal = bus::ports::Signal::kUndecodable;
    return true;
  }
};

class ByzantineClock final : public FrameFault {
 public:
  using FrameFault::FrameFault;

  // It reads the cycle counter.
  bool touches(NodeId sender, schedules::model::Channel) const override { return sender == fault().node; }
  bool leaving(medium::Leaving& signal) override {
    if (!befalls(signal)) return true;
    // The cycle counter is the last six bits of the header.
    other_way_ = (static_cast<unsigned>(signal.bytes[bus::wire::kHeaderBytes - 1]) & 1U) != 0;
    acted("a frame of {} on {} tells every receiver another time", name(signal.sender), letter(signal.channel));
    return true;
  }
  bool arriving(medium::Arriving& signal) override {
    if (befallen_as_sent(signal)) shift_by(signal, lie(signal), plant().now());
    return true;
  }

 private:
  Duration lie(const medium::Arriving& signal) const {
    const Duration most = fault().shift;
    const Duration pull = index_of(signal.receiver) % 2 == 0 ? most : -most;
    switch (fault().pattern) {
      case ByzantinePattern::kRandom: return {frame_draws(part(signal)).integer(-most.ns, most.ns)};
      case ByzantinePattern::kPullApart: return pull;
      case ByzantinePattern::kPullRates: return other_way_ ? -pull : pull;
    }
    return {};
  }

  bool other_way_ = false;
};

}  // namespace

std::unique_ptr<ActiveFault> make_sos_timing(const FaultSetting& setting) {
  return std::make_unique<SosTiming>(setting);
}
std::unique_ptr<ActiveFault> make_sos_value(const FaultSetting& setting) { return std::make_unique<SosValue>(setting); }
std::unique_ptr<ActiveFault> make_byzantine_clock(const FaultSetting& setting) {
  return std::make_unique<ByzantineClock>(setting);
}

}  // namespace ttf::sim::faults
