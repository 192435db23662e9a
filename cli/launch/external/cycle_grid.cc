#include "cli/launch/external/cycle_grid.h"

#include <algorithm>
#include <cstdlib>

#include "core/check.h"
#include "schedules/check/real_time_rules.h"
#include "timebase/floor_div.h"

namespace ttf::cli::launch::external {
namespace {

// Two clocks differ by 3000 ppm at most (cClockDeviationMax each).
constexpr std::int64_t kFastest_ppm = 3'000;

}  // namespace

CycleGrid::CycleGrid(const schedules::model::Cluster& cluster, std::int64_t time_scale_ppm)
    : cluster_(cluster), time_scale_ppm_(time_scale_ppm),
      nominal_(schedules::check::stretched(cluster.cycle(), time_scale_ppm)), length_(nominal_) {
  for (auto& slots : awaited_) slots.resize(static_cast<std::size_t>(cluster.flexray.gNumberOfStaticSlots));
}

void CycleGrid::begin(MachineTime cycle_0) { reference_ = {0, cycle_0}; }

Duration CycleGrid::in_cycle(Macroticks offset) const {
  return schedules::check::stretched({offset.value * cluster_.flexray.gdMacrotick_ps / 1000}, time_scale_ppm_);
}

Macroticks CycleGrid::action_point(int slot) const {
  const schedules::model::GlobalParameters& g = cluster_.flexray;
  return {std::int64_t{slot - 1} * g.gdStaticSlot + g.gdActionPointOffset};
}

CycleGrid::MachineTime CycleGrid::start_of(std::int64_t cycle) const {
  TTF_CHECK(known(), "cycle {} has no place yet", cycle);
  return reference_->start + length_ * (cycle - reference_->cycle);
}

std::int64_t CycleGrid::cycle_at(MachineTime at) const {
  TTF_CHECK(known(), "no cycle has a place yet");
  return reference_->cycle + static_cast<std::int64_t>(timebase::floor_div((at - reference_->start).ns, length_.ns));
}

std::int64_t CycleGrid::nearest(MachineTime at, std::uint8_t cycle_counter) const {
  const std::int64_t round = cluster_.flexray.gCycleCountMax + 1, here = cycle_at(at);
  std::int64_t off = ((cycle_counter - here) % round + round) % round;
  if (off > round / 2) off -= round;
  return here + off;
}

void CycleGrid::sync_frame(schedules::model::Channel channel, int slot, std::uint8_t cycle_counter, MachineTime at) {
  auto& slots = awaited_[index_of(channel)];
  if (slot < 1 || static_cast<std::size_t>(slot) > slots.size()) return;
  slots[static_cast<std::size_t>(slot - 1)] = {cycle_counter, at};
}

void CycleGrid::follow_up(schedules::model::Channel channel, int slot, std::uint8_t cycle_counter, Duration late) {
  auto& slots = awaited_[index_of(channel)];
  if (slot < 1 || static_cast<std::size_t>(slot) > slots.size()) return;
  Awaited& frame = slots[static_cast<std::size_t>(slot - 1)];
  if (frame.cycle_counter != cycle_counter) return;
  frame.cycle_counter.reset();
  const MachineTime start = frame.at - late - in_cycle(action_point(slot));
  last_received_ = std::max(last_received_.value_or(frame.at), frame.at);
  // The middle of the cycle is the farthest from every doubt about its ends.
  const MachineTime middle = start + Duration{nominal_.ns / 2};
  take(known() ? nearest(middle, cycle_counter) : cycle_counter, start);
}

void CycleGrid::take(std::int64_t cycle, MachineTime start) {
  if (!starts_.empty() && cycle == collecting_ - 1) return;  // a straggler
  if (!starts_.empty() && cycle != collecting_) settle();
  collecting_ = last_cycle_.emplace(cycle);
  starts_.push_back(start);
  if (!known()) reference_ = {cycle, start};
}

// The cycle that was being received is over.
void CycleGrid::settle() {
  std::ranges::sort(starts_);
  const Reference next{collecting_, starts_[(starts_.size() - 1) / 2]};
  starts_.clear();
  if (measured_ && next.cycle > reference_->cycle) {
    const std::int64_t length_ns = (next.start - reference_->start).ns / (next.cycle - reference_->cycle);
    // A cluster that began anew has another grid: the old one measures nothing.
    if (std::abs(length_ns - nominal_.ns) <= nominal_.ns * kFastest_ppm / 1'000'000) length_ = {length_ns};
  }
  reference_ = next;
  measured_ = true;
}

}  // namespace ttf::cli::launch::external
