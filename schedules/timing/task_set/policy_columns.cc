#include "schedules/timing/task_set/policy_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/decimal.h"
#include "schedules/timing/response/can.h"

namespace ttf::schedules::timing::task_set {
namespace {

constexpr Range<std::int64_t> kBitRates{10'000, 1'000'000};
// FlexRay's cycles and minislots, with any length of a macrotick (FlexRay 3.0.1, annex B).
constexpr Range<Duration> kFlexRayCycles{Duration::microseconds(10), Duration::milliseconds(16)};
constexpr Range<Duration> kMinislotLengths{Duration::microseconds(1), Duration::microseconds(378)};
constexpr Range<std::int64_t> kMinislots{1, 7'988};
constexpr std::int64_t kRateScale = 1'000'000;
constexpr Range<std::int64_t> kErrorRates{1, 10'000 * kRateScale};  // in 1e-6 a second

std::vector<Policy> policies_of(bool bus) {
  using enum Policy;
  if (bus) return {kCan, kCanExtended, kDynamic, kTdma, kNonPreemptive, kTable};
  return {kPreemptive, kNonPreemptive, kTdma, kTable};
}

// Fails once if the field is blank; then says so, that nothing else is read from it.
bool is_given(Fields& fields, std::string_view column, std::string_view range) {
  if (!fields.is_blank(column)) return true;
  fields.fail(column, fmt::format("is missing: must be {}", range));
  return false;
}

void read_errors(Fields& fields, Resource& can) {
  if (fields.is_blank("errors")) return;
  std::string_view text = fields.text("errors");
  if (text.ends_with("/s")) {
    text.remove_suffix(2);
    const std::optional<std::int64_t> rate = parse_scaled(text, kRateScale);
    if (rate && kErrorRates.contains(*rate)) {
      can.errors_per_s = static_cast<double>(*rate) / kRateScale;
      return;
    }
  } else if (const std::optional<Duration> apart = parse_duration(text); apart && kPeriods.contains(*apart)) {
    can.errors_apart = apart;
    return;
  }
  fields.fail("errors",
              "must be the least time between two errors, 1 us..1000 s, or their rate at random, 0.000001/s..10000/s");
}

void read_segment(Fields& fields, Resource& bus) {
  bus.cycle = fields.needed_duration("cycle", kFlexRayCycles);
  bus.minislots = kMinislots.low;
  if (is_given(fields, "minislots", "the number of minislots, 1..7988"))
    bus.minislots = fields.integer("minislots", kMinislots).value_or(kMinislots.low);
  bus.minislot = fields.needed_duration("minislot", kMinislotLengths);
  const bool cycle_is_right = parse_duration(fields.text("cycle")) == bus.cycle;  // one mistake has one sentence
  if (cycle_is_right && bus.minislot * bus.minislots > bus.cycle)
    fields.fail("minislots", fmt::format("must fit the cycle: {} of {} are longer than {}", bus.minislots,
                                         duration_words(bus.minislot), duration_words(bus.cycle)));
  if (!fields.is_blank("decision")) bus.decides_at_start = fields.choice("decision", {"turn", "start"}) == 1;
}

void read_bus(Fields& fields, Resource& bus) {
  if (bus.is_can()) {
    if (is_given(fields, "bit rate", "10000..1000000 bit/s"))
      bus.bit_rate = fields.integer("bit rate", kBitRates, "bit/s").value_or(kBitRates.low);
    else
      bus.bit_rate = kBitRates.low;
    read_errors(fields, bus);
  } else {
    fields.must_be_blank("bit rate", "only a CAN has one");
    fields.must_be_blank("errors", "only a CAN has them");
  }
  if (bus.policy == Policy::kDynamic) return read_segment(fields, bus);
  for (const std::string_view column : {"minislots", "minislot", "decision"})
    fields.must_be_blank(column, "only a dynamic segment has it");
}

constexpr Range<Duration> kWork{Duration{1}, kLongestTime};
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr int kMostRepetition = 64;
constexpr std::int64_t kLargestDynamicSlot = 2'047;

void read_time(Fields& fields, Task& one) {
  one.worst = fields.needed_duration("worst", kWork);
  one.best = fields.duration("best", kDelays).value_or(Duration{});
  if (one.best > one.worst && !fields.is_blank("worst"))
    fields.fail("best", fmt::format("must be at most the worst case of {}", duration_words(one.worst)));
}

// Stuff bits are at most one in four of the bits from the start of frame to the CRC: the rest of can_frame_bits().
void read_can_frame(Fields& fields, const Resource& can, Task& one) {
  fields.must_be_blank("best", "the payload of a frame is its worst case");
  if (fields.is_blank("worst")) fields.fail("worst", "is missing: must be a payload of 0..8 bytes");
  const auto bytes = static_cast<int>(fields.integer("worst", {0, 8}, "bytes").value_or(0));
  const bool is_short = can.policy == Policy::kCan;
  const auto identifier = is_short ? response::CanIdentifier::k11Bits : response::CanIdentifier::k29Bits;
  const std::int64_t unstuffed = (is_short ? 47 : 67) + 8 * bytes;
  one.best = Duration{unstuffed * kNsPerSecond / can.bit_rate};  // rounded down: no frame is shorter
  one.worst = Duration{response::can_time_ns(response::can_frame_bits(identifier, bytes), can.bit_rate)};
}

// "1/4": in every fourth cycle, from cycle 1 on.
void read_cycles(Fields& fields, Task& one) {
  if (fields.is_blank("cycles")) return;
  const std::string& text = fields.text("cycles");
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::int64_t base = parse_scaled(text.substr(0, slash), 1).value_or(-1);
  const std::int64_t repetition = slash < text.size() ? parse_scaled(text.substr(slash + 1), 1).value_or(0) : 0;
  const bool power_of_two = (repetition & (repetition - 1)) == 0;
  if (repetition < 1 || repetition > kMostRepetition || !power_of_two || base < 0 || base >= repetition)
    return fields.fail("cycles",
                       "must be BASE/REPETITION, as in 1/4: a repetition of 1, 2, 4, ..., 64 and a base below it");
  one.base_cycle = static_cast<int>(base);
  one.repetition = static_cast<int>(repetition);
}

void read_dynamic_frame(Fields& fields, const Resource& bus, Task& one) {
  const Range<std::int64_t> lengths{1, bus.minislots};
  if (fields.is_blank("worst"))
    fields.fail("worst", fmt::format("is missing: must be a length of 1..{} minislots", bus.minislots));
  one.minislots = fields.integer("worst", lengths, "minislots").value_or(1);
  const std::int64_t best = fields.integer("best", {0, one.minislots}, "minislots").value_or(0);
  one.worst = bus.minislot * one.minislots;
  one.best = bus.minislot * best;
  read_cycles(fields, one);
  const std::int64_t latest = bus.minislots - one.minislots + 1;
  one.latest_tx = fields.integer("latest tx", {1, latest}).value_or(latest);
  if (fields.is_blank("priority"))
    fields.fail("priority", "is missing: must be the slot's number in the dynamic segment, 1..2047");
  one.priority = fields.integer("priority", {1, kLargestDynamicSlot});
}

void read_tdma_slot(Fields& fields, const Resource& on, Task& one) {
  read_time(fields, one);
  one.slot = fields.needed_duration("slot", {Duration{1}, on.cycle});
  fields.must_be_blank("priority", "each has a slot of its own");
}

void read_table_entry(Fields& fields, Task& one) {
  read_time(fields, one);
  if (fields.is_blank("offset")) fields.fail("offset", "is missing: a table says when each job begins");
  fields.must_be_blank("jitter", "a job begins at its offset");
  fields.must_be_blank("priority", "a table has none");
}

}  // namespace

Resource read_resource(Fields& fields) {
  Resource one;
  one.name = fields.name();
  one.is_bus = fields.text("kind") == "bus";
  const std::vector<Policy> policies = policies_of(one.is_bus);
  std::vector<std::string_view> words;
  for (const Policy policy : policies) words.emplace_back(word(policy));
  one.policy = policies[fields.choice("policy", words)];
  one.clock = fields.text("clock");
  if (one.is_bus) read_bus(fields, one);
  if (one.policy == Policy::kTdma)
    one.cycle = fields.needed_duration("cycle", kPeriods);
  else if (one.policy != Policy::kDynamic)
    fields.must_be_blank("cycle", one.is_bus ? "only tdma and dynamic have one" : "only tdma has one");
  return one;
}

void read_work(Fields& fields, const Resource& on, Task& one) {
  if (on.policy != Policy::kTdma) fields.must_be_blank("slot", "only tdma has one");
  if (on.policy != Policy::kDynamic)
    for (const std::string_view column : {"cycles", "latest tx"})
      fields.must_be_blank(column, "only a dynamic segment has it");
  switch (on.policy) {
    case Policy::kDynamic: return read_dynamic_frame(fields, on, one);
    case Policy::kTdma: return read_tdma_slot(fields, on, one);
    case Policy::kTable: return read_table_entry(fields, one);
    case Policy::kCan:
    case Policy::kCanExtended: read_can_frame(fields, on, one); break;
    case Policy::kPreemptive:
    case Policy::kNonPreemptive: read_time(fields, one); break;
  }
  one.priority = fields.integer("priority", {0, on.policy == Policy::kCan ? 2047 : 536'870'911});
}

}  // namespace ttf::schedules::timing::task_set
