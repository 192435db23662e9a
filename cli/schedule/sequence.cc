#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/commands.h"
#include "cli/decimal_option.h"
#include "cli/schedule/sequence_modes.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/strict_yaml.h"
#include "schedules/sequence/expected_error.h"
#include "schedules/sequence/generator.h"
#include "schedules/sequence/intervals.h"

namespace ttf::cli::schedule {
namespace {

using schedules::sequence::BoundChoice;
using schedules::sequence::DetectionTimes;
using schedules::sequence::FrameRequest;
using schedules::sequence::Intervals;
using schedules::sequence::Sequence;
using schedules::sequence::SlotOrder;
using schedules::sequence::SlotRule;

// `ttfusion schedule sequence --best-beta`: the bound of a frame with the least expected error.
struct BestBound {
  FrameRequest request;  // its bound is the largest one that is tried
  DetectionTimes times;
  schedules::sequence::TrackingModel model;
  double share = 0.5;
  std::string sensors;
  bool json = false;
};

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

// Prints all frames up to the bound, and the best of them.
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

struct SequenceOptions {
  std::string sensors, interest, bound, primary, secondary;
  std::string slots = "text", order = "text";
  bool json = false, best_bound = false, yaml = false;
  std::string cluster, task, step = "10ms", offset = "0";
  std::optional<std::string> best_case;
  std::vector<std::string> modes;
  std::string process_noise = "1", sigma = "1", share = "0.5";
};

[[noreturn]] void refuse(const char* option, const std::string& text, const std::string& expected) {
  throw InputError({"command line", 0, option, text, expected});
}

Duration duration(const char* option, const std::string& text, Range<Duration> allowed) {
  const std::optional<Duration> value = parse_duration(text);
  if (!value || !allowed.contains(*value))
    refuse(option, text,
           fmt::format("must be {}..{} s with its unit, as in 200ms", scaled_text(allowed.low.ns, 1'000'000'000),
                       scaled_text(allowed.high.ns, 1'000'000'000)));
  return *value;
}

void check_sensors(const std::string& names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] < 'A' || names[i] > 'Z' || names.find(names[i]) != i)
      refuse("--sensors", names, "must be different capital letters, as in ABC");
}

std::vector<int> interest_of(const SequenceOptions& options) {
  std::vector<int> interest;
  for (std::size_t i = 0; i < options.sensors.size(); ++i)
    if (options.interest.find(options.sensors[i]) != std::string::npos) interest.push_back(static_cast<int>(i));
  if (interest.size() != options.interest.size())
    refuse("--interest", options.interest, fmt::format("must be different letters among {}", options.sensors));
  return interest;
}

// The sequence with all that is printed of it.
struct Frame {
  Sequence sequence;
  DetectionTimes times;
  Duration bound, length;
  std::vector<Intervals> intervals;
  std::optional<Sequence> best;

  double deviation_ms(const Sequence& of) const {
    return 1e3 * std::sqrt(schedules::sequence::mean_variance(of, times));
  }
};

// Asked by the options. The sensors of interest outlive it.
struct Asked {
  FrameRequest request;
  DetectionTimes times;
};

Asked asked_for(const SequenceOptions& options, const std::vector<int>& interest) {
  constexpr Duration kShortest = Duration::microseconds(1), kLongest = Duration::milliseconds(10'000);
  const Duration primary = duration("--primary", options.primary, {kShortest, kLongest});
  const Duration secondary = duration("--secondary", options.secondary, {kShortest, primary});  // a part of the picture
  const Duration bound = duration("--beta", options.bound, {Duration{}, 10 * kLongest});
  const int sensors = static_cast<int>(options.sensors.size());
  FrameRequest request{sensors, interest, primary * sensors, secondary, bound};
  if (options.slots == "floor") request.slots = SlotRule::kFloor;
  if (options.order == "reversed") request.order = SlotOrder::kReversed;
  return {request, DetectionTimes(sensors, primary, secondary)};
}

Frame frame_of(const Asked& asked) {
  Frame frame{generated(asked.request), asked.times, asked.request.bound, {}, {}, {}};
  frame.length = frame_time(frame.sequence, frame.times);
  frame.intervals = intervals(frame.sequence, frame.times);
  frame.best = best_order(frame.sequence, frame.times);
  return frame;
}

void print_json(const SequenceOptions& options, const Frame& frame) {
  nlohmann::ordered_json json{{"sequence", letters(frame.sequence, options.sensors)},
                              {"frame_ms", in_ms(frame.length)},
                              {"bound_ms", in_ms(frame.bound)},
                              {"sensors", nlohmann::ordered_json::array()},
                              {"deviation_ms", frame.deviation_ms(frame.sequence)},
                              {"best", nullptr}};
  for (std::size_t i = 0; i < frame.intervals.size(); ++i)
    json["sensors"].push_back({{"sensor", std::string(1, options.sensors[i])},
                               {"detections", frame.intervals[i].detections},
                               {"interval_mean_ms", 1e3 * frame.intervals[i].mean_s},
                               {"interval_deviation_ms", 1e3 * frame.intervals[i].deviation_s()}});
  if (frame.best)
    json["best"] = {{"sequence", letters(*frame.best, options.sensors)},
                    {"deviation_ms", frame.deviation_ms(*frame.best)}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(const SequenceOptions& options, const Frame& frame) {
  const Duration over = frame.length - frame.bound;
  fmt::print("{}: a frame of {:g} ms, {:g} ms {} the bound of {:g} ms\n", letters(frame.sequence, options.sensors),
             in_ms(frame.length), std::abs(in_ms(over)), over > Duration{} ? "above" : "below", in_ms(frame.bound));
  fmt::print("sensor  detections  mean interval [ms]  deviation [ms]\n");
  for (std::size_t i = 0; i < frame.intervals.size(); ++i)
    fmt::print("{:<6}  {:>10}  {:>18.3f}  {:>14.3f}\n", options.sensors[i], frame.intervals[i].detections,
               1e3 * frame.intervals[i].mean_s, 1e3 * frame.intervals[i].deviation_s());
  if (!frame.best)
    fmt::print("best order of these detections: more than {} orders, which are not tried\n",
               schedules::sequence::kMostOrders);
  else if (*frame.best == frame.sequence)
    fmt::print("best order of these detections: this one\n");
  else
    fmt::print("best order of these detections: {}, with a deviation of {:.3f} ms instead of {:.3f} ms\n",
               letters(*frame.best, options.sensors), frame.deviation_ms(*frame.best),
               frame.deviation_ms(frame.sequence));
}

constexpr Duration kLongestBound = Duration::milliseconds(100'000);

ModesAsked modes_of(const SequenceOptions& options, const Asked& asked) {
  const Duration step = duration("--step", options.step, {Duration::microseconds(100), Duration::milliseconds(1'000)});
  const std::int64_t offset = decimal_option("--offset", options.offset, 1, {0, 65'535}, " macroticks");
  std::optional<Duration> best_case;
  if (options.best_case)
    best_case = duration("--best-case", *options.best_case,
                         {Duration{}, std::min(asked.times.primary[0], asked.times.secondary[0])});
  ModesAsked modes{options.cluster,
                   options.task,
                   {step, Macroticks{static_cast<int>(offset)}, best_case},
                   asked.times,
                   options.sensors,
                   {asked.request.bound},
                   {generated(asked.request)},
                   options.json,
                   options.yaml};
  for (const std::string& mode : options.modes) {
    FrameRequest request = asked.request;
    request.bound = duration("--mode", mode, {Duration{}, kLongestBound});
    modes.bounds.push_back(request.bound);
    modes.sequences.push_back(generated(request));
  }
  return modes;
}

void run(const SequenceOptions& options) {
  check_sensors(options.sensors);
  const std::vector<int> interest = interest_of(options);
  const Asked asked = asked_for(options, interest);
  if (!options.cluster.empty()) return print_modes(modes_of(options, asked));
  if (options.best_bound) {
    if (interest.empty()) refuse("--interest", "", "must name a sensor: without one, no bound makes a difference");
    const auto number = [](const char* option, const std::string& text, std::int64_t least, std::int64_t most) {
      constexpr std::int64_t kScale = 1'000'000;
      return 1e-6 * static_cast<double>(decimal_option(option, text, kScale, {least, most}, ""));
    };
    return print_best_bound({asked.request,
                             asked.times,
                             {number("--process-noise", options.process_noise, 1'000, 10'000'000'000),
                              number("--sigma", options.sigma, 1'000, 100'000'000)},
                             number("--share", options.share, 0, 1'000'000),
                             options.sensors,
                             options.json});
  }
  const Frame frame = frame_of(asked);
  if (options.json)
    print_json(options, frame);
  else
    print_text(options, frame);
}

}  // namespace

void add_sequence(CLI::App& schedule, Action& action) {
  auto options = std::make_shared<SequenceOptions>();
  CLI::App* command = schedule.add_subcommand(
      "sequence", "Order the detections of several cameras that share one detector, within a bound");
  command->footer(
      "Examples: ttfusion schedule sequence --sensors ABC --interest A --beta 200ms --primary 46.3ms --secondary "
      "27.7ms\n"
      "          ttfusion schedule sequence --sensors ABC --interest A --beta 500ms --primary 46.3ms --secondary "
      "27.7ms "
      "--best-beta\n"
      "          ttfusion schedule sequence --sensors ABC --interest A --beta 0ms --mode 260ms --primary 59ms "
      "--secondary 39ms --cluster adaptive_loop_synchronised --task detector.detect --offset 3500 --yaml");
  command->add_option("--sensors", options->sensors, "A capital letter for each sensor")->required()->check(named());
  command->add_option("--interest", options->interest, "The sensors with a region of interest (default: none)");
  command->add_option("--beta", options->bound, "Bound of a frame")->required();
  command->add_option("--primary", options->primary, "Duration of a detection in a whole picture")->required();
  command->add_option("--secondary", options->secondary, "Duration of a detection in a region of interest")->required();
  command
      ->add_option("--slots", options->slots, "Rule for the number of secondary detections: text (one more) or floor")
      ->check(one_of({"text", "floor"}))
      ->capture_default_str();
  command->add_option("--order", options->order, "Permutation of the secondary detections: text or reversed")
      ->check(one_of({"text", "reversed"}))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Result as JSON on standard output");
  command->add_flag("--best-beta", options->best_bound,
                    "Print the expected error of all frames up to --beta, and the best one");
  command
      ->add_option("--process-noise", options->process_noise,
                   "With --best-beta: density of the objects' white acceleration [m^2/s^3]")
      ->capture_default_str();
  command->add_option("--sigma", options->sigma, "With --best-beta: standard deviation of a detected position [m]")
      ->capture_default_str();
  command->add_option("--share", options->share, "With --best-beta: weight of the objects of interest, 0..1")
      ->capture_default_str();
  command
      ->add_option("--cluster", options->cluster, "Print the checked time-triggered modes of this cluster's detector")
      ->check(named());
  command->add_option("--task", options->task, "With --cluster: the detector's task, as NODE.TASK");
  command->add_option("--mode", options->modes, "With --cluster: the bound of one more mode, any number of times");
  command->add_option("--step", options->step, "With --cluster: grid of the detections' beginnings")
      ->capture_default_str();
  command->add_option("--offset", options->offset, "With --cluster: macrotick of the cycle at which detections begin")
      ->capture_default_str();
  command->add_option("--best-case", options->best_case,
                      "With --cluster: shortest detection, if its list leaves as it ends (default: lists wait for the "
                      "worst case)");
  command->add_flag("--yaml", options->yaml,
                    "With --cluster: print the keys that state these modes for the task in the cluster's file");
  command->get_option("--yaml")->excludes("--json")->excludes("--best-case");
  command->get_option("--cluster")->needs("--task")->excludes("--best-beta");
  for (const char* of_modes : {"--task", "--mode", "--step", "--offset", "--best-case", "--yaml"})
    command->get_option(of_modes)->needs(command->get_option("--cluster"));
  for (const char* of_best : {"--process-noise", "--sigma", "--share"})
    command->get_option(of_best)->needs(command->get_option("--best-beta"));
  command->callback([options, &action] {
    action = [options] {
      run(*options);
      return 0;
    };
  });
}

}  // namespace ttf::cli::schedule
