// The modes of a task: each is a frame of instants, repeated until another mode is asked for at a frame's end.
//
// An activation of kind `modes` has a grid, the cycles c with c mod repetition == base_cycle. A frame begins in a cycle of the
// grid, and its instants count whole cycles from there. All lie at the activation's macrotick. The next frame begins where
// this one ends. So a frame may last any number of cycles, where a CycleInstant repeats after 1, 2, 4, ... or 64.
//
// An instant says what the execution that begins there is for: a camera's whole picture or its region of interest
// (schedules/sequence/detections.h), and how long it takes. The host has instants and times alone.
// schedules/file/load_modes.h reads them, and schedules/modes proves them sound.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::schedules::model {

struct ModeInstant {
  int cycle = 0;           // in the frame, from 0: a multiple of the grid's repetition
  Duration lasts{};        // the execution's time
  std::size_t camera = 0;  // its place among the task's cameras (camera_ports())
  bool secondary = false;  // its region of interest alone
  int line = 0;
};

struct TaskMode {
  std::string name;
  int cycles = 0;                     // a frame's: a multiple of the grid's repetition
  std::vector<ModeInstant> instants;  // in order; the first is in cycle 0
  int line = 0;
};

inline constexpr std::size_t kMostModes = 32;
inline constexpr int kMostModeCycles = 100'000;

}  // namespace ttf::schedules::model
