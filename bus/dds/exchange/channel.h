// One of the two topics of an exchange, as one member has it: a writer and a reader, reliable, keeping everything.
//
// Both keep the last samples for readers that come, or come back, later (transient local), so that nobody misses a
// hello, and a process that was stopped for longer than its lease is told what it missed.
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
  // `topic`: its name; `session`: its partition. Who is in another session is not heard.
  Channel(const common::Participant& participant, const std::string& topic, const std::string& session);
  ~Channel();
  Channel(const Channel&) = delete;
  Channel& operator=(const Channel&) = delete;

  // Numbers and says it; `said.number` is not looked at. Waits while others have no room.
  void say(common::Said said);

  // Hands over what has come, in order of arrival, some at a time. Whether there was anything.
  // Throws std::runtime_error on what is no sample of an exchange.
  bool take(const std::function<void(const ttf::bus::dds::common::Said&)>& visit);

  // Waits, so long at most, until everybody has everything said so far; whether they have.
  bool acknowledged_within(std::chrono::nanoseconds patience) const;

  // Whether who is heard, or whom DDS takes to be alive, may have changed since the last call.
  bool connections_changed();
  // Whether this sender has been heard and DDS has since lost it: its lease ran out, or it ended.
  bool lost(NodeId sender) const;

  common::Handle reader() const { return reader_; }
  common::Handle reading() const { return reading_; }

 private:
  common::Handle topic_ = 0;
  common::Handle writer_ = 0;
  common::Handle reader_ = 0;
  common::Handle reading_ = 0;  // the condition that something has come
  std::uint64_t next_number_ = 0;
  std::array<std::uint64_t, 256> writers_{};  // by sender: DDS' number of the writer last heard; 0: none
  bool changed_ = true;
};

}  // namespace ttf::bus::dds::exchange
