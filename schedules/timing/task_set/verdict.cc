#include "schedules/timing/task_set/verdict.h"

#include <fmt/format.h>

#include <utility>

#include "schedules/timing/task_set/fields.h"

namespace ttf::schedules::timing::task_set {
namespace {

void judge_resource(const TaskSet& set, std::size_t r, Verdict& verdict) {
  const ResourceTiming& here = verdict.responses.resources[r];
  if (here.overlap.empty()) return;
  const std::string& first = set.tasks[here.overlap[0]].name;
  const std::string& second = set.tasks[here.overlap[1]].name;
  verdict.misses.push_back(first == second
                               ? fmt::format("{}: {} takes longer than its period", set.resources[r].name, first)
                               : fmt::format("{}: {} and {} overlap", set.resources[r].name, first, second));
}

void judge_task(const TaskSet& set, std::size_t t, Verdict& verdict) {
  const Task& task = set.tasks[t];
  const response::Response& found = verdict.responses.tasks[t].response;
  if (meets_deadline(set, verdict.responses, t)) return;
  if (!verdict.responses.resources[task.resource].overlap.empty()) return;  // said once
  verdict.misses.push_back(found.bounded()
                               ? fmt::format("{}: a response of {} misses its deadline of {}", task.name,
                                             duration_words(Duration{found.longest}), duration_words(*task.deadline))
                               : fmt::format("{}: no bound found for its response", task.name));
}

void judge_chain(const Chain& chain, const ChainTiming& timing, Verdict& verdict) {
  if (!timing.times) {
    verdict.misses.push_back(fmt::format("{}: no times: {}", chain.name, timing.why_none));
  } else if (!meets_age(chain, timing)) {
    const std::string largest = duration_words(*chain.largest_age);
    verdict.misses.push_back(
        timing.times->age
            ? fmt::format("{}: data may be {} old, more than {}", chain.name, duration_words(timing.times->age->time),
                          largest)
            : fmt::format("{}: data have no largest age, as events begin it; the limit is {}", chain.name, largest));
  }
}

}  // namespace

Verdict verdict_on(const TaskSet& set) {
  Verdict verdict{.responses = responses_of(set), .chains = {}, .misses = {}};
  verdict.chains = chain_times(set, verdict.responses);
  for (std::size_t r = 0; r < set.resources.size(); ++r) judge_resource(set, r, verdict);
  for (std::size_t t = 0; t < set.tasks.size(); ++t) judge_task(set, t, verdict);
  for (std::size_t c = 0; c < set.chains.size(); ++c) judge_chain(set.chains[c], verdict.chains[c], verdict);
  return verdict;
}

}  // namespace ttf::schedules::timing::task_set
