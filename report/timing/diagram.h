// The timing diagram of a time window: who did what when, and the way of every measurement through it.
//
// Lanes from top to bottom: measurement instants of each sensor, private CANs and the tasks up to the gateway
// in the order a measurement passes them, the frames of FlexRay channel A and of channel B, the tasks of the
// fusion node and of the feature services. The grid shows the communication cycles. Arrows follow each
// measurement from its instant over CAN, preprocessing, gateway and slots to the fusion step that used it,
// coloured per sensor and dashed where it arrived out of sequence (after a newer one); black arrows follow
// the image to the feature service. Faults have a lane each on top, with marks where they act; frames that were on a
// channel otherwise than they were sent are outlined, and crossed out if nothing of them arrived. In runs in real time,
// marks show what was late, early or lost. Time is TrueTime.
#pragma once

#include <cstdint>
#include <string>

#include "recording/records/records.h"
#include "report/drawing/names.h"
#include "report/timing/data.h"

namespace ttf::report::timing {

// A picture by itself, or part of a page whose script zooms and explains it: what moves then has its times with it,
// in attributes (report/timing/tags.h).
enum class TimingUse : std::uint8_t { kPicture, kPage };

class TimingDiagram : public recording::records::Sink {
 public:
  // `cycle`: length of the communication cycle, 0 for no grid. Records outside the window (with a margin for
  // ways that lead into it) are passed over, so memory does not grow with the log.
  TimingDiagram(drawing::Names names, Duration cycle, TrueTime from, TrueTime to);

  using recording::records::Sink::on;  // the kinds of record that are not shown
  void on(const recording::records::Measured& r) override;
  void on(const recording::records::CanFrameSent& r) override;
  void on(const recording::records::SlotFrameSent& r) override;
  void on(const recording::records::ListHop& r) override;
  void on(const recording::records::TaskRun& r) override;
  void on(const recording::records::ListFused& r) override;
  void on(const recording::records::FusionStep& r) override;
  void on(const recording::records::ImageWritten& r) override;
  void on(const recording::records::FeatureUsed& r) override;
  void on(const recording::records::FaultActivity& r) override;
  void on(const recording::records::ChannelFrame& r) override;
  void on(const recording::records::TimingProblem& r) override;

  // The picture; one that says so if the window holds no records.
  std::string svg() const { return svg(TimingUse::kPicture); }
  std::string svg(TimingUse use) const;

 private:
  bool near(TrueTime start, TrueTime end) const;

  drawing::Names names_;
  Duration cycle_;
  TrueTime from_, to_;
  TimingData data_;
};

}  // namespace ttf::report::timing
