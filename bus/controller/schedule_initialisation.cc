#include "bus/controller/schedule_initialisation.h"

#include <cstdlib>

namespace ttf::bus::controller {

ScheduleInitialisation::ScheduleInitialisation(const schedules::model::GlobalParameters& flexray,
                                               const schedules::model::NodeParameters& node)
    : flexray_(flexray), node_(node) {}

void ScheduleInitialisation::reset() { even_ = {}; }

std::optional<InitialSchedule> ScheduleInitialisation::receive(const StartupFrame& frame) {
  std::optional<StartupFrame>& even = even_[index_of(frame.channel)];
  // Later than this, the frame belongs to a later cycle and the partner is missing.
  const std::int64_t longest = node_.pMicroPerCycle + node_.pRateCorrectionOut;
  const bool overdue = even && (frame.start - even->start).value > longest;
  if (frame.cycle % 2 == 0) {
    if (!even || overdue || frame.cycle != even->cycle) even = frame;
    return std::nullopt;
  }
  if (!even || overdue || frame.cycle != even->cycle + 1) {
    even.reset();
    return std::nullopt;
  }
  if (frame.frame_id != even->frame_id) return std::nullopt;  // the partner may still come
  const auto rate = static_cast<int>((frame.start - even->start).value - node_.pMicroPerCycle);
  even.reset();
  if (std::abs(rate) > node_.pRateCorrectionOut) return std::nullopt;
  reset();

  // The frame left at its slot's action point and arrived after the delay that is compensated.
  const std::int64_t macroticks =
      static_cast<std::int64_t>(frame.frame_id - 1) * flexray_.gdStaticSlot + flexray_.gdActionPointOffset;
  const std::int64_t length = node_.pMicroPerCycle + rate;
  const std::int64_t into_cycle = (macroticks * length + flexray_.gMacroPerCycle - 1) / flexray_.gMacroPerCycle;
  const int compensation =
      frame.channel == schedules::model::Channel::kA ? node_.pDelayCompensationA : node_.pDelayCompensationB;
  return InitialSchedule{frame.frame_id, frame.cycle, frame.start - Microticks{into_cycle + compensation}, rate};
}

}  // namespace ttf::bus::controller
