// A judgement as a campaign counts and reports it, whatever its bus.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

#include "experiments/campaign/outcome.h"
#include "sim/faults/injector.h"

namespace ttf::experiments::campaign {

// Returns the bits of those that have a value.
template <class Optionals> unsigned bits_of(const Optionals& optionals) {
  unsigned bits = 0;
  for (std::size_t i = 0; i < optionals.size(); ++i) bits |= optionals[i].has_value() ? 1u << i : 0u;
  return bits;
}

// `Judgement`: a JudgementOf (evaluation/faults/judgement.h).
template <class Judgement>
FaultOutcome outcome_of(const Judgement& judgement, const sim::faults::Injector::Activation& activation) {
  FaultOutcome outcome;
  outcome.activated = activation.times > 0;
  outcome.seen_by_others = static_cast<std::uint16_t>(bits_of(judgement.seen_by_others));
  outcome.seen_by_itself = static_cast<std::uint16_t>(bits_of(judgement.seen_by_itself));
  outcome.harms = static_cast<std::uint8_t>(bits_of(judgement.harms));
  outcome.still_out = static_cast<std::int16_t>(judgement.still_out);
  const auto after = [&](const std::optional<TrueTime>& since) {
    return since ? std::optional(std::max<std::int64_t>(0, (*since - activation.first).ns)) : std::nullopt;
  };
  outcome.detected_after = after(judgement.detected());
  outcome.passive_after = after(judgement.passive);
  outcome.halt_after = after(judgement.halt);
  if (judgement.reintegration) outcome.reintegrated_after = judgement.reintegration->ns;
  if (const auto* const first = judgement.first_harm()) {
    outcome.harmed = first->node;
    outcome.sender = first->sender;
    outcome.frame_id = first->frame_id;
    outcome.harmed_after = after(first->first);
  }
  return outcome;
}

// `all`: the judgement's checks, in their order.
template <class Judgement, class Checks> void report(const Judgement& judgement, const Checks& all, Story& story) {
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (const auto& at = judgement.seen_by_others[c])
      story.say(*at, fmt::format("noticed by others: {}", name_of(all[c])));
    if (const auto& at = judgement.seen_by_itself[c])
      story.say(*at, fmt::format("noticed by itself: {}", name_of(all[c])));
  }
}

}  // namespace ttf::experiments::campaign
