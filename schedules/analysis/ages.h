// How old a measurement is when it is available, fused and used: best and worst case, by path.
//
// The path of a sensor's lists is followed from its measuring task over every medium and task that passes them on, to
// the task that fuses them (it reads them and writes none), from there through the task of the same node that writes
// the image, to the image's reader. Stages of a path:
//   span         an execution, a CAN transfer, waiting for a busy processor: between best and worst, at any phase.
//                A CAN transfer takes at best one frame without stuff bits, at worst a full list with maximal stuffing
//                behind one frame of lower priority and all traffic of higher priority (schedules/analysis/can_load.h).
//   activation   waiting for the next instant of a task that time activates (a reader that another list or another
//                task sets off is a span: up to two periods of the slowest sensor, or one of its chain's beginning and
//                all responses)
//   slots        waiting for the first of the list's slots, then its transmission. A list written after that slot has
//                begun waits for the next cycle of its frames, which is what the controller does (whole lists only). In
//                the dynamic segment a list is there at the earliest when one frame has been sent at once, at any
//                phase; at the latest it misses the instant at which its first slot's turn may come with all before it
//                silent, and in the next cycle of its frames all slots before each of them are used by their longest
//                frames (schedules/analysis/minislots.h). The checker demands that all of this fits the cycle.
// Assumptions:
//   A1  nothing fails: no lost frame, no deadline missed, no list replaced before it is read
//   A2  the cluster's clocks agree to gAssumedPrecision plus one macrotick; unsynchronised spans run on oscillators
//       that drift as far as the nodes may, and so does global time against true time. So the bounds hold on any clock.
//   A3  a measurement is fused as soon as the fusion node has it (ADVA, TT); BUFF's waiting is bounded separately
//   A4  one processor per node without preemption, first come first served; schedules/analysis/responses.h bounds
//       the wait
//   A5  a sensor that runs freely, or follows its host, has any phase against the cycle, so the wait at the first stage
//       on the cycle's grid is anything up to its period; from there on the grid is fixed and waits are exact. A
//       scheduled sensor is on the grid from the start. All 64 cycles are gone through.
// The bounds are safe: simulated ages lie between them.
#pragma once

#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// One stage's share. `best` belongs to the path of the smallest sum, `worst` to that of the largest: a single stage may
// well last longer than its `worst` says, where another one is shorter.
struct Contribution {
  std::string name;
  Duration best{};
  Duration worst{};
};

struct AgePath {
  SensorId sensor{};
  std::vector<Contribution> to_fusion;  // measurement -> complete in the fusion node's CNI; sums are the two below
  Duration fusion_best{}, fusion_worst{};
  Duration fused_best{}, fused_worst{};  // measurement -> start of the fusion task that reads it
  std::vector<Contribution> to_use;      // measurement -> start of the task that reads the first image with it in
  Duration use_best{}, use_worst{};
  // The newest measurement of the sensor that an image has in it, at any use of an image, not only the first: until the
  // use before the one at which the next measurement comes in.
  Duration newest_worst{};
  // With BUFF: held until no older measurement of any sensor can still arrive (schedules/analysis/settled.h), and,
  // where lists activate the fusing task, the next list comes.
  Duration buffered_fused_worst{}, buffered_use_worst{};
  Duration buffered_newest_worst{};  // the newest one at any use, as newest_worst
  bool reaches_use = false;          // else everything about use is zero
};

// In the order of Cluster::sensors; sensors whose lists reach no fusing task are left out. The cluster must have
// passed check().
std::vector<AgePath> measurement_ages(const model::Cluster& cluster);

// A table of the above in milliseconds, for people.
std::string ages_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::analysis
