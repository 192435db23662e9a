// The dynamic segment as a schedule sees it: how many minislots a frame takes, and when its turn comes at the earliest
// and at the latest (FlexRay 2.1A, chapter 5.1.3; bus/controller/dynamic_segment.h counts them as they pass).
//
// A transmission begins at the action point of a minislot m. Its trailing sequence (DTS, at least one bit) ends at the
// first action point that leaves room for the frame, in minislot m + k,
//   k = ceil((frame bits + 1) gdBitMax / (gdMinislot gdMacrotick (1 - cClockDeviationMax)))
// with gdBitMax = gdBit (1 + cClockDeviationMax): bits at their longest, macroticks at their shortest.
// gdDynamicSlotIdlePhase minislots of silence follow, so that the slot takes
//   aMinislotPerDynamicFrame = k + 1 + gdDynamicSlotIdlePhase
// and begun no later than in minislot pLatestTx it is over within the segment if
//   pLatestTx <= gNumberOfMinislots - aMinislotPerDynamicFrame + 1
// (the specification's constraint on pLatestTx in annex B, with the longest frame the node sends; the derivation above
// is from chapter 5.1.3, where the controller's rule stands). A slot in which nothing is sent takes one minislot.
//
// The turn of slot s on a channel comes at the earliest in minislot s - gNumberOfStaticSlots, when all slots before it
// are silent, and at the latest when every slot before it that may be used in one of its cycles is, with its longest
// frame. If that is no later than pLatestTx, the frame is sent in every cycle it has something to send in: its delay
// has a bound.
#pragma once

#include <cstdint>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// Begins at 1; gNumberOfMinislots + 1 is the segment's end.
Macroticks minislot_start(const model::GlobalParameters& flexray, std::int64_t minislot);

// Of a dynamic frame, which is as long as what it carries.
int dynamic_words(const model::Cluster& cluster, const model::FrameSlot& frame);

// pPayloadLengthDynMax: of the longest one a node sends, 0 if it sends none.
int longest_dynamic_words(const model::Cluster& cluster, NodeId sender);

// The minislots of a slot in which a frame of so many words is sent, idle phase included.
std::int64_t minislots_of(const model::GlobalParameters& flexray, int words);

// pLatestTx at the most, for a frame of so many words; below 1: it never fits.
std::int64_t last_start(const model::GlobalParameters& flexray, int words);

// The minislot in which the turn of a dynamic frame comes, over all its cycles and channels.
int earliest_turn(const model::GlobalParameters& flexray, const model::FrameSlot& frame);
std::int64_t latest_turn(const model::Cluster& cluster, const model::FrameSlot& frame);

// Whether the frame's turn never comes too late for its sender.
bool always_in_time(const model::Cluster& cluster, const model::FrameSlot& frame);

}  // namespace ttf::schedules::analysis
