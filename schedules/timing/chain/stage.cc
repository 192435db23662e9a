#include "schedules/timing/chain/stage.h"

#include <utility>

namespace ttf::schedules::timing::chain {
namespace {

Stage periodic(std::string name, Duration period, std::optional<Duration> offset, Duration to_write) {
  Stage stage;
  stage.name = std::move(name);
  stage.cycle = period;
  const Duration reads = offset.value_or(Duration{});
  stage.jobs.push_back({.reads = reads, .writes = reads + to_write});
  if (offset) stage.origin = 0;
  return stage;
}

}  // namespace

Stage let_stage(std::string name, Duration period, std::optional<Duration> offset, Duration interval) {
  Stage stage = periodic(std::move(name), period, offset, interval);
  stage.exact = true;
  return stage;
}

Stage sampled_stage(std::string name, Duration period, std::optional<Duration> offset, Duration response) {
  return periodic(std::move(name), period, offset, response);
}

Stage activated_stage(std::string name, Duration longest, bool exact) {
  Stage stage;
  stage.name = std::move(name);
  stage.activated = true;
  stage.longest = longest;
  stage.exact = exact;
  return stage;
}

}  // namespace ttf::schedules::timing::chain
