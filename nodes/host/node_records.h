// A node's records: each event at its controllers and each step of its lists becomes a record, with all that
// the node has of it.
#pragma once

#include <cstdint>

#include "bus/cni/can_controller.h"
#include "bus/controller/controller.h"
#include "nodes/host/executive_counts.h"
#include "nodes/host/node_time.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

class NodeRecords {
 public:
  // The arguments outlive this.
  NodeRecords(const schedules::model::Cluster& cluster, const NodeTime& time, recording::records::Sink& sink)
      : cluster_(cluster), time_(time), sink_(sink), wants_frames_(sink.wants_frames()) {}

  // Returns whether to record every frame; if not, only the departure of a list's last frame is recorded.
  bool wants_frames() const { return wants_frames_; }
  recording::records::Sink& sink() { return sink_; }
  ExecutiveCounts& counts() { return counts_; }
  const ExecutiveCounts& counts() const { return counts_; }

  void hop(const recording::records::Stamp& at, recording::records::Hop what, PduId pdu, std::uint32_t sequence,
           schedules::model::MediumId medium);
  void task_run(const recording::records::TaskRun& run) { sink_.on(run); }
  void woke_up(Microticks at) { sink_.on(recording::records::PowerChanged{time_.stamp(at), true}); }

  // The events of bus::controller::ControllerEvents.
  void frame_sent(const bus::ports::Transmission& transmission, std::int64_t cycle, bool null_frame, PduId pdu,
                  std::uint32_t sequence, int fragment, bool last);
  void slot_problem(std::int64_t cycle, int slot, schedules::model::Channel channel, bus::controller::SlotStatus status,
                    Microticks at);
  void clock_corrected(std::int64_t cycle, const timebase::Correction& offset, const timebase::Correction& rate,
                       Microticks at);
  void symbol_sent(bus::ports::Signal signal, schedules::model::Channel channel, Microticks start, Microticks end);
  void state_changed(bus::poc::PocKind from, const bus::poc::PocStep& step, Microticks at);

  // Records that a frame left at `now`, sent by `sender`, a controller of the node. `frame` is that of
  // Executive::can_frame_sent().
  void can_frame_sent(recording::records::CanFrameSent frame, const bus::cni::CanController& sender, Microticks now);

 private:
  void identify(recording::records::CanFrameSent& frame, const bus::cni::CanController& sender) const;

  const schedules::model::Cluster& cluster_;
  const NodeTime& time_;
  recording::records::Sink& sink_;
  const bool wants_frames_;
  ExecutiveCounts counts_;
};

}  // namespace ttf::nodes::host
