#include "cli/schedule/packing/variant_account.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "schedules/packing/variants/use.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using table::variants::VariantUse;

double free_percent_of(const VariantUse& use) {
  return use.bins.empty() ? 0.0 : 100.0 * (1.0 - use.load / static_cast<double>(use.bins.size()));
}

// The slots of the fuller channel.
int slots_of(const Account& account, const VariantUse& use) {
  std::vector<table::SlotNumber> numbers;
  for (const int bin : use.bins) numbers.push_back(account.numbers[static_cast<std::size_t>(bin)]);
  return std::max(slots_on(numbers, schedules::model::Channel::kA), slots_on(numbers, schedules::model::Channel::kB));
}

int on_fuller_channel(const Account& account, int bins) {
  return account.use == table::ChannelUse::kIndependent ? (bins + 1) / 2 : bins;
}

}  // namespace

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

int slots_as_one_vehicle(const Account& account) { return on_fuller_channel(account, account.one_vehicle->bins); }

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

}  // namespace ttf::cli::schedule::packing
