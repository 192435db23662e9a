#include "faults/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/check.h"

namespace ttf::faults {
namespace {

using schedules::model::Channels;

constexpr Range<Duration> kFaultDurations{Duration::nanoseconds(1), Duration::milliseconds(3'600'000)};
// At most the length of the shortest frame (frame_bits() without payload), so that a frame never arrives before
// it leaves.
constexpr Duration kMostEarly = Duration::microseconds(9);
constexpr std::int64_t kMostCanIdentifier = 2047;
constexpr int kMostCanBits = 707;  // behind the start of frame, in the longest frame of CAN FD
constexpr int kFrameHeaderBits = 40, kMostPayloadBits = 127 * 16, kFrameTrailerBits = 24;

// The arguments of reading and of writing.
struct Reading {
  YamlMap& yaml;
  Fault& fault;
  Duration latest;  // the largest permitted `from`
};
struct Writing {
  std::vector<std::pair<std::string_view, std::string>>& keys;
  const Fault& fault;
  const schedules::model::Cluster& cluster;
  std::string (*time_text)(Duration);

  template <class Value> void add(std::string_view key, const Value& value) const {
    keys.emplace_back(key, fmt::format("{}", value));
  }
  void add(std::string_view key, Duration duration) const { add(key, time_text(duration)); }
};

// The names of an enumeration's values.
template <class Value> struct Named {
  std::string_view name;
  Value value;
};
constexpr std::array<Named<Channels>, 3> kChannelNames{
    {{"A", Channels::kA}, {"B", Channels::kB}, {"AB", Channels::kAB}}};
constexpr std::array<Named<FaultDirection>, 3> kDirectionNames{
    {{"send", FaultDirection::kSend}, {"receive", FaultDirection::kReceive}, {"both", FaultDirection::kBoth}}};
constexpr std::array<Named<FaultSignal>, 2> kSignalNames{
    {{"noise", FaultSignal::kNoise}, {"frame", FaultSignal::kFrame}}};
constexpr std::array<Named<MasqueradeMode>, 2> kMasqueradeNames{
    {{"in_slot", MasqueradeMode::kInSlot}, {"own_slot", MasqueradeMode::kOwnSlot}}};
constexpr std::array<Named<ByzantinePattern>, 3> kPatternNames{{{"random", ByzantinePattern::kRandom},
                                                                {"pull_apart", ByzantinePattern::kPullApart},
                                                                {"pull_rates", ByzantinePattern::kPullRates}}};
constexpr std::array<Named<DuplicateMode>, 3> kDuplicateNames{{{"cas", DuplicateMode::kCas},
                                                               {"startup_frames", DuplicateMode::kStartupFrames},
                                                               {"same_key_slot", DuplicateMode::kSameKeySlot}}};
constexpr std::array<Named<WrongSchedule>, 5> kWrongScheduleNames{{{"shifted_slots", WrongSchedule::kShiftedSlots},
                                                                   {"cycle_length", WrongSchedule::kCycleLength},
                                                                   {"static_slot", WrongSchedule::kStaticSlot},
                                                                   {"payload_length", WrongSchedule::kPayloadLength},
                                                                   {"key_slot", WrongSchedule::kKeySlot}}};
constexpr std::array<Named<bool>, 2> kAllOthersNames{{{"coldstart", false}, {"all", true}}};

template <class Value, std::size_t N> Choices<Value> choices(const std::array<Named<Value>, N>& names) {
  Choices<Value> all;
  for (const Named<Value>& one : names) all.emplace_back(one.name, one.value);
  return all;
}
template <class Value, std::size_t N> std::string_view name_in(const std::array<Named<Value>, N>& names, Value value) {
  for (const Named<Value>& one : names)
    if (one.value == value) return one.name;
  TTF_CHECK(false, "no name of {}", static_cast<int>(value));
}

void read_from(const Reading& in) {
  in.fault.from = in.yaml.duration_or("from", in.fault.from, {Duration{}, in.latest});
}
void write_from(const Writing& out) { out.add("from", out.fault.from); }

void read_window(const Reading& in) {
  read_from(in);
  in.fault.duration = in.yaml.duration_or("duration", in.fault.duration, kFaultDurations);
}
void read_passing(const Reading& in) {
  read_from(in);
  in.fault.duration = in.yaml.duration("duration", kFaultDurations);
}
void write_window(const Writing& out) {
  write_from(out);
  if (out.fault.duration != Fault::kToTheEnd) out.add("duration", out.fault.duration);
}

void read_channels(const Reading& in) {
  in.fault.channels = in.yaml.choice_or("channels", in.fault.channels, choices(kChannelNames));
}
void write_channels(const Writing& out) { out.add("channels", name_in(kChannelNames, out.fault.channels)); }

void read_occasions(const Reading& in) {
  in.fault.probability = in.yaml.number_or("probability", in.fault.probability, {0.0, 1.0});
  in.fault.every = static_cast<int>(in.yaml.integer_or("every", in.fault.every, {1, 1'000'000}, "frames"));
}
void write_occasions(const Writing& out) {
  out.add("probability", out.fault.probability);  // the shortest digits that parse to the same number
  out.add("every", out.fault.every);
}

void read_receivers(const Reading& in) {
  if (!in.yaml.has("receivers")) return;
  in.fault.receiver_names = in.yaml.texts("receivers");
  std::vector<std::string> names = in.fault.receiver_names;
  std::sort(names.begin(), names.end());
  if (std::adjacent_find(names.begin(), names.end()) != names.end())
    in.yaml.fail("receivers", "must be different nodes");
}
void write_receivers(const Writing& out) {
  std::vector<std::string_view> names;
  for (const NodeId node : out.fault.receivers) names.push_back(out.cluster.node(node).name);
  if (!names.empty()) out.add("receivers", fmt::format("[{}]", fmt::join(names, ", ")));
}

void read_direction(const Reading& in) {
  in.fault.direction = in.yaml.choice_or("direction", in.fault.direction, choices(kDirectionNames));
}
void write_direction(const Writing& out) { out.add("direction", name_in(kDirectionNames, out.fault.direction)); }

void read_signal(const Reading& in) {
  in.fault.signal = in.yaml.choice_or("signal", in.fault.signal, choices(kSignalNames));
}
void write_signal(const Writing& out) { out.add("signal", name_in(kSignalNames, out.fault.signal)); }

void read_length(const Reading& in) {
  in.fault.length =
      in.yaml.duration_or("length", in.fault.length, {Duration::nanoseconds(100), Duration::milliseconds(100)});
}
void write_length(const Writing& out) { out.add("length", out.fault.length); }

void read_bursts(const Reading& in) {
  in.fault.interval = in.yaml.duration_or("interval", in.fault.interval, {Duration{}, kFaultDurations.high});
  in.fault.jitter = in.yaml.duration_or("jitter", in.fault.jitter, {Duration{}, kFaultDurations.high});
}
void write_bursts(const Writing& out) {
  out.add("interval", out.fault.interval);
  out.add("jitter", out.fault.jitter);
}

int read_slot(const Reading& in) { return static_cast<int>(in.yaml.integer("slot", {1, 1023})); }

void read_masquerade(const Reading& in) {
  in.fault.masquerade = in.yaml.choice_or("mode", in.fault.masquerade, choices(kMasqueradeNames));
  in.fault.slot = read_slot(in);
}
void write_masquerade(const Writing& out) {
  out.add("mode", name_in(kMasqueradeNames, out.fault.masquerade));
  out.add("slot", out.fault.slot);
}

void read_shift(const Reading& in) {
  in.fault.shift = in.yaml.duration("shift", {-kMostEarly, Duration::milliseconds(1)});
  if (in.yaml.has("shift") && in.fault.shift == Duration{})
    in.yaml.fail("shift", "must not be 0: no frame would be late or early");
}
void write_shift(const Writing& out) { out.add("shift", out.fault.shift); }

void read_lie(const Reading& in) {
  in.fault.shift = in.yaml.duration("shift", {Duration::nanoseconds(1), kMostEarly});
  in.fault.pattern = in.yaml.choice_or("pattern", in.fault.pattern, choices(kPatternNames));
}
void write_lie(const Writing& out) {
  out.add("shift", out.fault.shift);
  out.add("pattern", name_in(kPatternNames, out.fault.pattern));
}

// Reads bits of a region of a frame with at most `most_bits` bits.
template <int most_bits> void read_bits(const Reading& in) {
  YamlMap& yaml = in.yaml;
  std::vector<int>& bits = in.fault.bits;
  if (yaml.has("bits") && yaml.has("flips")) yaml.fail("flips", "must not be given with bits, which sets their number");
  if (yaml.has("bits"))
    for (const std::int64_t bit : yaml.integers("bits", {0, most_bits - 1})) bits.push_back(static_cast<int>(bit));
  std::sort(bits.begin(), bits.end());
  if (std::adjacent_find(bits.begin(), bits.end()) != bits.end())
    yaml.fail("bits", "must be different bits: inverting a bit twice restores it");
  in.fault.flips = static_cast<int>(yaml.integer_or("flips", in.fault.flips, {1, 24}));
}
void write_bits(const Writing& out) {
  if (out.fault.bits.empty())
    out.add("flips", out.fault.flips);
  else
    out.add("bits", fmt::format("[{}]", fmt::join(out.fault.bits, ", ")));
}

// In ppm, with a resolution of one ppb.
void read_drift(const Reading& in) {
  in.fault.drift_ppb = in.yaml.scaled("drift", 1000, {-kMostDriftPpb, kMostDriftPpb}, "ppm");
}
void write_drift(const Writing& out) {
  const std::int64_t ppb = std::abs(out.fault.drift_ppb);
  out.add("drift", fmt::format("{}{}.{:03}", out.fault.drift_ppb < 0 ? "-" : "", ppb / 1000, ppb % 1000));
}

void read_others(const Reading& in) {
  in.fault.all_others = in.yaml.choice_or("others", in.fault.all_others, choices(kAllOthersNames));
}
void write_others(const Writing& out) { out.add("others", name_in(kAllOthersNames, out.fault.all_others)); }

void read_duplicate(const Reading& in) {
  in.fault.duplicate = in.yaml.choice_or("mode", in.fault.duplicate, choices(kDuplicateNames));
  if (in.fault.duplicate == DuplicateMode::kSameKeySlot && in.yaml.has("slot")) in.fault.slot = read_slot(in);
}
void write_duplicate(const Writing& out) {
  out.add("mode", name_in(kDuplicateNames, out.fault.duplicate));
  if (out.fault.duplicate == DuplicateMode::kSameKeySlot && out.fault.slot != 0) out.add("slot", out.fault.slot);
}

void read_wrong_schedule(const Reading& in) {
  in.fault.wrong = in.yaml.choice("mode", choices(kWrongScheduleNames));
  const auto by = [&](int most, std::string_view unit) {
    in.fault.by = static_cast<int>(in.yaml.integer("by", {1, most}, unit));
  };
  switch (in.fault.wrong) {
    case WrongSchedule::kShiftedSlots: return by(1022, "slots");
    case WrongSchedule::kCycleLength: return by(1000, "macroticks");
    case WrongSchedule::kStaticSlot: return by(100, "macroticks");
    case WrongSchedule::kPayloadLength: return by(126, "words");
    case WrongSchedule::kKeySlot: in.fault.slot = read_slot(in); return;
  }
}
void write_wrong_schedule(const Writing& out) {
  out.add("mode", name_in(kWrongScheduleNames, out.fault.wrong));
  if (out.fault.wrong == WrongSchedule::kKeySlot)
    out.add("slot", out.fault.slot);
  else
    out.add("by", out.fault.by);
}

void read_can(const Reading& in) { in.fault.can_name = in.yaml.text("can"); }
void write_can(const Writing& out) { out.add("can", out.cluster.can_buses[out.fault.can].name); }

void read_can_bit(const Reading& in) {
  if (in.yaml.has("bit")) in.fault.bit = static_cast<int>(in.yaml.integer("bit", {1, kMostCanBits}));
}
void write_can_bit(const Writing& out) {
  if (out.fault.bit) out.add("bit", *out.fault.bit);
}

void read_identifier(const Reading& in) {
  in.fault.identifier =
      static_cast<std::uint32_t>(in.yaml.integer_or("identifier", in.fault.identifier, {0, kMostCanIdentifier}));
}
void write_identifier(const Writing& out) { out.add("identifier", out.fault.identifier); }

bool in_every_mode(const Fault&) { return true; }
// Only noise has a length; frames and symbols have their own.
bool is_noise(const Fault& fault) { return fault.signal == FaultSignal::kNoise; }
bool comes_in_bursts(const Fault& fault) { return fault.duplicate == DuplicateMode::kCas; }
// A believed schedule holds from the beginning to the end, on all channels.
bool is_no_belief(const Fault& fault) { return fault.duplicate != DuplicateMode::kSameKeySlot; }

struct ParameterRow {
  FaultParameter parameter{};
  void (*read)(const Reading&);
  void (*write)(const Writing&);
  bool (*applies)(const Fault&) = in_every_mode;
};
using P = FaultParameter;
constexpr std::array<ParameterRow, kFaultParameters> kParameterRows{{
    {P::kNone, [](const Reading&) {}, [](const Writing&) {}},
    {P::kDirection, read_direction, write_direction},
    {P::kSignal, read_signal, write_signal},
    {P::kLength, read_length, write_length, is_noise},
    {P::kBursts, read_bursts, write_bursts, comes_in_bursts},
    {P::kMasquerade, read_masquerade, write_masquerade},
    {P::kShift, read_shift, write_shift},
    {P::kLie, read_lie, write_lie},
    {P::kHeaderBits, read_bits<kFrameHeaderBits>, write_bits},
    {P::kPayloadBits, read_bits<kMostPayloadBits>, write_bits},
    {P::kTrailerBits, read_bits<kFrameTrailerBits>, write_bits},
    {P::kDrift, read_drift, write_drift},
    {P::kOthers, read_others, write_others},
    {P::kDuplicate, read_duplicate, write_duplicate},
    {P::kWrongSchedule, read_wrong_schedule, write_wrong_schedule},
    {P::kReceivers, read_receivers, write_receivers},
    {P::kOccasions, read_occasions, write_occasions},
    {P::kChannels, read_channels, write_channels, is_no_belief},
    {P::kWindow, read_window, write_window, is_no_belief},
    {P::kFrom, read_from, write_from},
    {P::kPassing, read_passing, write_window},
    {P::kCan, read_can, write_can},
    {P::kCanBit, read_can_bit, write_can_bit},
    {P::kIdentifier, read_identifier, write_identifier},
}};
static_assert(is_one_row_a_parameter(kParameterRows), "a parameter without a row, or rows in another order");

const ParameterRow& row_of(FaultParameter parameter) {
  const std::size_t row = index_of(parameter);
  TTF_CHECK(row < kParameterRows.size(), "parameter {}", row);
  return kParameterRows[row];
}

}  // namespace

bool applies(FaultParameter parameter, const Fault& fault) { return row_of(parameter).applies(fault); }

void read_parameters(YamlMap& yaml, Fault& fault, Duration latest) {
  for (const FaultParameter parameter : row_of(fault.kind).parameters)
    if (applies(parameter, fault)) row_of(parameter).read({yaml, fault, latest});
}

void write_parameters(const Fault& fault, const schedules::model::Cluster& cluster, std::string (*time_text)(Duration),
                      std::vector<std::pair<std::string_view, std::string>>& keys) {
  for (const FaultParameter parameter : row_of(fault.kind).parameters)
    if (applies(parameter, fault)) row_of(parameter).write({keys, fault, cluster, time_text});
}

}  // namespace ttf::faults
