#include "sim/drives/traced.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/counted.h"
#include "core/decimal.h"
#include "core/errors.h"

namespace ttf::sim::drives {
namespace {

std::string in_seconds(Duration duration) { return scaled_text(duration.ns, 1'000'000'000) + " s"; }

}  // namespace

void take_truth(Scenario& scenario, std::shared_ptr<const recording::osi::TruthTrace> trace) {
  const Duration length = trace->length(), least = std::max(kShortestDrive, scenario.evaluate_from);
  if (length < least)
    throw InputError({trace->name, 0, "", "",
                      fmt::format("must be at least {} long, and has {}{}", in_seconds(least), in_seconds(length),
                                  least > kShortestDrive ? ": " + scenario.file + " evaluates from there on" : "")});
  scenario.duration = scenario.world.duration = std::min(scenario.duration, length);
  scenario.truth = std::move(trace);
}

std::string truth_text(const Scenario& scenario) {
  const recording::osi::TruthTrace& trace = *scenario.truth;
  std::string text = fmt::format("truth of {}, a trace of {}{}: {} in {} over {}", trace.name, trace.type,
                                 trace.guessed ? " as its messages show" : "", counted(trace.objects.size(), "object"),
                                 counted(trace.instants.size(), "message"), in_seconds(trace.length()));
  if (!trace.host)
    text += ", seen from the ground's origin";
  else if (trace.host->has_rear)
    text += fmt::format(", seen from vehicle {}", trace.host->vehicle.id);
  else
    text += fmt::format(", seen from vehicle {}, whose rear axle is unknown and taken for the middle of its box",
                        trace.host->vehicle.id);
  if (!scenario.world.objects.empty())
    text +=
        fmt::format("; the scenario's {} not there",
                    scenario.world.objects.size() == 1 ? std::string("object is")
                                                       : fmt::format("{} objects are", scenario.world.objects.size()));
  if (scenario.duration < trace.length()) text += fmt::format("; the drive ends at {}", in_seconds(scenario.duration));
  return text;
}

std::string subject_of(const Scenario& scenario) {
  if (!scenario.truth) return scenario.description;
  return fmt::format("The world of {}, with the sensors and the tracker of {}", scenario.truth->name, scenario.name);
}

}  // namespace ttf::sim::drives
