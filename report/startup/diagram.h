// The start-up diagram of a time window: each node's states of protocol operation control and its
// transmissions. It shows the leading, following and integrating nodes. For a drive that began integrated it
// shows the nodes that left and came back.
//
// A node that changed its state, was powered on or off, or sent has one lane. Labelled bars show its states;
// hovering over a bar shows its cause. Below them are its transmissions on channel A and on channel B:
// startup frames, null frames, other frames, symbols. Planned faults within the window have lanes of their
// own, above. The grid shows the communication cycles of the leading coldstart node, counted from its
// collision avoidance symbol. Time is TrueTime.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recording/records/records.h"
#include "report/drawing/names.h"
#include "report/startup/data.h"

namespace ttf::report::startup {

class StartupDiagram : public recording::records::Sink {
 public:
  // `cycle` is the nominal length of the communication cycle, 0 for no grid. Frames and symbols after the
  // window are skipped.
  StartupDiagram(drawing::Names names, Duration cycle, TrueTime from, TrueTime to);

  using recording::records::Sink::on;  // kinds of record that are not shown
  void on(const recording::records::StateChanged& r) override;
  void on(const recording::records::PowerChanged& r) override;
  void on(const recording::records::SymbolSent& r) override;
  void on(const recording::records::SlotFrameSent& r) override;
  void on(const recording::records::FaultActivity& r) override;

  // Returns the picture; without a change of state or a loss of supply, it says so.
  std::string svg(const drawing::Sheet& sheet = {}) const;

 private:
  drawing::Names names_;
  Duration cycle_;
  TrueTime from_, to_;
  StartupData data_;
};

// The time of the start-up in a log: from its first record to the last node's first entry into normal active. In a
// drive that began integrated, it starts with the first return of a node, or, without a return, with the first loss.
struct StartupExtent final : recording::records::Sink {
  using recording::records::Sink::on;
  void on(const recording::records::StateChanged& r) override;
  void on(const recording::records::PowerChanged& r) override;

  // Returns the start-up with a short margin before and two cycles after; no value if no node was powered on
  // or changed its state.
  std::optional<std::pair<TrueTime, TrueTime>> window(Duration cycle) const;

 private:
  void see(TrueTime at, bool starts);
  std::optional<TrueTime> first_, first_start_, last_active_, last_;
  std::vector<bool> active_ = std::vector<bool>(256);
};

}  // namespace ttf::report::startup
