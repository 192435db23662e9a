#include "cli/schedule/sequence.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/argument_checks.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "core/strict_yaml.h"
#include "schedules/sequence/generator.h"
#include "schedules/sequence/intervals.h"

namespace ttf::cli::schedule {
namespace {

using schedules::sequence::DetectionTimes;
using schedules::sequence::FrameRequest;
using schedules::sequence::Intervals;
using schedules::sequence::Sequence;
using schedules::sequence::SlotOrder;
using schedules::sequence::SlotRule;

struct SequenceOptions {
  std::string sensors, interest, bound, primary, secondary;
  std::string slots = "text", order = "text";
  bool json = false;
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

Frame frame_of(const SequenceOptions& options) {
  check_sensors(options.sensors);
  const std::vector<int> interest = interest_of(options);
  constexpr Duration kShortest = Duration::microseconds(1), kLongest = Duration::milliseconds(10'000);
  const Duration primary = duration("--primary", options.primary, {kShortest, kLongest});
  const Duration secondary = duration("--secondary", options.secondary, {kShortest, kLongest});
  const Duration bound = duration("--beta", options.bound, {Duration{}, 10 * kLongest});
  const int sensors = static_cast<int>(options.sensors.size());
  FrameRequest request{sensors, interest, primary * sensors, secondary, bound};
  if (options.slots == "floor") request.slots = SlotRule::kFloor;
  if (options.order == "reversed") request.order = SlotOrder::kReversed;
  Frame frame{generated(request), DetectionTimes(sensors, primary, secondary), bound, {}, {}, {}};
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

}  // namespace

void add_sequence(CLI::App& schedule, Action& action) {
  auto options = std::make_shared<SequenceOptions>();
  CLI::App* command = schedule.add_subcommand(
      "sequence", "Order the detections of several cameras that share one detector, within a bound");
  command->footer(
      "Example: ttfusion schedule sequence --sensors ABC --interest A --beta 200ms --primary 46.3ms --secondary "
      "27.7ms");
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
  command->callback([options, &action] {
    action = [options] {
      const Frame frame = frame_of(*options);
      if (options->json)
        print_json(*options, frame);
      else
        print_text(*options, frame);
      return 0;
    };
  });
}

}  // namespace ttf::cli::schedule
