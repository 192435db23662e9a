// The faults of a drive in a picture over time: a lane for each, from its begin to its end or the window's, with a mark at each
// of its acts.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/records.h"
#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "report/drawing/svg.h"

namespace ttf::report::drawing {

// A record of a fault as a picture keeps it.
struct FaultEvent {
  FaultEvent(const recording::records::FaultActivity& r)
      : at(r.at), fault(r.fault), what(r.what), node(r.node), kind(r.kind), text(r.text) {}
  recording::records::FaultActivity record() const { return {at, fault, what, node, kind, text}; }

  TrueTime at;
  std::uint32_t fault;
  recording::records::FaultAct what;
  NodeId node;
  std::string kind, text;
};

class FaultLanes {
 public:
  static constexpr double kHeight = 22;

  // Takes the faults that last into the window or act in it. `events` outlives this; a fault whose begin the log lacks is left
  // out.
  FaultLanes(const std::vector<FaultEvent>& events, const Names& names, TrueTime from, TrueTime to);

  std::size_t count() const { return lanes_.size(); }
  double height() const { return static_cast<double>(lanes_.size()) * kHeight; }
  double label_width() const;
  // `plot` starts with these lanes at its top; `x` maps an instant to its place. `tag` returns the attributes of a fault's bar or,
  // without an end, of an act; `beyond`: the fault lasts longer than the window.
  using Tag = std::function<std::string(TrueTime start, std::optional<TrueTime> end, bool beyond)>;
  void draw_labels(Svg& svg, const Area& plot) const;
  void draw(Svg& svg, const Area& plot, const std::function<double(TrueTime)>& x, const Tag& tag = {}) const;
  void add_to(std::vector<LegendEntry>& legend) const;

 private:
  struct Lane {
    std::string label, text;
    TrueTime start, end;
    bool ends;                            // within the window
    std::vector<const FaultEvent*> acts;  // within the window
  };
  TrueTime from_, to_;
  std::map<std::uint32_t, Lane> lanes_;  // by fault
};

}  // namespace ttf::report::drawing
