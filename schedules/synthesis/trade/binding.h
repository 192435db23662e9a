// The binding pieces of a schedule: each chain's way from its measurement to its use. Data is worked at, or it rests, and rests have a cause.
//
// Each activity is placed as late as the next ones allow. So data rests because its activity could be no later:
//
//   slots       a list begins with a slot, not between two
//   taken       the processor or the static segment works at something else then
//   others      another activity takes the data, too, and begins earlier
//   order       a later measurement would be fused out of order (plan::Plan::in_order)
//   stands      the plan says when it begins
//   periods     both sides have different periods
//   free        none of these: no age would become smaller
//
// The pieces add up to the worst age that `schedule check` bounds. The last one is the difference of clocks: at every hand-over
// from one to another, and between both ends.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"
#include "schedules/synthesis/instants/synthesize.h"
#include "schedules/synthesis/plan/plan.h"

namespace ttf::schedules::synthesis::trade {

using instants::Synthesis;

// The gain if a piece of work were shorter. The best instants for the same cycle and rates are found anew.
struct Shorter {
  Duration by{};         // 1 ms, or all of a shorter piece; whole slots of a list
  Duration own_age{};    // by so much falls the chain's own age (negative: it grows for the sake of another chain's)
  Duration worst_age{};  // by so much falls the largest age of all chains
  bool proven = false;   // both searches ended with a proof
};

struct WayPiece {
  enum class Kind : std::uint8_t { kWorks, kRests, kClocks };
  Kind kind{};
  std::string name;  // the work, or the rest's cause
  Duration time{};
  std::optional<Shorter> shorter;  // if it is work, and can be shorter
};

struct BindingWay {
  std::string chain;
  std::vector<WayPiece> pieces;  // from the measurement to the use
  Duration worst_age{};          // their sum
};

// Returns the ways by chain. The cluster must have been found for this plan.
std::vector<BindingWay> what_binds(const plan::Plan& plan, const Synthesis& made);

// Returns the ways as a table in milliseconds, for people.
std::string binding_text(const std::vector<BindingWay>& ways);

}  // namespace ttf::schedules::synthesis::trade
