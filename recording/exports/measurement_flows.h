// Measurements' ways through a drive, followed while its records go by: which slices of a timeline each passed, from
// the sensor to the feature service, so that arrows can join them.
//
// A measurement is known by its sensor and number, which its lists' frames and hops bear. It passes the frames of its
// lists (on the first channel that has them, and each fragment the first time it is sent), the tasks that read or write
// one, the step that fuses it (those that hold it back before, too), the step that writes the first image in which it
// is the newest of its sensor, that image's frames, and the task that first uses the image, where the way ends. One
// that was not fused ends where it was lost. Nobody is followed for longer than kLongestWay. Diagrams draw the same
// ways, from the records of a window (report/timing/ways.h); here they are exact numbers, not nearness in time, that
// tell lists apart.
#pragma once

#include <bitset>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "recording/exports/trace_timeline.h"
#include "recording/records/records.h"

namespace ttf::recording::exports {

class MeasurementFlows {
 public:
  static constexpr Duration kLongestWay = Duration::milliseconds(1500);

  // What is passed, as the timeline has it. In the order of time, but for what of one instant may come later.
  void measured(const MeasurementId& id, const TraceMark& mark);
  void frame(bool flexray, std::uint8_t channel, NodeId sender, SensorId sensor, std::uint32_t sequence,
             std::uint8_t fragment, const TraceMark& mark);
  void run(NodeId node, TrueTime start, TrueTime end, const TraceMark& mark);
  void lost(const MeasurementId& id, const TraceMark& mark);

  // What a node's task did then: kWritten at its end, all others at its start. Images are known by their number.
  // (kSent: a frame of an image, which frame() makes of it.)
  enum class Deed : std::uint8_t { kRead, kWritten, kHeld, kFused, kImage, kUsed, kSent };
  struct Act {
    Deed deed{};
    TrueTime at{};
    NodeId node{};
    std::vector<MeasurementId> ids;  // of an image: the newest of each sensor; of a use: none
    std::uint32_t image = 0;
    TraceMark frame{};
    std::uint8_t channel = 0, fragment = 0;
  };
  void act(Act act);

  // Time has come to `now`. Calls `told(act, run)` with every act whose task's run is known: the run's mark.
  template <class Told> void advance(TrueTime now, Told&& told) {
    while (!acts_.empty() && acts_.front().at + kRunIsTold < now) {
      if (const std::optional<TraceMark> run = perform(acts_.front())) told(acts_.front(), *run);
      acts_.pop_front();
    }
    forget(now);
  }
  // All ways end.
  void finish();

  // What flows through a mark. Complete when kLongestWay has passed since; forgotten by asking.
  std::vector<TraceFlow> take(const TraceMark& mark);

 private:
  static constexpr Duration kRunIsTold = Duration::milliseconds(1);  // after what a task did at its start
  static constexpr Duration kTolerance = Duration::microseconds(2);  // between a task's start and what it reports then

  struct Carried {
    std::optional<std::uint8_t> channel;  // the first that had it
    std::bitset<256> fragments;           // there
    bool takes(std::uint8_t on_channel, std::uint8_t fragment);
  };
  struct Way {
    std::uint64_t flow = 0;
    TrueTime measured{};
    std::vector<TraceMark> marks;
    std::optional<TraceMark> lost;
    Carried on_flexray;
    bool fused = false, in_image = false;
  };
  struct Image {
    TrueTime at{};
    NodeId node{};
    std::uint32_t sequence = 0;
    std::vector<MeasurementId> ids;  // whose ways go on with it
    Carried on_flexray;
  };
  struct Run {
    TrueTime start, end;
    TraceMark mark;
  };
  using Ways = std::map<MeasurementId, Way>;

  std::optional<TraceMark> run_of(const Act& act) const;
  std::optional<TraceMark> perform(const Act& act);
  void end(Ways::iterator way);
  void forget(TrueTime now);

  Ways ways_;
  std::deque<std::pair<TrueTime, MeasurementId>> begun_;  // in order; those that have ended, too
  std::deque<Image> images_;
  std::map<NodeId, std::deque<Run>> runs_;
  std::deque<Act> acts_;
  std::map<std::uint64_t, std::vector<TraceFlow>> flows_;  // by mark
  std::uint64_t flow_ids_ = 0;
};

}  // namespace ttf::recording::exports
