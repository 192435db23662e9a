// Follows measurements through a drive, from the sensor to the feature service, while its records go by.
// Diagrams and exports draw the same ways.
//
// Sensor and number name a measurement; its lists' frames and hops bear them. A way passes, in this order:
// - the frames of its lists, on the first channel that has them, each fragment once;
// - the tasks that read or write a list;
// - the step that fuses it, and any that held it before;
// - the step that writes the first image in which it is its sensor's newest, and that image's frames;
// - the task that first uses the image, where the way ends.
// The way of a measurement that was not fused ends where it was lost. No way is followed longer than kLongestWay.
// An image's own way starts at the task that wrote it. Exact numbers separate lists, not nearness in time.
#pragma once

#include <bitset>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "recording/records/records.h"

namespace ttf::recording::exports {

// A frame, an execution of a task or an instant on a way, numbered by the caller.
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
    kRefused,  // by the fusion step: too old, or a duplicate
    kLost,     // on the way to the fusion step
    kImage,    // written
    kImageFrame,
    kUsed,
  };
  struct Stop {
    Deed deed{};
    TrueTime at{};
    NodeId node = kNoNode;
    std::optional<WayMark> mark;  // the stop's frame or instant; for an act of a task its execution, absent if
                                  // unknown
  };
  struct Way {
    MeasurementId id;
    std::uint64_t number = 0;  // order of the measurements, from 1 on
    TrueTime measured{};
    std::vector<Stop> stops;      // in the order of their reports
    std::optional<WayMark> lost;  // where the list was first lost or refused
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

  // Report the points that ways may pass, in the order of time; only within one instant the order is free.
  void measured(const MeasurementId& id, NodeId node, const WayMark& mark);
  void frame(bool flexray, std::uint8_t channel, NodeId sender, SensorId sensor, std::uint32_t sequence,
             std::uint8_t fragment, const WayMark& mark);
  void executed(NodeId node, TrueTime start, TrueTime end, const WayMark& mark);

  // A node writes or reads a list that belongs to no sensor: it may be an image. A use names the image's number alone;
  // the user's last reads identify the image, by their writers that fuse.
  void wrote(NodeId node, PduId pdu) { writers_[pdu] = node; }
  void read(NodeId node, PduId pdu, std::uint32_t sequence) { read_[node][pdu] = sequence; }

  // An act of a node's task: kWritten at its end, all others at its start. Writer and number name an image. (frame()
  // makes a kImageFrame of an image's frame.)
  struct Act {
    Deed deed{};
    TrueTime at{};
    NodeId node{};
    std::vector<MeasurementId> ids;  // for an image: the newest of each sensor; for a use: empty
    std::uint32_t image = 0;
    WayMark mark{};  // where the list was lost or refused; or the image's frame
    std::uint8_t channel = 0, fragment = 0;
    NodeId writer = kNoNode;  // the used image's, if it was given; act() looks it up
  };
  void act(Act act);

  // Advances to `now`. Calls `on_act(act, execution)` for every act whose task's execution is known, with the mark of
  // the execution.
  template <class OnAct> void advance(TrueTime now, OnAct&& on_act) {
    while (!acts_.empty() && acts_.front().at + kRecordDelay < now) {
      if (const std::optional<WayMark> mark = perform(acts_.front())) on_act(acts_.front(), *mark);
      acts_.pop_front();
    }
    forget(now);
  }
  // Ends all ways.
  void finish();

 private:
  static constexpr Duration kRecordDelay = Duration::milliseconds(1);  // delay of its record after
                                                                       // its start
  static constexpr Duration kTolerance = Duration::microseconds(2);    // between a task's start and the stamps of its
                                                                       // acts then

  struct Carried {
    std::optional<std::uint8_t> channel;  // the first that had it
    std::bitset<256> fragments;           // seen so far
    bool takes(std::uint8_t on_channel, std::uint8_t fragment);
  };
  struct Followed {
    Way way;
    Carried on_flexray;
  };
  struct FollowedImage {
    Image image;
    std::vector<MeasurementId> ids;  // measurements whose ways go on with the image
    Carried on_flexray;
  };
  struct Execution {
    TrueTime start, end;
    WayMark mark;
  };
  using Ways = std::map<MeasurementId, Followed>;

  std::optional<WayMark> execution_of(const Act& act) const;
  std::optional<WayMark> perform(const Act& act);
  void pass(const MeasurementId& id, const Stop& stop);
  void write_image(const Act& act, const Stop& stop);
  void send_image(const Act& act);
  void use_image(const Act& act, const Stop& stop);
  NodeId writer_of(NodeId user, std::uint32_t image) const;
  void end(Ways::iterator followed);
  void forget(TrueTime now);

  Ended ended_;
  Ways ways_;
  std::deque<std::pair<TrueTime, MeasurementId>> begun_;  // in order; includes those that have ended
  std::deque<FollowedImage> images_;
  std::set<NodeId> fuses_;                                 // nodes that wrote images
  std::map<PduId, NodeId> writers_;                        // for lists that belong to no sensor
  std::map<NodeId, std::map<PduId, std::uint32_t>> read_;  // the last number of each list, by reader
  std::map<NodeId, std::deque<Execution>> executions_;
  std::deque<Act> acts_;
  std::uint64_t numbers_ = 0;
};

}  // namespace ttf::recording::exports
