// Longest responses of a task in a slot of its own of a time-division (TDMA) cycle.
//
// The worst arrival comes just behind the slot's end. Work x is then done after
//   x + ceil(x / s) (L - s)
// with slots s of a cycle L (J. Diemer, P. Axer, R. Ernst: Compositional performance analysis in Python with pyCPA,
// WATERS 2012). Instance q of a busy period ends after F(q) with x = (q + 1) C, and its response is F(q) + J - q T.
#pragma once

#include <cstdint>

#include "schedules/timing/response/response.h"

namespace ttf::schedules::timing::response {

struct TdmaSlot {
  std::int64_t length = 0;  // s, 1..L
  std::int64_t cycle = 0;   // L
};

struct TdmaTask {
  std::int64_t period = 0;  // T, at least 1: the least time between two arrivals
  std::int64_t work = 0;    // C, at least 1. It may be interrupted at the slot's end
  std::int64_t jitter = 0;  // J
};

// Exact: the task has its slot alone and any phase. Unbounded if C / T > s / L.
Response tdma_response(const TdmaSlot& slot, const TdmaTask& task);

}  // namespace ttf::schedules::timing::response
