// The dynamic segment in the schedule: the minislots of a frame, and the earliest and latest turn of a slot
// (FlexRay 2.1A, chapter 5.1.3). During a cycle bus/controller/dynamic_segment.h counts the minislots.
//
// A transmission begins at the action point of a minislot m. Its trailing sequence (DTS, at least one bit) ends
// at the first action point that leaves room for the frame, in minislot m + k,
//   k = ceil((frame bits + 1) gdBitMax / (gdMinislot gdMacrotick (1 - cClockDeviationMax)))
// with gdBitMax = gdBit (1 + cClockDeviationMax): longest bits, shortest macroticks. gdDynamicSlotIdlePhase
// minislots of silence follow, so that the slot takes
//   aMinislotPerDynamicFrame = k + 1 + gdDynamicSlotIdlePhase
// A slot that begins no later than in minislot pLatestTx ends within the segment if
//   pLatestTx <= gNumberOfMinislots - aMinislotPerDynamicFrame + 1
// This is the specification's constraint on pLatestTx in annex B, for the longest frame of the node. The
// derivation above uses the controller's rule in chapter 5.1.3. A silent slot takes one minislot.
//
// The earliest turn of slot s on a channel is in minislot s - gNumberOfStaticSlots, when all slots before it are
// silent. The latest turn is when every slot before it that shares one of its cycles carries its longest frame.
// If that is no later than pLatestTx, a waiting frame is sent in its next cycle: its delay has a bound.
#pragma once

#include <cstdint>

#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// Returns the start of a minislot, counted from 1; gNumberOfMinislots + 1 is the segment's end.
Macroticks minislot_start(const model::GlobalParameters& flexray, std::int64_t minislot);

// Returns the payload length of a dynamic frame, in words.
int dynamic_words(const model::Cluster& cluster, const model::FrameSlot& frame);

// Returns pPayloadLengthDynMax, the length of a node's longest dynamic frame; 0 if it sends none.
int longest_dynamic_words(const model::Cluster& cluster, NodeId sender);

// Returns the minislots of a slot with a frame of this many words, idle phase included.
std::int64_t minislots_of(const model::GlobalParameters& flexray, int words);

// Returns the largest pLatestTx for a frame of this many words; below 1 if it never fits.
std::int64_t last_start(const model::GlobalParameters& flexray, int words);

// Return the minislot of a dynamic frame's turn, over all its cycles and channels.
int earliest_turn(const model::GlobalParameters& flexray, const model::FrameSlot& frame);
std::int64_t latest_turn(const model::Cluster& cluster, const model::FrameSlot& frame);

// Returns whether the frame's turn is never too late for its sender.
bool always_in_time(const model::Cluster& cluster, const model::FrameSlot& frame);

}  // namespace ttf::schedules::analysis
