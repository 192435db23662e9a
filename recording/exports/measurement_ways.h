// Measurements' ways through a drive, followed while its records go by: what each passed, from the sensor to the
// feature service. Diagrams and exports draw the same ways.
//
// A measurement is known by its sensor and number, which its lists' frames and hops bear. It passes the frames of its
// lists (on the first channel that has them, and each fragment the first time it is sent), the tasks that read or write
// one, the step that fuses it (those that hold it back before, too), the step that writes the first image in which it
// is the newest of its sensor, that image's frames, and the task that first uses the image, where the way ends. One
// that was not fused ends where it was lost. Nobody is followed for longer than kLongestWay. An image's own way goes on
// from the task that wrote it. Exact numbers, not nearness in time, tell lists apart.
#pragma once

#include <bitset>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "recording/records/records.h"

namespace ttf::recording::exports {

// A frame, a task's run or an instant that may be passed, as whoever tells of it numbers them.
struct WayMark {
  TrueTime at{};
  std::uint64_t serial = 0;
  auto operator<=>(const WayMark&) const = default;
};

class MeasurementWays {
 public:
  static constexpr Duration kLongestWay = Duration::milliseconds(1500);

  enum class Deed : std::uint8_t {
    kMeasured,
    kFrame,  // a list's
    kRead,
    kWritten,
    kHeld,
    kFused,
    kRefused,  // by the fusion step: too old, or there already
    kLost,     // on its way to it
    kImage,    // written
    kImageFrame,
    kUsed,
  };
  struct Stop {
    Deed deed{};
    TrueTime at{};
    NodeId node = kNoNode;
    std::optional<WayMark> mark;  // what was passed; of what a task did its run, none where that was not told
  };
  struct Way {
    MeasurementId id;
    std::uint64_t number = 0;  // as they were measured, from 1 on
    TrueTime measured{};
    std::vector<Stop> stops;      // as they were told
    std::optional<WayMark> lost;  // where it was lost first, or refused
    bool fused = false, in_image = false;
  };
  struct Image {
    TrueTime at{};
    NodeId node{};
    std::uint32_t sequence = 0;
    std::vector<Stop> stops;
    bool used = false;
  };
  struct Ended {
    std::function<void(const Way&)> way;
    std::function<void(const Image&)> image;
  };
  explicit MeasurementWays(Ended ended) : ended_(std::move(ended)) {}

  // What may be passed. In the order of time, but for what of one instant may come later.
  void measured(const MeasurementId& id, NodeId node, const WayMark& mark);
  void frame(bool flexray, std::uint8_t channel, NodeId sender, SensorId sensor, std::uint32_t sequence,
             std::uint8_t fragment, const WayMark& mark);
  void run(NodeId node, TrueTime start, TrueTime end, const WayMark& mark);

  // What a node's task did then: kWritten at its end, all others at its start. Images are known by their number.
  // (kImageFrame is what frame() makes of an image's.)
  struct Act {
    Deed deed{};
    TrueTime at{};
    NodeId node{};
    std::vector<MeasurementId> ids;  // of an image: the newest of each sensor; of a use: none
    std::uint32_t image = 0;
    WayMark mark{};  // where it was lost or refused; the image's frame
    std::uint8_t channel = 0, fragment = 0;
  };
  void act(Act act);

  // Time has come to `now`. Calls `told(act, run)` with every act whose task's run is known: the run's mark.
  template <class Told> void advance(TrueTime now, Told&& told) {
    while (!acts_.empty() && acts_.front().at + kRunIsTold < now) {
      if (const std::optional<WayMark> run = perform(acts_.front())) told(acts_.front(), *run);
      acts_.pop_front();
    }
    forget(now);
  }
  // All ways end.
  void finish();

 private:
  static constexpr Duration kRunIsTold = Duration::milliseconds(1);  // after what a task did at its start
  static constexpr Duration kTolerance = Duration::microseconds(2);  // between a task's start and what it reports then

  struct Carried {
    std::optional<std::uint8_t> channel;  // the first that had it
    std::bitset<256> fragments;           // there
    bool takes(std::uint8_t on_channel, std::uint8_t fragment);
  };
  struct Followed {
    Way way;
    Carried on_flexray;
  };
  struct FollowedImage {
    Image image;
    std::vector<MeasurementId> ids;  // whose ways go on with it
    Carried on_flexray;
  };
  struct Run {
    TrueTime start, end;
    WayMark mark;
  };
  using Ways = std::map<MeasurementId, Followed>;

  std::optional<WayMark> run_of(const Act& act) const;
  std::optional<WayMark> perform(const Act& act);
  void pass(const MeasurementId& id, const Stop& stop);
  void write_image(const Act& act, const Stop& stop);
  void send_image(const Act& act);
  void use_image(const Act& act, const Stop& stop);
  void end(Ways::iterator followed);
  void forget(TrueTime now);

  Ended ended_;
  Ways ways_;
  std::deque<std::pair<TrueTime, MeasurementId>> begun_;  // in order; those that have ended, too
  std::deque<FollowedImage> images_;
  std::map<NodeId, std::deque<Run>> runs_;
  std::deque<Act> acts_;
  std::uint64_t numbers_ = 0;
};

}  // namespace ttf::recording::exports
