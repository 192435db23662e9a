#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "bus/socketcan/schedule_on_can.h"
#include "cli/decimal_option.h"
#include "cli/schedule/checks.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/model/limits.h"

namespace ttf::cli::schedule {
namespace {

using bus::socketcan::SlotOnCan;
using schedules::check::kLargestTimeScale;
using schedules::check::kTimeScaleOne;

// Parses "500k", "1M" or "1000000" into bit/s; no value for other text.
std::optional<std::int64_t> bit_rate(std::string_view text) {
  std::int64_t scale = 1;
  if (text.ends_with('k')) scale = 1'000;
  if (text.ends_with('M')) scale = 1'000'000;
  if (scale > 1) text.remove_suffix(1);
  return parse_scaled(text, scale);
}

bus::socketcan::BitRates bit_rates(const std::string& medium) {
  constexpr std::string_view kPrefix = "can-fd:";
  const auto refuse = [&](const std::string& expected) {
    return InputError({"command line", 0, "--medium", medium, expected});
  };
  if (medium == "can" || medium.starts_with("can:"))
    throw refuse(
        "must be can-fd: a frame of classic CAN holds 8 bytes, no more than a FlexRay frame's header and "
        "CRC");
  const std::size_t slash = medium.find('/');
  const bool formed = medium.starts_with(kPrefix) && slash != std::string::npos;
  const std::string_view text = medium;
  const auto nominal = formed ? bit_rate(text.substr(kPrefix.size(), slash - kPrefix.size())) : std::nullopt;
  const auto data = formed ? bit_rate(text.substr(slash + 1)) : std::nullopt;
  if (!nominal || !data || *nominal < schedules::model::kSlowestCan || *nominal > schedules::model::kFastestNominal ||
      *data < *nominal || *data > schedules::model::kFastestData)
    throw refuse(
        fmt::format("must be can-fd:NOMINAL/DATA in bit/s, as in can-fd:1M/5M: nominal {}..{}, data from nominal to {}",
                    schedules::model::kSlowestCan, schedules::model::kFastestNominal, schedules::model::kFastestData));
  return {*nominal, *data};
}

struct Verdict {
  std::string medium;
  bus::socketcan::BitRates rates;
  std::int64_t time_scale = kTimeScaleOne,
               smallest = kTimeScaleOne;  // ppm; `smallest` is the least at which every slot holds
  std::vector<SlotOnCan> slots, not_holding;
  Duration longest{};  // among all frames
  std::optional<schedules::model::ArrivalWindow> window;

  bool window_holds() const { return !window || longest <= window->late; }
  bool holds() const { return not_holding.empty() && window_holds(); }
  Duration has(const SlotOnCan& slot) const { return schedules::check::stretched(slot.has, time_scale); }
};

Verdict judged(const schedules::model::Cluster& cluster, const MediumArguments& arguments) {
  Verdict verdict;
  verdict.medium = *arguments.medium;
  verdict.rates = bit_rates(*arguments.medium);
  if (arguments.time_scale) verdict.time_scale = time_scale_option(*arguments.time_scale);
  verdict.slots = bus::socketcan::slots_on_can(cluster, verdict.rates);
  verdict.smallest = bus::socketcan::smallest_time_scale(verdict.slots);
  verdict.window = cluster.arrival_window;
  for (const SlotOnCan& slot : verdict.slots) {
    verdict.longest = std::max(verdict.longest, slot.frame);
    if (!slot.holds(verdict.time_scale)) verdict.not_holding.push_back(slot);
  }
  return verdict;
}

void print_json(const schedules::model::Cluster& cluster, const Verdict& verdict) {
  nlohmann::ordered_json json{{"cluster", cluster.name},
                              {"medium", verdict.medium},
                              {"nominal_bit_rate", verdict.rates.nominal},
                              {"data_bit_rate", verdict.rates.data},
                              {"time_scale", static_cast<double>(verdict.time_scale) * 1e-6},
                              {"holds", verdict.holds()},
                              {"smallest_time_scale", nullptr},
                              {"slots", verdict.slots.size()},
                              {"not_holding", nlohmann::ordered_json::array()},
                              {"longest_frame_us", in_us(verdict.longest)},
                              {"late_us", nullptr},
                              {"window_holds", verdict.window_holds()}};
  if (verdict.smallest <= kLargestTimeScale) json["smallest_time_scale"] = static_cast<double>(verdict.smallest) * 1e-6;
  if (verdict.window) json["late_us"] = in_us(verdict.window->late);
  for (const SlotOnCan& slot : verdict.not_holding)
    json["not_holding"].push_back({{"slot", slot.slot},
                                   {"segment", slot.dynamic ? "dynamic" : "static"},
                                   {"channels", schedules::model::channels_text(slot.channels)},
                                   {"can_frames", slot.can_frames},
                                   {"needs_us", in_us(slot.needs)},
                                   {"has_us", in_us(verdict.has(slot))}});
  fmt::print("{}\n", json.dump(2));
}

bool alike(const SlotOnCan& a, const SlotOnCan& b) {
  return b.slot == a.slot + 1 && a.channels == b.channels && a.dynamic == b.dynamic && a.can_frames == b.can_frames &&
         a.needs == b.needs && a.has == b.has;
}

// Writes the table; consecutive slots with equal values share a line.
std::string table(const Verdict& verdict) {
  std::string text =
      fmt::format("{:>11}  {:<2}  {:>10}  {:>10}  {:>10}\n", "slots", "ch", "CAN frames", "needs [us]", "has [us]");
  const auto& slots = verdict.not_holding;
  for (std::size_t i = 0; i < slots.size();) {
    std::size_t end = i + 1;
    while (end < slots.size() && alike(slots[end - 1], slots[end])) ++end;
    const std::string numbers =
        end - i == 1 ? fmt::format("{}", slots[i].slot) : fmt::format("{}-{}", slots[i].slot, slots[end - 1].slot);
    text += fmt::format("{:>11}  {:<2}  {:>10}  {:>10.1f}  {:>10.1f}{}\n", numbers,
                        schedules::model::channels_text(slots[i].channels), slots[i].can_frames, in_us(slots[i].needs),
                        in_us(verdict.has(slots[i])), slots[i].dynamic ? "  dynamic" : "");
    i = end;
  }
  return text;
}

void print_text(const schedules::model::Cluster& cluster, const Verdict& verdict) {
  const std::string where = fmt::format("{} on {} at time scale {}", cluster.name, verdict.medium,
                                        schedules::check::time_scale_text(verdict.time_scale));
  if (verdict.not_holding.empty())
    fmt::print("{}: all {} slots hold\n", where, verdict.slots.size());
  else
    fmt::print("{}: {} of {} slots do not hold\n{}", where, verdict.not_holding.size(), verdict.slots.size(),
               table(verdict));
  if (verdict.smallest > kLargestTimeScale)
    fmt::print("no time scale up to {} makes them hold\n", schedules::check::time_scale_text(kLargestTimeScale));
  else
    fmt::print("smallest time scale at which all hold: {}\n", schedules::check::time_scale_text(verdict.smallest));
  if (!verdict.window_holds())
    fmt::print(
        "every frame of {:.1f} us comes too late: real_time.late is {:g} us after the action point, at any "
        "time scale\n",
        in_us(verdict.longest), in_us(verdict.window->late));
}

}  // namespace

void add_medium_arguments(CLI::App& command, MediumArguments& arguments) {
  CLI::Option* medium = command.add_option(
      "--medium", arguments.medium,
      "can-fd:NOMINAL/DATA in bit/s, as in can-fd:1M/5M: list the slots that do not hold on such a CAN");
  command
      .add_option("--time-scale", arguments.time_scale, "With --medium: the schedule stretched in real time, 0.1..1000")
      ->needs(medium);
}

int check_on_medium(const schedules::model::Cluster& cluster, const MediumArguments& arguments, bool json) {
  const Verdict verdict = judged(cluster, arguments);
  if (json)
    print_json(cluster, verdict);
  else
    print_text(cluster, verdict);
  return verdict.holds() ? 0 : 1;
}

}  // namespace ttf::cli::schedule
