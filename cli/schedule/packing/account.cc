#include "cli/schedule/packing/account.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "core/decimal.h"
#include "schedules/packing/variants/use.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using schedules::model::Channel;
using table::variants::VariantUse;

double free_percent_of(const VariantUse& use) {
  return use.bins.empty() ? 0.0 : 100.0 * (1.0 - use.load / static_cast<double>(use.bins.size()));
}

// The slots of the fuller channel.
int slots_of(const Account& account, const VariantUse& use) {
  std::vector<table::SlotNumber> numbers;
  for (const int bin : use.bins) numbers.push_back(account.numbers[static_cast<std::size_t>(bin)]);
  return std::max(slots_on(numbers, Channel::kA), slots_on(numbers, Channel::kB));
}

int on_fuller_channel(const Account& account, int bins) {
  return account.use == table::ChannelUse::kIndependent ? (bins + 1) / 2 : bins;
}

// A table with a line for each variant, in place of that of nodes.
std::string variants_table(const Account& account) {
  const std::vector<std::string>& names = account.file.instance.variants;
  std::size_t width = 7;
  for (const std::string& name : names) width = std::max(width, name.size());
  std::string text = fmt::format("{:<{}}  signals     load  at least  slots  free [%]\n", "variant", width);
  const auto uses = table::variants::uses(account.file.instance, account.solution.places);
  for (std::size_t i = 0; i < uses.size(); ++i)
    text +=
        fmt::format("{:<{}}  {:>7}  {:>7.3f}  {:>8}  {:>5}  {:>8.1f}\n", names[i], width, uses[i].signals, uses[i].load,
                    on_fuller_channel(account, uses[i].bound), slots_of(account, uses[i]), free_percent_of(uses[i]));
  return text;
}

// The slots that all signals need as those of one vehicle.
int slots_as_one_vehicle(const Account& account) { return on_fuller_channel(account, account.one_vehicle->bins); }

// A sentence on them.
std::string saving_text(const Account& account) {
  const table::Solution& one = *account.one_vehicle;
  const int slots = slots_as_one_vehicle(account), saved = slots - account.slots_needed();
  const std::string needs =
      fmt::format("as signals of one vehicle, all need {} slots{}", slots, one.proven() ? "" : " by the packing found");
  if (saved < 0) return fmt::format("{}: the places that stand cost {} more\n", needs, -saved);
  return fmt::format("{}: the variants save {}\n", needs, saved);
}

nlohmann::ordered_json variants_json(const Account& account) {
  auto json = nlohmann::ordered_json::array();
  const auto uses = table::variants::uses(account.file.instance, account.solution.places);
  for (std::size_t i = 0; i < uses.size(); ++i)
    json.push_back({{"variant", account.file.instance.variants[i]},
                    {"signals", uses[i].signals},
                    {"load", uses[i].load},
                    {"least_slots", on_fuller_channel(account, uses[i].bound)},
                    {"slots", slots_of(account, uses[i])},
                    {"free_percent", free_percent_of(uses[i])}});
  return json;
}

std::string milliseconds_text(Duration time) { return scaled_text(time.ns, 1'000'000); }

std::string part_name(const Account& account, const table::Part& part) {
  return part.nodes.size() == 1 && !account.file.instance.shared_slots
             ? account.file.instance.nodes[static_cast<std::size_t>(part.nodes.front())]
             : "all";
}

// The free bits of a part's bins, in percent of all their bits.
double free_percent(const Account& account, const table::Part& part) {
  const double bits = static_cast<double>(account.file.shape.cycles * account.file.shape.payload_bits) * part.bins;
  return part.bins == 0 ? 0.0 : 100.0 * (1.0 - static_cast<double>(part.used_bits) / bits);
}

std::string parts_text(const Account& account) {
  std::size_t width = 4;
  for (const table::Part& part : account.solution.parts) width = std::max(width, part_name(account, part).size());
  std::string text = fmt::format("{:<{}}  signals     load  at least  slots  free [%]  order\n", "node", width);
  for (const table::Part& part : account.solution.parts)
    text += fmt::format("{:<{}}  {:>7}  {:>7.3f}  {:>8}  {:>5}  {:>8.1f}  {}\n", part_name(account, part), width,
                        part.signals, part.load, part.bound, part.bins, free_percent(account, part), part.how);
  return text;
}

std::string verdict_text(const Account& account) {
  const int slots = account.slots_needed(), least = account.least_slots();
  const std::string where = account.use == table::ChannelUse::kOne    ? "static slots"
                            : account.use == table::ChannelUse::kSame ? "static slots, on both channels"
                                                                      : "static slots on the fuller channel";
  if (slots == least)
    return fmt::format("{} {}: proven to be the fewest, {}\n", slots, where,
                       account.standing > 0 ? "beside the places that stand" : "the bound is as many");
  return fmt::format("{} {}: at most {} more than needed, as {} has fewer than {}\n", slots, where, slots - least,
                     no_packing(account), least);
}

std::string room_text(const Account& account) {
  std::size_t width = 4;
  for (const std::string& node : account.file.instance.nodes) width = std::max(width, node.size());
  std::string text =
      fmt::format("room for further signals of {} bits in these slots, all of one period [ms]{}:\n{:<{}}",
                  account.room_bits, account.one_vehicle != nullptr ? " and in all variants" : "", "node", width);
  for (int times = 1; times <= account.file.shape.cycles; times *= 2)
    text += fmt::format("  {:>7}", milliseconds_text(account.file.shape.cycle * times));
  text += '\n';
  for (const table::Room& room : account.rooms) {
    text += fmt::format("{:<{}}", account.file.instance.nodes[static_cast<std::size_t>(room.node)], width);
    for (const int signals : room.signals) text += fmt::format("  {:>7}", signals);
    text += '\n';
  }
  return text;
}

std::string variants_words(std::size_t variants) {
  return variants == 0 ? "" : fmt::format(" in {} variant{}", variants, variants == 1 ? "" : "s");
}

nlohmann::ordered_json parts_json(const Account& account) {
  auto json = nlohmann::ordered_json::array();
  for (const table::Part& part : account.solution.parts) {
    nlohmann::ordered_json nodes = nlohmann::ordered_json::array();
    for (const int node : part.nodes) nodes.push_back(account.file.instance.nodes[static_cast<std::size_t>(node)]);
    json.push_back({{"nodes", std::move(nodes)},
                    {"signals", part.signals},
                    {"load", part.load},
                    {"least_slots", part.bound},
                    {"slots", part.bins},
                    {"proven", part.proven()},
                    {"free_percent", free_percent(account, part)},
                    {"order", part.how}});
  }
  return json;
}

}  // namespace

int Account::last_slot() const {
  const int given = slots.value_or(table::kLastStaticSlot + 1);
  return std::min(first_slot + given - 1, table::kLastStaticSlot);
}

int Account::highest_slot() const {
  int highest = 0;
  for (const table::SlotNumber& number : numbers) highest = std::max(highest, number.slot);
  return highest;
}

int Account::free_slots() const {
  std::set<int> used;
  for (const table::SlotNumber& number : numbers)
    if (number.slot >= first_slot && number.slot <= last_slot()) used.insert(number.slot);
  return last_slot() - first_slot + 1 - static_cast<int>(used.size());
}

int Account::slots_needed() const { return std::max(slots_on(numbers, Channel::kA), slots_on(numbers, Channel::kB)); }

int Account::least_slots() const {
  const int bins = solution.bound();
  if (use != table::ChannelUse::kIndependent) return bins;
  // Places that stand may fill one channel more than the other.
  std::vector<table::SlotNumber> fewest = numbers;
  fewest.resize(static_cast<std::size_t>(std::min<int>(bins, static_cast<int>(numbers.size()))));
  return std::max(slots_on(fewest, Channel::kA), slots_on(fewest, Channel::kB));
}

std::string no_packing(const Account& account) {
  return account.standing > 0 ? "no packing that keeps the places that stand" : "no packing";
}

std::string account_text(const Account& account) {
  const TableShape& shape = account.file.shape;
  std::string text = fmt::format("{} signals of {} {}{} in frames of {} bits, {} {} of {} ms{}\n",
                                 account.file.instance.signals.size(), account.file.instance.nodes.size(),
                                 account.file.instance.nodes.size() == 1 ? "node" : "nodes",
                                 variants_words(account.file.instance.variants.size()), shape.payload_bits,
                                 shape.cycles, shape.cycles == 1 ? "cycle" : "cycles", milliseconds_text(shape.cycle),
                                 shape.shared_slots ? ", slots shared among nodes" : "");
  if (account.standing > 0)
    text += fmt::format("{} signals stand at their places, {} are new\n", account.standing,
                        std::count_if(account.solution.places.begin(), account.solution.places.end(),
                                      [](const auto& place) { return place.has_value(); }) -
                            account.standing);
  if (account.one_vehicle != nullptr)
    text += variants_table(account) + verdict_text(account) + saving_text(account);
  else
    text += parts_text(account) + verdict_text(account);
  if (account.slots && account.suffices())
    text += fmt::format("{} of the {} static slots given are free\n", account.free_slots(), *account.slots);
  return text + room_text(account);
}

std::string account_json(const Account& account) {
  nlohmann::ordered_json json{{"signals", account.file.instance.signals.size()},
                              {"standing", account.standing},
                              {"slots", account.slots_needed()},
                              {"least_slots", account.least_slots()},
                              {"proven", account.slots_needed() == account.least_slots()},
                              {"without_place", nlohmann::ordered_json::array()}};
  if (account.one_vehicle != nullptr) {
    json["variants"] = variants_json(account);
    json["slots_as_one_vehicle"] = slots_as_one_vehicle(account);
  } else {
    json["parts"] = parts_json(account);
  }
  json["room"] = nlohmann::ordered_json::array();
  for (const Finding& finding : account.file.impossible)
    json["without_place"].push_back({{"signal", finding.value}, {"line", finding.line}, {"why", finding.expected}});
  for (const table::Room& room : account.rooms)
    json["room"].push_back({{"node", account.file.instance.nodes[static_cast<std::size_t>(room.node)]},
                            {"free_bits", room.free_bits},
                            {"bits", account.room_bits},
                            {"signals_by_repetition", room.signals}});
  if (account.slots) json["slots_free"] = account.suffices() ? account.free_slots() : 0;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace ttf::cli::schedule::packing
