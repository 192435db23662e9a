// The age of a measurement when it is available, fused and used: best and worst case by path.
//
// The path of a sensor's lists leads from its measuring task through media and tasks to the fusing task, which
// reads them and writes none. It continues through the task of the same node that writes the image, to the
// image's reader. Stages of a path:
//   span         an execution, a CAN transfer or the wait for a busy processor: between best and worst, at any phase.
//                The best CAN transfer is one frame without stuff bits. The worst is a full list with maximal stuffing
//                behind one frame of lower priority and all traffic of higher priority (schedules/analysis/can_load.h).
//   activation   the wait for the next instant of a task that time activates. (A reader that another list or task
//                activates is a span: up to two periods of the slowest sensor, or one period of its chain's beginning
//                and all responses.)
//   slots        the wait for the first of the list's slots, then its transmission. A list written after that slot's
//                start waits for the next cycle of its frames, as in the controller (whole lists only). In the
//                dynamic segment the earliest arrival is that of one frame sent at once, at any phase. At the latest
//                the list misses the earliest turn of its first slot, and in the next cycle of its frames all slots
//                before each of them carry their longest frames (schedules/analysis/minislots.h). The checker demands
//                that all of this fits the cycle.
// Assumptions:
//   A1  no faults: no lost frame, no missed deadline, no list replaced before it is read
//   A2  the cluster's clocks agree to gAssumedPrecision plus one macrotick; unsynchronised spans, and global time
//       against true time, have the largest drift of the nodes. So the bounds hold on any clock.
//   A3  a measurement is fused as soon as the fusion node has it (ADVA, TT); BUFF's waiting is bounded separately
//   A4  one processor per node without preemption, first come first served; schedules/analysis/responses.h bounds
//       the wait
//   A5  a sensor that runs freely or follows its host has any phase against the cycle: the wait at the first stage on
//       the cycle's grid is up to its period; from there on the grid is fixed and waits are exact. A scheduled sensor
//       is on the grid from the start. A whole round of cycles is analysed.
// The bounds are safe: simulated ages lie between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::analysis {

// The share of one stage. `best` belongs to the path of the smallest sum, `worst` to that of the largest: a
// single stage may exceed its `worst` if another one is shorter.
struct Contribution {
  std::string name;
  Duration best{};
  Duration worst{};
};

// An instant on a measurement's way that a drive's records show, behind so many of the stages.
struct Waypoint {
  enum class Kind : std::uint8_t {
    kWritten,   // a task's output is visible: a list, or the image
    kReceived,  // it is complete at its reader
    kRead,      // the reading task starts
    kFused,     // the fusing task takes the list in: at its start or, if it is held for order, at a later one
    kImage,     // the task that writes the image starts
    kUsed,      // the image's reader starts
  };
  Kind kind{};
  NodeId node{};
  PduId pdu = kNoPdu;      // for the first three kinds
  std::size_t stages = 0;  // counted in AgePath::to_use, or in to_fusion without a use
  // Bounds of the age there. Between fusion and use there are none with BUFF: 0.
  Duration best{}, worst{};
  Duration buffered_worst{};
};

struct AgePath {
  SensorId sensor{};
  std::vector<Contribution> to_fusion;  // measurement -> complete in the fusion node's CNI; sums are the two below
  Duration fusion_best{}, fusion_worst{};
  Duration fused_best{}, fused_worst{};  // measurement -> start of the fusion task that reads it
  std::vector<Contribution> to_use;      // measurement -> start of the task that reads the first image that contains it
  Duration use_best{}, use_worst{};
  // The largest age of the sensor's newest measurement in an image, at any use of the image. It is reached at
  // the last use before the one that shows the next measurement.
  Duration newest_worst{};
  // With BUFF: held until no older measurement of any sensor can arrive (schedules/analysis/settled.h) and, if
  // lists activate the fusing task, until the next list comes.
  Duration buffered_fused_worst{}, buffered_use_worst{};
  Duration buffered_newest_worst{};  // at any use, as newest_worst
  std::vector<Waypoint> waypoints;   // in order; the last is the use, or the fusion without one
  bool reaches_use = false;          // otherwise everything about use is zero
  // A task that holds lists (model::Task::holds) passes some measurements on, and not others. Ages are those of lists
  // that it passes on. How often it does is not known: the age of the newest at any use supposes that it passes all on.
  bool chosen = false;
};

// Returns the paths of observations in the order of Cluster::sensors, without sensors whose lists reach no fusing task. The
// cluster must have passed check().
std::vector<AgePath> measurement_ages(const model::Cluster& cluster);
// Returns the paths of odometry, likewise. They end where a sample is read: it is not held, and no image shows it.
std::vector<AgePath> odometry_ages(const model::Cluster& cluster);

// Returns the ages as a table in milliseconds, for people.
std::string ages_text(const model::Cluster& cluster);

}  // namespace ttf::schedules::analysis
