// Where a record stands among the records of a run: the canonical order of merged logs. Private to the room.
//
// By (true time, rank of its kind, what it is about), then:
//   records of a node                 as that node reported them; what is said twice in different logs, by payload
//   records of the run as a whole     by payload: any process may have reported them
//
// True time is the record's own, signed, as MCAP's log_time; a fault counts 100 ns earlier, because nodes say in whole
// microticks when something happened to them, and would be struck before the blow. The ranks put causes before effects,
// as readers rely on where things happen at one instant: a fault begins before what it does, supplies come and go
// before states change, a fusion step's inputs stand before its tracks, these before the image made of them, and uses
// before the truth they are held against. Within a kind the order of a node's own reports counts (its states follow
// each other, an image's predictions are in the order of its objects); it is the same in every process that runs the
// node.
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
  std::uint64_t about = 0;  // the node, else what of the run's it is: numbers in the order they are to have
};

// Tells `placed` the place of every record it sees.
std::unique_ptr<records::Sink> placing(std::function<void(const RecordPlace&)> placed);

}  // namespace ttf::recording::merge
