// The code of a task: a pure step from what its input ports held at its start to what its output ports will show at its
// end.
//
// Who turns the crank is not a step's business: it is handed the instants, never asks for them. Its outputs become
// visible at the task's end, also where computing them took no time at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "schedules/model/pdu.h"

namespace ttf::nodes::host {

// An input port as the task found it at its start.
struct Input {
  std::string_view port;
  PduId pdu{};
  const schedules::model::PduLayout* layout = nullptr;
  std::optional<bus::cni::ListView> list;  // the newest complete list, if any ever arrived
  bool fresh = false;                      // first time this task sees it
  bool discarded = false;                  // set by a step that cannot use the list it was given; counted and recorded
};

// An output port: a list under construction. Capacity is the layout's maximum, taken once.
class Output {
 public:
  Output(std::string_view port, PduId pdu, const schedules::model::PduLayout& layout);

  std::string_view port() const { return port_; }
  PduId pdu() const { return pdu_; }
  const schedules::model::PduLayout& layout() const { return *layout_; }

  // Starts a list of `count` elements (at most layout().max_elements), zeroed, and fills in the headers. `time_stamp`
  // goes into the header's "timestamp" where the layout has one.
  void begin(std::uint32_t sequence, int count, GlobalTime time_stamp);
  // Sets signal `signal` of element `index` from its physical value, saturating at the signal's range.
  void set(int index, std::size_t signal, double physical);
  // Takes over a list whose layout has the same fragments, as a gateway does.
  void copy(const bus::cni::ListView& list);

  bool written() const { return written_; }
  bus::cni::ListView view() const;
  void clear() { written_ = false; }
  int take_saturated();  // values outside their signal's range since the last call

 private:
  std::string_view port_;
  PduId pdu_;
  const schedules::model::PduLayout* layout_;
  std::vector<std::byte> bytes_;
  std::uint32_t sequence_ = 0;
  int fragments_ = 0;
  bool written_ = false;
  int saturated_ = 0;
};

// A measurement as its host saw it: its number as the device counts, and the global time of its strobe.
struct Strobe {
  std::uint32_t sequence = 0;
  GlobalTime at{};
};

// A host's latch for its sensor's strobe: the newest measurements.
class StrobeLatch {
 public:
  void strobe(std::uint32_t sequence, GlobalTime at);
  // The newest whose number has these low `bits`: all that a list on the bus carries of it. Where device or host
  // started anew, how often that field has wrapped is known to the one alone.
  std::optional<Strobe> find(std::uint32_t sequence, int bits) const;

 private:
  static constexpr std::size_t kDepth = 16;
  Strobe entries_[kDepth];
  std::size_t count_ = 0;  // strobes seen; the newest is entry (count_ - 1) % kDepth
};

struct StepContext {
  recording::records::Stamp stamp;       // the task's start on all clocks; true time is for emulators and records
  bool global_time = true;               // else the node knows none, and the stamp's is its own clock's
  std::uint32_t activation = 0;          // how many times the task ran before
  std::uint32_t measurement = 0;         // sensor devices: the sequence number of this measurement
  std::span<Input> inputs;               // in the order of the task's `reads`
  std::span<Output> outputs;             // in the order of the task's `writes`
  std::span<const StrobeLatch> strobes;  // by SensorId
  std::uint64_t unlisted = 0;            // set by a step that had more to record than it has room for; counted
  recording::records::Sink* sink = nullptr;
};

class Step {
 public:
  virtual ~Step() = default;
  virtual void run(StepContext& context) = 0;
};

// The measurement whose raw list is new at the first input; a list whose strobe was not seen has no time and is
// discarded.
std::optional<Strobe> measurement_of(StepContext& context, SensorId sensor);

// A list's microsecond time stamp of the "timestamp" header signal, on the reader's own count of cycles.
//
// The signal holds the low bits of the sender's global time. Nodes agree on the cycle counter, 0..63: how often it has
// wrapped each counts for itself, and one that integrates into a running cluster counts from the counter it finds. So
// what a stamp says is known modulo a round, 64 cycles, and meant is the instant nearest to `near` that fits. Within
// half a round of `near` that is the instant with these low bits itself; else the sender counts other rounds, and its
// stamp is brought here by whole rounds. That takes a signal that has not wrapped on the sender's count: 32 bits hold
// 71 minutes.
GlobalTime time_stamp(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, GlobalTime near,
                      Duration round);
// Elements in the list.
int element_count(const schedules::model::PduLayout& layout, const bus::cni::ListView& list);
// Physical value of signal `signal` of element `index` of the whole list.
double element_value(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, int index,
                     std::size_t signal);

}  // namespace ttf::nodes::host
