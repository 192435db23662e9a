#include "tests/schedules/timing/chain/data_flow.h"

#include <algorithm>

namespace ttf::schedules::timing::chain {

std::vector<FlowStage> listed(const std::vector<Stage>& stages, std::int64_t window) {
  std::vector<FlowStage> flow;
  for (const Stage& stage : stages) {
    FlowStage one{.activated = stage.activated, .jobs = {}};
    if (stage.activated) {  // a job for each of the one before
      for (const Job& before : flow.back().jobs)
        one.jobs.push_back({.reads = before.writes, .writes = before.writes + stage.longest});
    } else {
      for (Duration from{-window}; from.ns < 2 * window; from += stage.cycle)
        for (const Job& job : stage.jobs) one.jobs.push_back({.reads = from + job.reads, .writes = from + job.writes});
    }
    flow.push_back(one);
  }
  return flow;
}

DataFlow::DataFlow(const std::vector<FlowStage>& stages, std::int64_t from, std::int64_t to)
    : stages_(stages), from_(from), to_(to), registers_(stages.size()) {
  for (std::size_t s = 0; s < stages.size(); ++s) {
    values_.emplace_back(stages[s].jobs.size());
    for (std::size_t j = 0; j < stages[s].jobs.size(); ++j) {
      if (!stages[s].activated) happenings_.push_back({stages[s].jobs[j].reads.ns, s, kRead, j});
      happenings_.push_back({stages[s].jobs[j].writes.ns, s, kWrite, j});
    }
  }
  std::ranges::sort(happenings_);
  for (const Happening& one : happenings_) happen(one);
}

FlowTimes DataFlow::times() const {
  FlowTimes found;
  for (std::size_t o = 0; o + 1 < outputs_.size(); ++o) {
    if (outputs_[o].sample < from_ || outputs_[o].sample >= to_) continue;
    found.reduced_age = std::max(found.reduced_age, outputs_[o].at - outputs_[o].sample);
    found.age = std::max(found.age, outputs_[o + 1].at - outputs_[o].sample);
  }
  std::size_t first = 0, next = 0;  // the outputs that rest on a sample, and of the one behind it
  for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
    if (samples_[k] < from_ || samples_[k] >= to_) continue;
    while (outputs_.at(first).sample < samples_[k]) ++first;
    while (outputs_.at(next).sample < samples_[k + 1]) ++next;
    found.reduced_reaction = std::max(found.reduced_reaction, outputs_[first].at - samples_[k]);
    found.reaction = std::max(found.reaction, outputs_[next].at - samples_[k]);
  }
  return found;
}

void DataFlow::happen(const Happening& one) {
  std::optional<std::int64_t>& value = values_[one.stage][one.job];
  if (one.kind == kRead) {
    value = one.stage == 0 ? std::optional(one.at) : registers_[one.stage - 1];
    if (one.stage == 0) samples_.push_back(one.at);
    return;
  }
  if (stages_[one.stage].activated) value = values_[one.stage - 1][one.job];
  registers_[one.stage] = value;
  if (one.stage + 1 == stages_.size() && value) outputs_.push_back({one.at, *value});
}

}  // namespace ttf::schedules::timing::chain
