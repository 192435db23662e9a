// The timing diagrams of a whole drive, window by window. Each is painted when its records have gone by, so that memory
// holds a few windows, never the drive. Records come in the order of merged logs (docs/reference/log_format.md).
//
// Laws (tests/report/timing/windows/windows_test.cc):
//   W1  A window's picture is that of a TimingDiagram of the same window by itself.
//   W2  Windows begin at `anchor`, and at whole lengths before and after it; none begins before the drive. They come in
//       order.
//   W3  A window in which nothing is sent, measured or executed is left out.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "recording/records/records.h"
#include "report/drawing/fault_lanes.h"
#include "report/drawing/names.h"
#include "report/timing/diagram.h"

namespace ttf::report::timing::windows {

class PaintedWindows final : public recording::records::Sink {
 public:
  // Takes a window's picture, as TimingUse::kPage has it. Returns whether it takes more.
  using Painted = std::function<bool(TrueTime from, TrueTime to, const std::string& svg)>;

  // `length` is positive.
  PaintedWindows(drawing::Names names, Duration cycle, TrueTime anchor, Duration length, Painted painted);

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

  // Paints the windows that are still open. Call it once, at the end.
  void finish();

 private:
  template <class Record> void pass(const Record& record, TrueTime begin, TrueTime end);
  std::int64_t window_of(TrueTime t) const;
  TrueTime begin_of(std::int64_t window) const { return anchor_ + length_ * window; }
  void open(std::int64_t window);
  void close_before(TrueTime t);
  void paint(std::int64_t window);

  drawing::Names names_;
  Duration cycle_;
  TrueTime anchor_;
  Duration length_;
  Painted painted_;
  std::map<std::int64_t, TimingDiagram> open_;  // by number; 0 begins at the anchor
  std::int64_t next_;                           // windows before it are painted
  TrueTime newest_{};
  std::vector<drawing::FaultEvent> faults_;  // their begins and ends, which later windows show, too
  bool full_ = false;
};

}  // namespace ttf::report::timing::windows
