#include "schedules/timing/response/flexray_dynamic.h"

#include <algorithm>

#include "core/check.h"
#include "schedules/timing/response/dynamic_parts.h"

namespace ttf::schedules::timing::response {
namespace {

constexpr std::int64_t kMostMinislots = 7'988;
constexpr int kMostDynamicSlots = 2'047;
constexpr int kMostRepetition = 64;

void check_message(const DynamicSegment& segment, const DynamicMessage& message) {
  TTF_CHECK(message.slot >= 1 && message.slot <= kMostDynamicSlots, "dynamic slot {}", message.slot);
  const int repetition = message.repetition;
  TTF_CHECK(repetition >= 1 && repetition <= kMostRepetition && (repetition & (repetition - 1)) == 0, "repetition {}",
            repetition);
  TTF_CHECK(message.base_cycle >= 0 && message.base_cycle < repetition, "base cycle {} of {}", message.base_cycle,
            repetition);
  TTF_CHECK(message.minislots >= 1 && message.latest_tx <= latest_tx(segment, message.minislots),
            "{} minislots, pLatestTx {}", message.minislots, message.latest_tx);
  TTF_CHECK(message.period >= 1 && message.period <= kLongestArgument, "period {}", message.period);
  TTF_CHECK(message.jitter >= 0 && message.jitter <= kLongestArgument, "jitter {}", message.jitter);
}

}  // namespace

void check_messages(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot) {
  TTF_CHECK(segment.minislots >= 1 && segment.minislots <= kMostMinislots, "{} minislots", segment.minislots);
  TTF_CHECK(segment.minislot >= 1 && segment.cycle >= 1 && segment.cycle <= kLongestArgument / kMostOwnCycles / 2 &&
                segment.minislot <= segment.cycle / segment.minislots,
            "{} minislots of {} in a cycle of {}", segment.minislots, segment.minislot, segment.cycle);
  for (std::size_t i = 0; i < by_slot.size(); ++i) {
    check_message(segment, by_slot[i]);
    TTF_CHECK(i == 0 || by_slot[i - 1].slot <= by_slot[i].slot, "slot {} behind slot {}", by_slot[i].slot,
              by_slot[i - 1].slot);
    for (std::size_t j = i; j-- > 0 && by_slot[j].slot == by_slot[i].slot;)
      TTF_CHECK(!share_cycles(by_slot[j], by_slot[i]), "two messages share a cycle of slot {}", by_slot[i].slot);
  }
}

std::int64_t end_of_frame(const DynamicSegment& segment, const DynamicMessage& message, std::int64_t cycles,
                          std::int64_t turn) {
  // The message came just too late for an own cycle: for the segment's start, or for its earliest turn.
  const std::int64_t missed = segment.decision == DynamicSegment::Decision::kAtSegmentStart ? 1 : message.slot;
  return message.jitter + cycles * message.repetition * segment.cycle +
         (turn - missed + message.minislots) * segment.minislot;
}

std::int64_t latest_tx(const DynamicSegment& segment, std::int64_t frame_minislots) {
  return segment.minislots - frame_minislots + 1;
}

std::vector<DynamicResponse> covering_bounds(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot) {
  check_messages(segment, by_slot);
  std::vector<DynamicResponse> bounds;
  std::vector<CycleDelay> delays;
  for (std::size_t i = 0; i < by_slot.size(); ++i) {
    const DelayedResponse bound = covering_bound(segment, by_slot, i, delays);
    bounds.push_back(bound.response);
    delays.push_back(bound.delay);
  }
  return bounds;
}

std::vector<DynamicResponse> dynamic_responses(const DynamicSegment& segment, std::span<const DynamicMessage> by_slot) {
  check_messages(segment, by_slot);
  std::vector<DynamicResponse> responses;
  std::vector<CycleDelay> delays;
  for (std::size_t i = 0; i < by_slot.size(); ++i) {
    DelayedResponse answer = covering_bound(segment, by_slot, i, delays);
    // Behind a message without a bound, queues have no end, and no search has one.
    const bool endless = std::any_of(delays.begin(), delays.end(), [](const CycleDelay& delay) { return !delay; });
    const auto searched = endless ? std::nullopt : searched_response(segment, by_slot, i);
    if (searched) {
      const Response& bound = answer.response.response;
      TTF_CHECK(!bound.bounded() || searched->response.keeps(bound.longest), "searched {}, bound {}",
                searched->response.longest, bound.longest);
      answer.response = *searched;
      answer.delay.reset();
      if (searched->response.bounded()) answer.delay = (searched->lost_cycles + 1) * by_slot[i].repetition - 1;
    }
    responses.push_back(answer.response);
    delays.push_back(answer.delay);
  }
  return responses;
}

}  // namespace ttf::schedules::timing::response
