// The start-up diagram of a time window: what every node's protocol operation control was in and what it sent, so that
// one can see who led, who followed and who integrated. Of a run that began integrated it shows who left and came back.
//
// One lane per node that changed its state, was powered on or off or sent something: its states as labelled bars
// (hovering over one tells why it was entered), below them what it sent on channel A and on channel B: startup frames,
// null frames, other frames, symbols. Faults of the run's plan that are there in the window have lanes of their own,
// above. The grid shows the communication cycles of the leading coldstart node, counted from its collision avoidance
// symbol. Time is TrueTime.
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
  // `cycle`: nominal length of the communication cycle, 0 for no grid. Frames and symbols after the window are passed
  // over.
  StartupDiagram(drawing::Names names, Duration cycle, TrueTime from, TrueTime to);

  using recording::records::Sink::on;  // the kinds of record that are not shown
  void on(const recording::records::StateChanged& r) override;
  void on(const recording::records::PowerChanged& r) override;
  void on(const recording::records::SymbolSent& r) override;
  void on(const recording::records::SlotFrameSent& r) override;
  void on(const recording::records::FaultActivity& r) override;

  // The picture; one that says so if no node changed its state or lost its supply.
  std::string svg() const;

 private:
  drawing::Names names_;
  Duration cycle_;
  TrueTime from_, to_;
  StartupData data_;
};

// When the start-up in a log happened: from the first record of it to the last of the nodes' first entries into normal
// active. Of a run that began integrated: from the first return of a node, or, if none came back, from the first loss
// on.
struct StartupExtent final : recording::records::Sink {
  using recording::records::Sink::on;
  void on(const recording::records::StateChanged& r) override;
  void on(const recording::records::PowerChanged& r) override;

  // All of it: a little before, and two cycles after. Nothing where no node was powered on or changed its state.
  std::optional<std::pair<TrueTime, TrueTime>> window(Duration cycle) const;

 private:
  void see(TrueTime at, bool starts);
  std::optional<TrueTime> first_, first_start_, last_active_, last_;
  std::vector<bool> active_ = std::vector<bool>(256);
};

}  // namespace ttf::report::startup
