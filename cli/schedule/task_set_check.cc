#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "cli/schedule/checks.h"
#include "core/errors.h"
#include "core/file_kind.h"
#include "core/time.h"
#include "schedules/timing/task_set/reader.h"
#include "schedules/timing/task_set/verdict.h"

namespace ttf::cli::schedule {
namespace {

namespace sets = schedules::timing::task_set;
namespace ends = schedules::timing::chain;

nlohmann::ordered_json optional_ms(std::optional<Duration> time) {
  return time ? nlohmann::ordered_json(in_ms(*time)) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json task_json(const sets::TaskSet& set, const sets::Verdict& verdict, std::size_t t) {
  const sets::Task& task = set.tasks[t];
  const sets::TaskTiming& timing = verdict.responses.tasks[t];
  const bool bounded = timing.bounded();
  nlohmann::ordered_json json{{"name", task.name},
                              {"kind", task.is_message ? "message" : "task"},
                              {"communication", sets::word(task.communication)},
                              {"period_ms", in_ms(set.period_of(t))},
                              {"jitter_ms", in_ms(timing.jitter)},
                              {"best_ms", in_ms(task.best)},
                              {"worst_ms", in_ms(task.worst)},
                              {"response_ms", bounded ? nlohmann::ordered_json(in_ms(Duration{timing.response.longest}))
                                                      : nlohmann::ordered_json(nullptr)},
                              {"quality", schedules::timing::response::word(timing.response.quality)},
                              {"deadline_ms", optional_ms(task.deadline)},
                              {"met", sets::keeps_deadline(set, verdict.responses, t)}};
  if (timing.miss_probability) json["late_probability"] = *timing.miss_probability;
  return json;
}

nlohmann::ordered_json figure_json(const sets::TaskSet& set, const sets::Chain& chain, const ends::Figure& figure) {
  nlohmann::ordered_json json{{"ms", in_ms(figure.time)}, {"shares", nlohmann::ordered_json::array()}};
  for (std::size_t s = 0; s < chain.stages.size(); ++s) {
    const ends::Share& share = figure.shares[s];
    json["shares"].push_back({{"stage", set.tasks[chain.stages[s]].name},
                              {"waits_ms", in_ms(share.waits)},
                              {"runs_ms", in_ms(share.runs)},
                              {"stays_ms", in_ms(share.stays)}});
  }
  return json;
}

nlohmann::ordered_json set_chain_json(const sets::TaskSet& set, const sets::Chain& chain,
                                      const sets::ChainTiming& timing) {
  nlohmann::ordered_json json{{"name", chain.name}, {"stages", nlohmann::ordered_json::array()}};
  for (const std::size_t t : chain.stages) json["stages"].push_back(set.tasks[t].name);
  json["largest_age_ms"] = optional_ms(chain.largest_age);
  json["met"] = timing.times.has_value() && sets::keeps_age(chain, timing);
  if (!timing.times) {
    json["no_times"] = timing.why_none;
    return json;
  }
  const ends::EndToEnd& times = *timing.times;
  const auto figure = [&](const ends::Figure& of) { return figure_json(set, chain, of); };
  json["exact"] = times.exact;
  json["without_errors"] = sets::ignores_errors(set, chain);
  json["reaction_time"] = figure(times.reaction);
  json["reduced_reaction_time"] = figure(times.reduced_reaction);
  json["data_age"] = times.age ? figure(*times.age) : nlohmann::ordered_json(nullptr);
  json["reduced_data_age"] = times.reduced_age ? figure(*times.reduced_age) : nlohmann::ordered_json(nullptr);
  return json;
}

nlohmann::ordered_json verdict_json(const sets::TaskSet& set, const sets::Verdict& verdict) {
  nlohmann::ordered_json json{{"task_set", set.name}, {"holds", verdict.holds()}, {"misses", verdict.misses}};
  json["resources"] = nlohmann::ordered_json::array();
  for (std::size_t r = 0; r < set.resources.size(); ++r) {
    const sets::ResourceTiming& here = verdict.responses.resources[r];
    nlohmann::ordered_json one{{"name", set.resources[r].name},
                               {"policy", sets::word(set.resources[r].policy)},
                               {"load", here.load},
                               {"tasks", nlohmann::ordered_json::array()}};
    if (set.resources[r].has_priorities()) one["priorities"] = sets::words(here.assignment);
    if (set.resources[r].errors_apart) one["errors_apart_ms"] = in_ms(*set.resources[r].errors_apart);
    if (set.resources[r].errors_per_s > 0) one["errors_per_s"] = set.resources[r].errors_per_s;
    for (const std::size_t t : here.by_priority) one["tasks"].push_back(task_json(set, verdict, t));
    json["resources"].push_back(std::move(one));
  }
  json["chains"] = nlohmann::ordered_json::array();
  for (std::size_t c = 0; c < set.chains.size(); ++c)
    json["chains"].push_back(set_chain_json(set, set.chains[c], verdict.chains[c]));
  return json;
}

// A file of another kind is one mistake.
sets::TaskSet read_set(const std::string& file) {
  try {
    return sets::load_task_set(file);
  } catch (const InputError&) {
    refuse_any_kind(file, "a task set");
    throw;
  }
}

}  // namespace

int check_task_set(const std::string& file, bool json) {
  const sets::TaskSet set = read_set(file);
  const sets::Verdict verdict = sets::verdict_on(set);
  if (json)
    fmt::print("{}\n", verdict_json(set, verdict).dump(2));
  else
    fmt::print("{}", sets::verdict_text(set, verdict));
  return verdict.holds() ? 0 : 1;
}

}  // namespace ttf::cli::schedule
