// Writes faults as they are read (fault_loader.cc): the keys that a kind has, in exact units.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "core/check.h"
#include "faults/plan.h"

namespace ttf::faults {
namespace {

template <class Value, std::size_t N> std::string_view name_in(const std::array<Named<Value>, N>& names, Value value) {
  for (const Named<Value>& one : names)
    if (one.value == value) return one.name;
  TTF_CHECK(false, "no name of {}", static_cast<int>(value));
}

std::string duration_text(Duration duration) { return fmt::format("{} ns", duration.ns); }

class KeyWriter {
 public:
  KeyWriter(const Fault& fault, const schedules::model::Cluster& cluster) : fault_(fault), cluster_(cluster) {}

  std::vector<std::pair<std::string_view, std::string>> keys() {
    parameters();
    return std::move(keys_);
  }

 private:
  template <class Value> void add(std::string_view key, const Value& value) {
    keys_.emplace_back(key, fmt::format("{}", value));
  }
  void window() {
    add("from", duration_text(fault_.from));
    if (fault_.duration != Fault::kToTheEnd) add("duration", duration_text(fault_.duration));
  }
  void channels() { add("channels", schedules::model::channels_text(fault_.channels)); }
  void occasions() {
    add("probability", fault_.probability);  // as many digits as make it this very number
    add("every", fault_.every);
  }
  void receivers() {
    std::vector<std::string_view> names;
    for (const NodeId node : fault_.receivers) names.push_back(cluster_.node(node).name);
    if (!names.empty()) add("receivers", fmt::format("[{}]", fmt::join(names, ", ")));
  }
  void bursts() {
    add("interval", duration_text(fault_.interval));
    add("jitter", duration_text(fault_.jitter));
  }
  void frames() {
    occasions();
    channels();
    window();
  }

  void parameters() {
    switch (fault_.kind) {
      case FaultKind::kCrash: return window();
      case FaultKind::kOmission: add("direction", name_in(kDirectionNames, fault_.direction)); return frames();
      case FaultKind::kBabblingIdiot:
        add("signal", name_in(kSignalNames, fault_.signal));
        if (fault_.signal == FaultSignal::kNoise) add("length", duration_text(fault_.length));
        bursts();
        channels();
        return window();
      case FaultKind::kMasquerading:
        add("mode", name_in(kMasqueradeNames, fault_.masquerade));
        add("slot", fault_.slot);
        return frames();
      case FaultKind::kSosTiming:
        add("shift", duration_text(fault_.shift));
        receivers();
        return frames();
      case FaultKind::kSosValue: receivers(); return frames();
      case FaultKind::kBitFlipHeader:
      case FaultKind::kBitFlipPayload:
      case FaultKind::kBitFlipTrailer:
        if (fault_.bits.empty())
          add("flips", fault_.flips);
        else
          add("bits", fmt::format("[{}]", fmt::join(fault_.bits, ", ")));
        receivers();
        return frames();
      case FaultKind::kChannelSwap: occasions(); return window();
      case FaultKind::kByzantineClock:
        add("shift", duration_text(fault_.shift));
        add("pattern", name_in(kPatternNames, fault_.pattern));
        return window();
      case FaultKind::kDrift: {
        const std::int64_t ppb = std::abs(fault_.drift_ppb);
        add("drift", fmt::format("{}{}.{:03}", fault_.drift_ppb < 0 ? "-" : "", ppb / 1000, ppb % 1000));
        return add("from", duration_text(fault_.from));
      }
      case FaultKind::kLoneColdstart: add("others", name_in(kAllOthersNames, fault_.all_others)); return window();
      case FaultKind::kDuplicateColdstart: return duplicate();
      case FaultKind::kWrongSchedule:
        add("mode", name_in(kWrongScheduleNames, fault_.wrong));
        return fault_.wrong == WrongSchedule::kKeySlot ? add("slot", fault_.slot) : add("by", fault_.by);
      case FaultKind::kNoise:
        add("length", duration_text(fault_.length));
        bursts();
        channels();
        return window();
      case FaultKind::kTransient: channels(); return window();
    }
  }
  void duplicate() {
    add("mode", name_in(kDuplicateNames, fault_.duplicate));
    if (fault_.duplicate == DuplicateMode::kSameKeySlot) {
      if (fault_.slot != 0) add("slot", fault_.slot);
      return;
    }
    if (fault_.duplicate == DuplicateMode::kCas) bursts();
    channels();
    window();
  }

  const Fault& fault_;
  const schedules::model::Cluster& cluster_;
  std::vector<std::pair<std::string_view, std::string>> keys_;
};

}  // namespace

std::vector<std::pair<std::string_view, std::string>> keys_of(const Fault& fault,
                                                              const schedules::model::Cluster& cluster) {
  return KeyWriter(fault, cluster).keys();
}

std::string entry_of(const Fault& fault, const schedules::model::Cluster& cluster) {
  std::string text = fmt::format("{{kind: {}", name_of(fault.kind));
  if (fault.node != kNoNode) text += fmt::format(", node: {}", cluster.node(fault.node).name);
  for (const auto& [key, value] : keys_of(fault, cluster)) text += fmt::format(", {}: {}", key, value);
  return text + '}';
}

}  // namespace ttf::faults
