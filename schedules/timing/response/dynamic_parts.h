// Parts that the bound and the search of the dynamic segment share. Internal to this folder.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "schedules/timing/response/flexray_dynamic.h"

namespace ttf::schedules::timing::response {

inline bool sends_in(const DynamicMessage& message, std::int64_t cycle) {
  return cycle % message.repetition == message.base_cycle;
}

// Returns whether two messages have a cycle in common. Repetitions are powers of two.
inline bool share_cycles(const DynamicMessage& a, const DynamicMessage& b) {
  const int both = a.repetition < b.repetition ? a.repetition : b.repetition;
  return a.base_cycle % both == b.base_cycle % both;
}

// The most communication cycles from the first one that can take a message to the one that does; nullopt: no bound.
using CycleDelay = std::optional<std::int64_t>;

// A message's answer, with its delay for the messages of higher slots.
struct DelayedResponse {
  DynamicResponse response;
  CycleDelay delay;
};

// Returns the bound of the message at place `which`, given the delays of all before it.
DelayedResponse covering_bound(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot,
                               std::size_t which, std::span<const CycleDelay> delays);

// Returns the time from the arrival to the end of the frame: `cycles` own cycles on, in minislot `turn`.
std::int64_t end_of_frame(const DynamicSegment& segment, const DynamicMessage& message, std::int64_t cycles,
                          std::int64_t turn);

// Checks the ranges of a list, which the caller guarantees.
void check_messages(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot);

}  // namespace ttf::schedules::timing::response
