// The timing diagram of a time window: tasks, frames and faults in time, and the way of every measurement.
//
// Lanes from top to bottom: the measurement instants of each sensor; private CANs and the tasks up to the
// gateway, in the order of a measurement's way; the frames of FlexRay channel A and of channel B; the tasks
// of the fusion node and of the feature services. The grid shows the communication cycles. Arrows follow each
// measurement from its instant over CAN, preprocessing, gateway and slots to its fusion instant. Each sensor
// has a colour; an arrow is dashed if its list arrived out of sequence (after a newer one). Black arrows
// follow the image to the feature service. Each fault has a lane on top, with marks where it acts. Frames
// that differ on a channel from the sent ones are outlined, and crossed out if they reached no receiver. In
// drives in real time, marks show late, early or lost events. Time is TrueTime.
#pragma once

#include <cstdint>
#include <string>

#include "recording/records/records.h"
#include "report/drawing/names.h"
#include "report/timing/data.h"

namespace ttf::report::timing {

// A picture by itself, or a part of a page whose script zooms and explains it. In a page, moving parts carry
// their times in attributes (report/timing/tags.h).
enum class TimingUse : std::uint8_t { kPicture, kPage };

class TimingDiagram : public recording::records::Sink {
 public:
  static constexpr Duration kMargin = Duration::milliseconds(300);  // the longest way that is followed into the window

  // `cycle` is the length of the communication cycle, 0 for no grid. Records outside the window are skipped,
  // except in a margin for ways that lead into it: memory does not grow with the log.
  TimingDiagram(drawing::Names names, Duration cycle, TrueTime from, TrueTime to);

  using recording::records::Sink::on;  // kinds of record that are not shown
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

  // Returns the picture; a window without records gives a picture that says so. Throws InputError if paper is too narrow.
  std::string svg(const drawing::Sheet& sheet = {}) const { return svg(TimingUse::kPicture, sheet); }
  std::string svg(TimingUse use, const drawing::Sheet& sheet = {}) const;

  TrueTime from() const { return from_; }
  TrueTime to() const { return to_; }
  // Returns whether a measurement, a frame or a task is in the window itself.
  bool shows_anything() const;

 private:
  bool near(TrueTime start, TrueTime end) const;

  drawing::Names names_;
  Duration cycle_;
  TrueTime from_, to_;
  TimingData data_;
};

}  // namespace ttf::report::timing
