// The list `frames` of a cluster file. An entry is a status frame, or consecutive slots of a list.
//
// A status frame without `slot` has its sender's pKeySlotId, if the file says it and the slot is free. Else it has the lowest slot that
// no entry, no other node's pKeySlotId and no status frame before it has. It is of every cycle. `channels` that are absent are the sender's, and `fragments` that are absent are all of the PDU. Slots, base cycle and
// repetition of a list may be absent: schedules/left_out/earliest.h puts them.
#pragma once

#include <vector>

#include "core/strict_yaml.h"
#include "schedules/file/names.h"
#include "schedules/left_out/parts.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

inline const Choices<model::Channels> kChannelChoices{
    {"A", model::Channels::kA}, {"B", model::Channels::kB}, {"AB", model::Channels::kAB}};

// Adds the frames to the cluster, ordered by slot and base cycle, and the lists that leave something out to `lists`. All else of
// the cluster is read before.
void load_frames(std::vector<YamlMap>& entries, const Names& names, model::Cluster& cluster,
                 std::vector<left_out::List>& lists);

}  // namespace ttf::schedules::file
