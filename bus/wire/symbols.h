// Wake-up patterns as a receiver makes them out (FlexRay 2.1A, chapter 3.2). A pattern is made of wake-up symbols:
// each is low for gdWakeupSymbolTxLow, then idle for gdWakeupSymbolTxIdle. The bus is low while any sender is.
//
// A receiver recognises a pattern by two low phases of gdWakeupSymbolRxLow each, and an idle phase of
// gdWakeupSymbolRxIdle between them. All of it lies within gdWakeupSymbolRxWindow. So the patterns of two nodes may
// overlap, and still wake (SPNU563A 26.2.6.6.2: "collision resilient for up to two sending nodes").
#pragma once

#include <span>

#include "core/time.h"
#include "schedules/model/flexray_parameters.h"

namespace ttf::bus::wire {

// One sender's pattern at the receiver, from its first low bit to the end of its last idle phase. Any common origin.
struct WakeupPattern {
  Duration from, to;
};

// Returns whether a receiver recognises a wake-up pattern in the sum of these. It allocates.
bool wakes(const schedules::model::GlobalParameters& flexray, std::span<const WakeupPattern> patterns);
// Returns whether it recognises a pattern that no other one overlaps.
bool wakes(const schedules::model::GlobalParameters& flexray);

}  // namespace ttf::bus::wire
