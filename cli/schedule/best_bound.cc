#include "cli/schedule/best_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace ttf::cli::schedule {
namespace {

using schedules::sequence::BoundChoice;

std::string best_with(const BestBound& asked, double noise_factor, double share) {
  schedules::sequence::TrackingModel model = asked.model;
  model.process_noise *= noise_factor;
  const auto all = choices(asked.request, asked.times, model, share);
  return letters(best(all).sequence, asked.sensors);
}

// Asks the same again, with other noise and other shares.
struct Assumed {
  std::string words;
  double noise_factor = 1.0, share = 0.5;
};
std::vector<Assumed> others_of(const BestBound& asked) {
  std::vector<Assumed> others{{"a tenth of the process noise", 0.1, asked.share},
                              {"ten times the process noise", 10.0, asked.share}};
  for (const double share : {0.25, 0.5, 0.75, 1.0})
    if (share != asked.share) others.push_back({fmt::format("a share of {:g}", share), 1.0, share});
  return others;
}

void print_json(const BestBound& asked, const std::vector<BoundChoice>& all) {
  nlohmann::ordered_json json{{"process_noise", asked.model.process_noise},
                              {"sigma_m", asked.model.sigma},
                              {"share", asked.share},
                              {"choices", nlohmann::ordered_json::array()}};
  const auto row = [&](const BoundChoice& choice) {
    return nlohmann::ordered_json{{"sequence", letters(choice.sequence, asked.sensors)},
                                  {"bound_from_ms", in_ms(choice.least_bound)},
                                  {"frame_ms", in_ms(frame_time(choice.sequence, asked.times))},
                                  {"interest_rms_m", std::sqrt(choice.interest)},
                                  {"others_rms_m", std::sqrt(choice.others)},
                                  {"rms_m", std::sqrt(choice.cost)}};
  };
  for (const BoundChoice& choice : all) json["choices"].push_back(row(choice));
  json["best"] = row(best(all));
  for (const Assumed& other : others_of(asked))
    json["best_with"].push_back(
        {{"assumed", other.words}, {"sequence", best_with(asked, other.noise_factor, other.share)}});
  fmt::print("{}\n", json.dump(2));
}

}  // namespace

void print_best_bound(const BestBound& asked) {
  const std::vector<BoundChoice> all = choices(asked.request, asked.times, asked.model, asked.share);
  if (asked.json) return print_json(asked, all);
  const BoundChoice& found = best(all);
  std::size_t wide = std::string_view("sequence").size();
  for (const BoundChoice& choice : all) wide = std::max(wide, choice.sequence.size());
  fmt::print("expected error of position along one axis [m], for process noise of {:g} m^2/s^3 and sigma of {:g} m\n",
             asked.model.process_noise, asked.model.sigma);
  fmt::print("{:>13}  {:<{}}  {:>10}  {:>11}  {:>6}  {:>8}\n", "beta from [ms]", "sequence", wide, "frame [ms]",
             "of interest", "others", "together");
  for (const BoundChoice& choice : all)
    fmt::print("{:>14.3f}  {:<{}}  {:>10.3f}  {:>11.4f}  {:>6.4f}  {:>8.4f}{}\n", in_ms(choice.least_bound),
               letters(choice.sequence, asked.sensors), wide, in_ms(frame_time(choice.sequence, asked.times)),
               std::sqrt(choice.interest), std::sqrt(choice.others), std::sqrt(choice.cost),
               &choice == &found ? "  <- least" : "");
  fmt::print(
      "best bound: {} with a share of interest of {:g}{}\n", letters(found.sequence, asked.sensors), asked.share,
      &found == &all.back() && all.size() > 1 ? "; it is the last one tried, so a larger bound may be better" : "");
  for (const Assumed& other : others_of(asked))
    fmt::print("  with {}: {}\n", other.words, best_with(asked, other.noise_factor, other.share));
}

}  // namespace ttf::cli::schedule
