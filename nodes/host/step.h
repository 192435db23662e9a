// The code of a task: a pure step from the contents of its input ports at its start to those of its output
// ports at its end.
//
// A step receives its instants and never asks for them, so it runs under every engine. Its outputs become
// visible at the task's end, even if the computation took no time.
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
#include "nodes/host/mode_frames.h"
#include "recording/records/records.h"
#include "schedules/model/pdu.h"

namespace ttf::nodes::host {

// An input port, as the task found it at its start.
struct Input {
  std::string_view port;
  PduId pdu{};
  const schedules::model::PduLayout* layout = nullptr;
  std::optional<bus::cni::ListView> list;  // the newest complete list, if any ever arrived
  bool fresh = false;                      // the task sees it for the first time
  bool discarded = false;                  // set by a step that cannot use the list; counted and recorded
};

// An output port: a list under construction. Its capacity is the layout's maximum, allocated once.
class Output {
 public:
  Output(std::string_view port, PduId pdu, const schedules::model::PduLayout& layout);

  std::string_view port() const { return port_; }
  PduId pdu() const { return pdu_; }
  const schedules::model::PduLayout& layout() const { return *layout_; }

  // Begins a list of `count` zeroed elements (at most layout().max_elements), and fills in the headers.
  // `time_stamp` goes into the header's "timestamp", if the layout has one.
  void begin(std::uint32_t sequence, int count, GlobalTime time_stamp);
  // Sets signal `signal` of element `index` from its physical value, saturated at the signal's range.
  void set(int index, std::size_t signal, double physical);
  // Sets the smallest code that is not below the physical value: an uncertainty is never understated.
  void set_at_least(int index, std::size_t signal, double physical);
  // Copies a list whose layout has the same fragments, as a gateway does.
  void copy(const bus::cni::ListView& list);

  bool written() const { return written_; }
  bus::cni::ListView view() const;
  void clear() { written_ = false; }
  int take_saturated();  // number of values outside their signal's range since the last call

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

// A measurement at its host: its number, counted by the device, and the global time of its strobe.
struct Strobe {
  std::uint32_t sequence = 0;
  GlobalTime at{};
};

// A host's latch for its sensor's strobes: it keeps the newest measurements.
class StrobeLatch {
 public:
  void strobe(std::uint32_t sequence, GlobalTime at);
  // Returns the newest strobe whose number has these low `bits`; a list on the bus carries no others. After
  // device or host has started anew, only one of them has counted how often that field has wrapped.
  std::optional<Strobe> find(std::uint32_t sequence, int bits) const;

 private:
  static constexpr std::size_t kDepth = 16;
  Strobe entries_[kDepth];
  std::size_t count_ = 0;  // strobes seen; the newest is entry (count_ - 1) % kDepth
};

// An actuator's demand on the vehicle, from a true instant after the end of its task on. It is an act beside the bus, as a
// sensor's strobe is: it takes no slot.
struct Actuation {
  TrueTime from{};
  double acceleration = 0.0;  // [m/s^2]
  double steering = 0.0;      // [rad]
};

struct StepContext {
  recording::records::Stamp stamp;  // the task's start on all clocks; true time is for emulators and records
  bool global_time = true;          // if false, the node has none, and the stamp has its own clock's
  std::uint32_t activation = 0;     // number of earlier executions of the task
  std::uint32_t measurement = 0;    // for sensor devices: the sequence number of this measurement
  // The instant that a task with modes is executed for. Where a frame begins, the step may set the mode of this frame.
  std::optional<ModeTurn> turn = {};
  std::span<Input> inputs;                  // in the order of the task's `reads`
  std::span<Output> outputs;                // in the order of the task's `writes`
  std::span<const StrobeLatch> strobes;     // by SensorId
  std::uint64_t unlisted = 0;               // set by a step that had no room for all its records; counted
  std::optional<Actuation> actuation = {};  // set by an actuator's step; it leaves at the task's end
  recording::records::Sink* sink = nullptr;
};

class Step {
 public:
  virtual ~Step() = default;
  virtual void run(StepContext& context) = 0;
  // Returns whether only the newest list at this port counts, because it describes a state: one that is overwritten unread
  // is no loss.
  virtual bool reads_newest(std::string_view /*port*/) const { return false; }
};

// Returns the measurement of a raw list, new or not, if its strobe is among the newest.
std::optional<Strobe> strobe_of(const StepContext& context, const Input& raw, SensorId sensor);
// Returns the measurement of a new raw list at the first input. A list whose strobe was not seen has no time
// and is discarded.
std::optional<Strobe> measurement_of(StepContext& context, SensorId sensor);

// Returns the instant of a list's "timestamp" header signal, in microseconds, on the reader's own count of cycles.
//
// The signal holds the low bits of the sender's global time. Nodes agree on the cycle counter, but each
// counts its wraps itself: a node that integrates into a running cluster begins at the counter it finds. So a
// stamp is known modulo a round, gCycleCountMax + 1 cycles, and means the instant nearest to `near`. Within half a round of
// `near`, this is the instant with these low bits. Otherwise the sender counts other rounds, and its stamp is
// shifted by whole rounds. The signal must not have wrapped on the sender's count: 32 bits hold 71 minutes.
GlobalTime time_stamp(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, GlobalTime near,
                      Duration round);
// Returns the instant of a measurement or a command, which lies before `now`: up to seven eighths of a round. The rest allows for
// clocks ahead of this one.
GlobalTime past_time_stamp(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, GlobalTime now,
                           Duration round);
// Returns the number of elements in the list.
int element_count(const schedules::model::PduLayout& layout, const bus::cni::ListView& list);
// Returns the physical value of signal `signal` of element `index` of the whole list.
double element_value(const schedules::model::PduLayout& layout, const bus::cni::ListView& list, int index,
                     std::size_t signal);

}  // namespace ttf::nodes::host
