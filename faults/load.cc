// Reads faults: which keys a kind has, and what they may be. Whatever else is in an entry is unknown.
#include <algorithm>
#include <array>
#include <utility>

#include "core/check.h"
#include "faults/plan.h"

namespace ttf::faults {
namespace {

using schedules::model::Channels;

constexpr Range<Duration> kDurations{Duration::nanoseconds(1), Duration::milliseconds(3'600'000)};
// Not earlier than the shortest frame is long (frame_bits() of no payload), so that nothing arrives before it leaves.
constexpr Duration kMostEarly = Duration::microseconds(9);

template <class Value, std::size_t N> Choices<Value> choices(const std::array<Named<Value>, N>& names) {
  Choices<Value> all;
  for (const Named<Value>& one : names) all.emplace_back(one.name, one.value);
  return all;
}

void read_window(YamlMap& yaml, Fault& fault, Duration latest) {
  fault.from = yaml.duration_or("from", fault.from, {Duration{}, latest});
  fault.duration = yaml.duration_or("duration", fault.duration, kDurations);
}

void read_channels(YamlMap& yaml, Fault& fault) {
  fault.channels = yaml.choice_or<Channels>("channels", fault.channels,
                                            {{"A", Channels::kA}, {"B", Channels::kB}, {"AB", Channels::kAB}});
}

void read_occasions(YamlMap& yaml, Fault& fault) {
  fault.probability = yaml.number_or("probability", fault.probability, {0.0, 1.0});
  fault.every = static_cast<int>(yaml.integer_or("every", fault.every, {1, 1'000'000}, "frames"));
}

void read_receivers(YamlMap& yaml, Fault& fault) {
  if (!yaml.has("receivers")) return;
  fault.receiver_names = yaml.texts("receivers");
  std::vector<std::string> names = fault.receiver_names;
  std::sort(names.begin(), names.end());
  if (std::adjacent_find(names.begin(), names.end()) != names.end()) yaml.fail("receivers", "must be different nodes");
}

void read_bursts(YamlMap& yaml, Fault& fault) {
  fault.interval = yaml.duration_or("interval", fault.interval, {Duration{}, kDurations.high});
  fault.jitter = yaml.duration_or("jitter", fault.jitter, {Duration{}, kDurations.high});
}

void read_length(YamlMap& yaml, Fault& fault) {
  fault.length = yaml.duration_or("length", fault.length, {Duration::nanoseconds(100), Duration::milliseconds(100)});
}

// `region`: how many bits it has at most.
void read_flips(YamlMap& yaml, Fault& fault, int region) {
  if (yaml.has("bits") && yaml.has("flips"))
    yaml.fail("flips", "must not be given along with bits, which says how many there are");
  if (yaml.has("bits"))
    for (const std::int64_t bit : yaml.integers("bits", {0, region - 1})) fault.bits.push_back(static_cast<int>(bit));
  std::sort(fault.bits.begin(), fault.bits.end());
  if (std::adjacent_find(fault.bits.begin(), fault.bits.end()) != fault.bits.end())
    yaml.fail("bits", "must be different bits: one that is inverted twice is as it was");
  fault.flips = static_cast<int>(yaml.integer_or("flips", fault.flips, {1, 24}));
}

int read_slot(YamlMap& yaml) { return static_cast<int>(yaml.integer("slot", {1, 1023})); }

void read_masquerading(YamlMap& yaml, Fault& fault) {
  fault.masquerade = yaml.choice_or("mode", fault.masquerade, choices(kMasqueradeNames));
  fault.slot = read_slot(yaml);
}

void read_duplicate(YamlMap& yaml, Fault& fault, Duration latest) {
  fault.duplicate = yaml.choice_or("mode", fault.duplicate, choices(kDuplicateNames));
  // A schedule is believed in from the beginning to the end.
  if (fault.duplicate == DuplicateMode::kSameKeySlot) {
    if (yaml.has("slot")) fault.slot = read_slot(yaml);
    return;
  }
  read_window(yaml, fault, latest);
  read_channels(yaml, fault);
  if (fault.duplicate == DuplicateMode::kCas) read_bursts(yaml, fault);
}

void read_wrong_schedule(YamlMap& yaml, Fault& fault) {
  fault.wrong = yaml.choice("mode", choices(kWrongScheduleNames));
  switch (fault.wrong) {
    case WrongSchedule::kShiftedSlots: fault.by = static_cast<int>(yaml.integer("by", {1, 1022}, "slots")); return;
    case WrongSchedule::kCycleLength: fault.by = static_cast<int>(yaml.integer("by", {1, 1000}, "macroticks")); return;
    case WrongSchedule::kStaticSlot: fault.by = static_cast<int>(yaml.integer("by", {1, 100}, "macroticks")); return;
    case WrongSchedule::kPayloadLength: fault.by = static_cast<int>(yaml.integer("by", {1, 126}, "words")); return;
    case WrongSchedule::kKeySlot: fault.slot = read_slot(yaml); return;
  }
}

void read_parameters(YamlMap& yaml, Fault& fault, Duration latest) {
  switch (fault.kind) {
    case FaultKind::kCrash: return read_window(yaml, fault, latest);
    case FaultKind::kOmission:
      fault.direction = yaml.choice_or("direction", fault.direction, choices(kDirectionNames));
      break;
    case FaultKind::kBabblingIdiot:
      fault.signal = yaml.choice_or("signal", fault.signal, choices(kSignalNames));
      if (fault.signal == FaultSignal::kNoise) read_length(yaml, fault);
      read_bursts(yaml, fault);
      read_channels(yaml, fault);
      return read_window(yaml, fault, latest);
    case FaultKind::kMasquerading: read_masquerading(yaml, fault); break;
    case FaultKind::kSosTiming:
      fault.shift = yaml.duration("shift", {-kMostEarly, Duration::milliseconds(1)});
      if (yaml.has("shift") && fault.shift == Duration{})
        yaml.fail("shift", "must not be 0, by which nothing is late or early");
      read_receivers(yaml, fault);
      break;
    case FaultKind::kSosValue: read_receivers(yaml, fault); break;
    case FaultKind::kBitFlipHeader:
      read_flips(yaml, fault, 40);
      read_receivers(yaml, fault);
      break;
    case FaultKind::kBitFlipPayload:
      read_flips(yaml, fault, 127 * 16);
      read_receivers(yaml, fault);
      break;
    case FaultKind::kBitFlipTrailer:
      read_flips(yaml, fault, 24);
      read_receivers(yaml, fault);
      break;
    case FaultKind::kChannelSwap: read_occasions(yaml, fault); return read_window(yaml, fault, latest);
    case FaultKind::kByzantineClock:
      fault.shift = yaml.duration("shift", {Duration::nanoseconds(1), kMostEarly});
      fault.pattern = yaml.choice_or("pattern", fault.pattern, choices(kPatternNames));
      return read_window(yaml, fault, latest);
    case FaultKind::kDrift:
      // In ppm, to the ppb.
      fault.drift_ppb = yaml.scaled("drift", 1000, {-kMostDriftPpb, kMostDriftPpb}, "ppm");
      fault.from = yaml.duration_or("from", fault.from, {Duration{}, latest});
      return;
    case FaultKind::kLoneColdstart:
      fault.all_others = yaml.choice_or("others", fault.all_others, choices(kAllOthersNames));
      return read_window(yaml, fault, latest);
    case FaultKind::kDuplicateColdstart: return read_duplicate(yaml, fault, latest);
    case FaultKind::kWrongSchedule: return read_wrong_schedule(yaml, fault);
    case FaultKind::kNoise:
      read_length(yaml, fault);
      read_bursts(yaml, fault);
      read_channels(yaml, fault);
      return read_window(yaml, fault, latest);
    case FaultKind::kTransient:
      fault.from = yaml.duration_or("from", fault.from, {Duration{}, latest});
      fault.duration = yaml.duration("duration", kDurations);
      return read_channels(yaml, fault);
  }
  // Those that break out change the node's single frames.
  read_occasions(yaml, fault);
  read_channels(yaml, fault);
  read_window(yaml, fault, latest);
}

}  // namespace

Fault load_fault(YamlMap& yaml, Duration latest) {
  Choices<FaultKind> kinds;
  for (const FaultKind kind : kAllFaultKinds) kinds.emplace_back(name_of(kind), kind);
  Fault fault;
  fault.line = yaml.line();
  fault.kind = yaml.choice<FaultKind>("kind", kinds);
  // Of no kind: it cannot be said which other keys are right.
  if (!yaml.has("kind") || yaml.text("kind") != name_of(fault.kind)) return fault;
  if (has_node(fault.kind)) fault.node_name = yaml.text("node");
  read_parameters(yaml, fault, latest);
  yaml.finish();
  return fault;
}

FaultPlan load_fault_plan(YamlMap& yaml, Duration latest) {
  FaultPlan plan;
  plan.file = yaml.file();
  for (YamlMap& entry : yaml.maps_if("faults")) plan.faults.push_back(load_fault(entry, latest));
  return plan;
}

}  // namespace ttf::faults
