#include <fmt/format.h>

#include <optional>

#include "schedules/timing/task_set/fields.h"
#include "schedules/timing/task_set/verdict.h"

namespace ttf::schedules::timing::task_set {
namespace {

std::string milliseconds(std::optional<Duration> time, std::string_view otherwise = "") {
  return time ? fmt::format("{:.3f}", in_ms(*time)) : std::string(otherwise);
}

std::string errors_text(const Resource& can) {
  if (can.errors_apart) return fmt::format(", errors {} apart or more", duration_words(*can.errors_apart));
  if (can.errors_per_s > 0) return fmt::format(", errors at random, {:g} a second", can.errors_per_s);
  return "";
}

std::string column_heading(const Resource& resource) {
  switch (resource.policy) {
    case Policy::kTable: return "time-triggered [ms]";
    case Policy::kTdma: return "each in its slot [ms]";
    case Policy::kDynamic: return "the lowest slot first [ms]";
    default: return "the highest priority first [ms]";
  }
}

std::string task_text(const TaskSet& set, const Verdict& verdict, std::size_t t) {
  const Task& task = set.tasks[t];
  const TaskTiming& timing = verdict.responses.tasks[t];
  std::string longest = timing.bounded() ? milliseconds(Duration{timing.response.longest}) : "-";
  const std::string quality = timing.miss_probability ? fmt::format("late at most {:.2g}", *timing.miss_probability)
                                                      : std::string(response::word(timing.response.quality));
  const std::string text =
      fmt::format("  {:<36} {:>9} {:>9} {:>9} {:>9}  {}", task.name, milliseconds(set.period_of(t)),
                  milliseconds(timing.jitter), longest, milliseconds(task.deadline), quality);
  return text + (keeps_deadline(set, verdict.responses, t) ? "\n" : ", missed\n");
}

std::string resource_text(const TaskSet& set, const Verdict& verdict, std::size_t r) {
  const Resource& resource = set.resources[r];
  const ResourceTiming& here = verdict.responses.resources[r];
  std::string text = fmt::format("{} {} ({}), load {:.1f} %", resource.is_bus ? "bus" : "processor", resource.name,
                                 word(resource.policy), here.load * 100);
  text += errors_text(resource);
  const bool ordered = resource.has_priorities() && resource.policy != Policy::kDynamic;
  text += ordered ? fmt::format(", priorities {}\n", words(here.assignment)) : "\n";
  text += fmt::format("  {:<36} {:>9} {:>9} {:>9} {:>9}\n", column_heading(resource), "period", "jitter", "response",
                      "deadline");
  for (const std::size_t t : here.by_priority) text += task_text(set, verdict, t);
  return text;
}

// A row of a chain's table: a part of each figure. Rows that are zero everywhere are left out.
std::string chain_row(const std::string& name, const chain::EndToEnd& times, std::size_t stage,
                      Duration chain::Share::*part) {
  const chain::Figure* const figures[] = {&times.reaction, &times.reduced_reaction, times.age ? &*times.age : nullptr,
                                          times.reduced_age ? &*times.reduced_age : nullptr};
  std::string text = fmt::format("  {:<40}", name);
  bool any = false;
  for (const chain::Figure* figure : figures) {
    const Duration share = figure != nullptr ? figure->shares[stage].*part : Duration{};
    any = any || share != Duration{};
    text += fmt::format("{:>14}", share != Duration{} ? milliseconds(share) : "");
  }
  return any ? text.substr(0, text.find_last_not_of(' ') + 1) + "\n" : "";
}

std::string chain_text(const TaskSet& set, const Chain& chain, const ChainTiming& timing) {
  std::string path;
  for (const std::size_t t : chain.stages) path += (path.empty() ? "" : " > ") + set.tasks[t].name;
  std::string text = fmt::format("chain {}: {}", chain.name, path);
  if (!timing.times) return text + fmt::format("\n  no times: {}\n", timing.why_none);
  const chain::EndToEnd& times = *timing.times;
  text += fmt::format(" ({}{})\n  {:<40}{:>14}{:>14}{:>14}{:>14}\n", times.exact ? "exact" : "bound",
                      ignores_errors(set, chain) ? " without errors" : "", "[ms]", "reaction", "reduced", "data age",
                      "reduced");
  for (std::size_t s = 0; s < chain.stages.size(); ++s) {
    const std::string& name = set.tasks[chain.stages[s]].name;
    text += chain_row((s == 0 ? "an event waits for " : "data wait for ") + name, times, s, &chain::Share::waits);
    text += chain_row(name, times, s, &chain::Share::runs);
    text += chain_row("data of " + name + " stay", times, s, &chain::Share::stays);
  }
  const auto time_of = [](const std::optional<chain::Figure>& figure) {
    return figure ? std::optional(figure->time) : std::nullopt;
  };
  text += fmt::format("  {:<40}{:>14}{:>14}{:>14}{:>14}\n", "together", milliseconds(times.reaction.time),
                      milliseconds(times.reduced_reaction.time), milliseconds(time_of(times.age), "none"),
                      milliseconds(time_of(times.reduced_age), "none"));
  if (chain.largest_age)
    text += fmt::format("  {:<40}{:>42}{}\n", "largest age allowed", milliseconds(chain.largest_age),
                        keeps_age(chain, timing) ? "" : "  missed");
  return text;
}

}  // namespace

std::string verdict_text(const TaskSet& set, const Verdict& verdict) {
  std::string text = verdict.holds() ? fmt::format("{}: all deadlines and ages are kept\n", set.name)
                                     : fmt::format("{}: not kept:\n", set.name);
  for (const std::string& miss : verdict.misses) text += "  " + miss + "\n";
  for (std::size_t r = 0; r < set.resources.size(); ++r)
    if (!verdict.responses.resources[r].by_priority.empty()) text += resource_text(set, verdict, r);
  for (std::size_t c = 0; c < set.chains.size(); ++c) text += chain_text(set, set.chains[c], verdict.chains[c]);
  return text;
}

}  // namespace ttf::schedules::timing::task_set
