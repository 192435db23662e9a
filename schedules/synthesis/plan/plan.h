// A plan: a cluster with values left out, and the section `plan` with the demands on them. Everything that the file says is
// fixed; everything that it leaves out is free.
//
// The model is that of a cluster (schedules/model/cluster.h). Placeholders stand where the plan leaves a value out, and the
// plan says where they stand. schedules/synthesis/instants/candidates.h replaces periods and FlexRay's parameters, and
// schedules/synthesis/instants/written.h the instants.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/text_place.h"
#include "core/time.h"
#include "schedules/left_out/parts.h"
#include "schedules/model/cluster.h"
#include "schedules/synthesis/plan/demands.h"

namespace ttf::schedules::synthesis::plan {

using LeftOut = left_out::Instant;
using PlannedTask = left_out::TaskParts;
using PlannedList = left_out::List;  // slots of a list

// How often a sensor may measure.
struct Rate {
  Duration shortest{}, longest{};  // period
  int line = 0;
};

struct PlannedSensor {
  LeftOut at;
  std::optional<Rate> rate;      // if its repetition is left out
  std::optional<SensorId> like;  // a copy of this one
};

// The age of the sensor's measurements when the task begins that takes them, at first use.
struct PlannedChain {
  std::string name;
  SensorId from{};
  NodeId node{};
  std::size_t task = 0;  // within the node
  std::optional<Duration> largest_age;
  int line = 0;
};

enum class Goal : std::uint8_t {
  kWorstAge,  // least: the largest age over the chains
  kDataAge,   // least: the largest age over the chains when the next output of the chain's end takes its place
  kSlots,     // least: the last static slot in use
  kJitter,    // least: the largest difference between the worst and the best age of a chain
  kRoom,      // most: the share of the static segment's frames that stay free
  kError,     // least: the expected squared error of an estimator at its uses (plan.error)
  kGapError,  // least: the expected squared error of the gap to a vehicle ahead (plan.gap_error)
};
// Their words in plans and results, in the enumeration's order.
inline constexpr std::array kGoalWords{"worst_age", "data_age", "slots", "jitter", "room", "error", "gap_error"};
static_assert(kGoalWords.size() == static_cast<std::size_t>(Goal::kGapError) + 1);
constexpr const char* name_of(Goal goal) { return kGoalWords[static_cast<std::size_t>(goal)]; }

// Possible lengths of the cycle: shortest, shortest + step, ..., at most longest.
struct CycleLengths {
  Duration shortest{}, longest{}, step{};
  int line = 0;
};

// Possible payloads of the static slots [bytes]: shortest, shortest + step, ..., at most longest; all even.
struct PayloadLengths {
  int shortest = 0, longest = 0, step = 2;
  int line = 0;
};

// FlexRay's parameters that follow from the length of the cycle, where the plan leaves them out.
struct LeftOutParameters {
  bool static_slots = false, idle_time = false, correction_start = false;
  bool slot_length = false;  // with a free payload: the shortest that holds it
  struct Controller {
    bool microticks = false, rate = false, listen = false;
  };
  std::vector<Controller> controllers;  // by node
};

// The parts that instants do not depend on, kept once for all candidates.
struct Unchanging {
  std::map<std::string, int, std::less<>> parameter_lines;
  std::vector<model::PduLayout> pdus;  // with their signals
};

struct Plan {
  model::Cluster cluster;  // without the frames of `lists`, and without what is in `unchanging`
  std::shared_ptr<const Unchanging> unchanging;
  CycleLengths cycle;  // one length, if the plan says gdCycle
  bool free_cycle = false;
  std::optional<PayloadLengths> payload;  // none: the plan says gPayloadLengthStatic
  std::vector<bool> free_layouts;         // by PDU: a fragment has as many elements as the payload holds
  LeftOutParameters parameters;
  std::vector<std::vector<PlannedTask>> tasks;      // by node and task
  std::vector<PlannedSensor> sensors;               // by sensor
  std::vector<PlannedList> lists;                   // those with a value left out
  std::vector<std::size_t> one_channel;             // numbers of lists on A or B, as the plan chooses
  std::vector<std::vector<bool>> shortest_periods;  // by CAN and message: left out
  std::vector<PlannedChain> chains;                 // in the plan's order
  std::vector<Goal> objective;                      // the most important first
  std::optional<ErrorDemand> error;
  GapErrorDemand gap_error;
  bool slot_multiplexing = true;  // a static slot may have several senders, in different cycles (FlexRay 3.0)
  bool in_order = true;  // lists are fused in the order of their measurements, so that none waits for an older one
  TextOrigins origins;   // the files and lines of its text, if it extends another plan

  const model::Task& task(const PlannedChain& chain) const { return cluster.node(chain.node).tasks[chain.task]; }
};

}  // namespace ttf::schedules::synthesis::plan
