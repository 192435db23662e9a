// A second opinion on chains: data themselves go through registers, in the order of time. No job is looked up.
//
// Each stage's jobs are listed over a long window. All readings and writings go through one sorted list, at one instant
// in the order of the stages. A register of each stage holds the instant of the sample on which its value rests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "schedules/timing/chain/stage.h"

namespace ttf::schedules::timing::chain {

struct FlowTimes {
  std::int64_t reaction = 0, reduced_reaction = 0, age = 0, reduced_age = 0;
  bool operator==(const FlowTimes&) const = default;
};

class DataFlow {
 public:
  // Follows the data from -window to 2 * window, and judges outputs of samples within [0, window). The window is a
  // multiple of all cycles, and longer than any age and any offset.
  DataFlow(const std::vector<Stage>& stages, std::int64_t window) : stages_(stages), window_(window) {
    for (std::size_t s = 0; s < stages.size(); ++s) list_jobs(s);
    std::ranges::sort(happenings_);
    registers_.resize(stages.size());
    for (const Happening& one : happenings_) happen(one);
  }

  FlowTimes times() const {
    FlowTimes found;
    for (std::size_t o = 0; o + 1 < outputs_.size(); ++o) {
      if (outputs_[o].sample < 0 || outputs_[o].sample >= window_) continue;
      found.reduced_age = std::max(found.reduced_age, outputs_[o].at - outputs_[o].sample);
      found.age = std::max(found.age, outputs_[o + 1].at - outputs_[o].sample);
    }
    for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
      if (samples_[k] < 0 || samples_[k] >= window_) continue;
      found.reduced_reaction = std::max(found.reduced_reaction, output_that_knows(samples_[k]) - samples_[k]);
      found.reaction = std::max(found.reaction, output_that_knows(samples_[k + 1]) - samples_[k]);
    }
    return found;
  }

 private:
  enum Kind { kRead, kWrite };
  struct Happening {
    std::int64_t at;
    std::size_t stage;
    Kind kind;
    std::size_t job;
    auto operator<=>(const Happening&) const = default;
  };
  struct Output {
    std::int64_t at, sample;
  };

  void list_jobs(std::size_t s) {
    std::vector<std::optional<std::int64_t>>& values = values_.emplace_back();
    const Stage& stage = stages_[s];
    if (stage.activated) {  // a job for each of the one before
      values.resize(values_[s - 1].size());
      writes_.emplace_back();
      for (std::size_t j = 0; j < values.size(); ++j) {
        writes_[s].push_back(writes_[s - 1][j] + stage.longest.ns);
        happenings_.push_back({writes_[s][j], s, kWrite, j});
      }
      return;
    }
    writes_.emplace_back();
    for (std::int64_t from = -2 * window_; from < 2 * window_; from += stage.cycle.ns)
      for (const Job& job : stage.jobs) {
        happenings_.push_back({from + job.reads.ns, s, kRead, values.size()});
        happenings_.push_back({from + job.writes.ns, s, kWrite, values.size()});
        writes_[s].push_back(from + job.writes.ns);
        values.emplace_back();
      }
  }

  void happen(const Happening& one) {
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

  std::int64_t output_that_knows(std::int64_t sample) const {
    for (const Output& output : outputs_)
      if (output.sample >= sample) return output.at;
    return -1;
  }

  const std::vector<Stage>& stages_;
  std::int64_t window_;
  std::vector<Happening> happenings_;
  std::vector<std::vector<std::optional<std::int64_t>>> values_;  // the sample that a job rests on
  std::vector<std::vector<std::int64_t>> writes_;
  std::vector<std::optional<std::int64_t>> registers_;
  std::vector<std::int64_t> samples_;
  std::vector<Output> outputs_;
};

}  // namespace ttf::schedules::timing::chain
