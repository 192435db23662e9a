// A DDS channel: one of the two topics of an exchange, with one member's writer and reader, reliable and
// keeping all samples.
//
// Both keep the last samples for readers that come, or come back, later (transient local). So no member misses
// a hello, and a process that was stopped beyond its lease still gets its missed samples.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/said.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class Channel {
 public:
  // `topic`: its name; `session`: its partition. Other sessions are not received.
  Channel(const common::Participant& participant, const std::string& topic, const std::string& session);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  // Numbers the sample and sends it, ignoring `said.number`. Waits while others have no room.
  void say(common::Said said);

  // Hands over samples in order of arrival, some at a time; returns whether there were any. Throws
  // std::runtime_error on a sample that is not of an exchange.
  bool take(const std::function<void(const ttf::bus::dds::common::Said&)>& visit);

  // Waits for at most `patience` until all readers have all samples sent so far; returns whether they have.
  bool acknowledged_within(std::chrono::nanoseconds patience) const;

  // Returns whether the received writers, or those that DDS counts as alive, may have changed since the last call.
  bool connections_changed();
  // Returns whether this sender was received and DDS has lost it since: its lease ran out, or it ended.
  bool lost(NodeId sender) const;

  common::Handle reader() const { return reader_; }
  common::Handle reading() const { return reading_; }

 private:
  common::Handle topic_ = 0;
  common::Handle writer_ = 0;
  common::Handle reader_ = 0;
  common::Handle reading_ = 0;  // a condition: samples wait
  std::uint64_t next_number_ = 0;
  std::array<std::uint64_t, 256> writers_{};  // by sender: DDS' number of the writer last received; 0: none
  bool changed_ = true;
};

}  // namespace ttf::bus::dds::exchange
