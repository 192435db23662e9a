// Puts what a cluster file leaves out of its schedule where it follows from the rest: each as early as may be.
//
//   sensor   measures at the beginning of the first cycle
//   task     begins when all lists that it reads are certainly there, and its processor is free for it and all that follow it. Lists
//            that no instant of the schedule begins do not count. The task that writes the image
//            begins behind all tasks of its node that fuse
//   list     has the first free static slots, one behind the other, that begin when its writer has certainly ended
//
// The first that can begin is placed first. Sensors come before tasks, and tasks before lists, each in the order of the file, where all can. "Certainly" is
// by the bounds of schedules/analysis (sources.h). Time counts on from a measurement to its use: an instant is taken modulo its
// period. Written instants never move: data passes on at the next of them.
//
// A list of one frame may stand in its sender's key slot, in every cycle (use_key_slots).
#pragma once

#include "core/errors.h"
#include "schedules/left_out/parts.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::left_out {

// Gives a list of one frame its sender's key slot, in every cycle, if no frame stands there: without a status frame the list keeps
// the clocks together. A list whose repetition the file says is of every cycle only if that is 1.
void use_key_slots(const model::Cluster& cluster, std::vector<List>& lists);

// Sets instants, repetitions and the frames of lists. A value that does not follow is a finding: nothing leads to it, or there is no
// room for it. The cluster must be whole otherwise; `parts.lists` get their values as well.
void put_earliest(model::Cluster& cluster, Parts& parts, Findings& findings);

// Adds the frames of a whole list, in consecutive slots.
void add_frames(model::Cluster& cluster, const List& list);

// Sets the deadlines of tasks that are left out: the longest time from activation to end, rounded up to 10 us. Without a bound, the
// longest execution.
void set_deadlines(model::Cluster& cluster, const std::vector<std::vector<TaskParts>>& tasks);

}  // namespace ttf::schedules::left_out
