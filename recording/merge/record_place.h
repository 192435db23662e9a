// The place of a record in the canonical order of merged logs. Private to the module.
//
// Records are ordered by (true time, rank of the kind, subject), then:
//   records of a node                 in the order of that node's reports; repetitions in other logs, by payload
//   records of the drive as a whole   by payload: any process may have reported them
//
// True time is the record's own, signed, as in MCAP's log_time. A fault counts 100 ns earlier: nodes stamp in
// whole microticks, which could put its effect before it. Readers rely on the ranks, which put causes before
// effects at one instant. A fault begins before it acts, and power changes precede changes of state. A fusion
// step's inputs precede its tracks, and tracks their image. Uses precede the truth that judges them. Within a
// kind, a node's own reports keep their order, which is the same in every process that runs the node.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "recording/records/records.h"

namespace ttf::recording::merge {

struct RecordPlace {
  TrueTime at{};
  std::uint8_t rank = 0;
  bool of_node = false;
  std::uint64_t about = 0;  // the node, else the subject, as a number in the order wanted
};

// Returns a sink that passes the place of every record to `placed`.
std::unique_ptr<records::Sink> placing(std::function<void(const RecordPlace&)> placed);

}  // namespace ttf::recording::merge
