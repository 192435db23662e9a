// A second opinion on chains. Data themselves go through registers, in the order of time. No job is looked up.
//
// All readings and writings of all jobs go through one sorted list, at one instant in the order of the stages. A
// register of each stage holds the instant of the sample on which its value rests.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "schedules/timing/chain/stage.h"

namespace ttf::schedules::timing::chain {

struct FlowTimes {
  std::int64_t reaction = 0, reduced_reaction = 0, age = 0, reduced_age = 0;
  bool operator==(const FlowTimes&) const = default;
};

// All jobs of one stage, in order. Each job of an activated stage takes the value of the same job of the stage before.
struct FlowStage {
  bool activated = false;
  std::vector<Job> jobs;
};

// The jobs of a chain's stages from -window to 2 * window. The window is a multiple of all cycles.
std::vector<FlowStage> listed(const std::vector<Stage>& stages, std::int64_t window);

class DataFlow {
 public:
  // Judges the samples within [from, to). Jobs must be there for longer than any age before and behind.
  DataFlow(const std::vector<FlowStage>& stages, std::int64_t from, std::int64_t to);

  FlowTimes times() const;

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

  void happen(const Happening& one);

  const std::vector<FlowStage>& stages_;
  std::int64_t from_, to_;
  std::vector<std::optional<std::int64_t>> registers_;
  std::vector<Happening> happenings_;
  std::vector<std::vector<std::optional<std::int64_t>>> values_;  // the sample that a job rests on
  std::vector<std::int64_t> samples_;
  std::vector<Output> outputs_;
};

}  // namespace ttf::schedules::timing::chain
