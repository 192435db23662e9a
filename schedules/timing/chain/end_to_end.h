// Reaction time and data age of a chain of cause and effect, each also reduced.
//
//   reaction time (MRT)            from an event outside to the first output that rests on it. The event may just have
//                                  missed a reading.
//   reduced reaction time (MRRT)   from the reading that takes the event in, to the same output
//   data age (MDA)                 from a reading to the last instant at which an output that rests on it is in force
//   reduced data age (MRDA)        from a reading to the last output that rests on it
// All four are the largest ones. An output is a write of the last stage; the next one replaces it. MRT = MDA for
// periodic first stages (Guenzel, Teper, Chen, von der Brueggen, Chen: "On the equivalence of maximum reaction time and
// maximum data age for cause-effect chains", ECRTS 2023); here each comes from a walk of its own. MRRT <= MRT and
// MRDA <= MDA.
//
// Stages in a row with one origin make a segment. Walks over its hyperperiod follow its jobs: for a reaction forwards,
// from each reading that an event just misses; for an age backwards, from each output. Each step takes the latest write
// and the earliest reading, so later data never arrive earlier.
//
// Several segments have unknown phases against each other. An event that a segment writes may just miss the next one,
// so that the sums of their times bound the chain:
//   MRT  <= sum MRT(s)     MRRT <= MRRT(first) + sum MRT(others)      MDA <= sum MDA(s)     MRDA likewise, at the last
// (Guenzel, Chen, Ueter, von der Brueggen, Duerr, Chen: "Timing analysis of asynchronized distributed cause-effect
// chains", RTAS 2021). For sampled stages of unknown phase alone the bound is sum(T + R) (Davare, Zhu, Di Natale,
// Pinello, Kanajan, Sangiovanni-Vincentelli: "Period optimization for hard real-time distributed automotive systems",
// DAC 2007). A stage behind its sender (Stage::behind_sender) needs no R of a sender that is a segment of its own: jobs
// released by then have written when the reader starts. The idea is that of Duerr, von der Brueggen, Chen, Chen:
// "End-to-end timing analysis of sporadic cause-effect chains in distributed systems", TECS 18(5s), 2019.
//
// A first stage that is activated takes each event as it comes. Its reaction needs no sampling. The next event may come
// at any later time, so that data stay in force for an unknown time: there are no ages. Only a chain whose stages are
// all activated has a reduced age.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "schedules/timing/chain/stage.h"

namespace ttf::schedules::timing::chain {

// The share of one stage, on a way that takes longest.
struct Share {
  Duration waits{};  // a value waits for the stage's reading; of a first stage: the event does
  Duration runs{};   // from the reading to the writing
  Duration stays{};  // the value stays in force until the stage's next write
};

struct Figure {
  Duration time{};
  std::vector<Share> shares;  // one for each stage; their sum is the time
};

struct EndToEnd {
  Figure reaction, reduced_reaction;
  std::optional<Figure> age, reduced_age;
  // The times are reached. Otherwise they are bounds. Stages of any phase make bounds, except for a single one.
  bool exact = false;
};

// A segment's walk goes over at most so many jobs of each stage. A longer hyperperiod is cut into segments.
inline constexpr std::int64_t kMostJobs = 200'000;

// Returns the times of a chain of at least one stage. Stages must be sound (stage.h).
EndToEnd end_to_end(std::span<const Stage> stages);

}  // namespace ttf::schedules::timing::chain
