// A member of an exchange at work (bus/dds/exchange/exchange.h). It has the other members, their samples, and
// its part in agreeing on the end of dead members (bus/dds/exchange/stream.h).
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/said.h"
#include "bus/dds/common/session.h"
#include "bus/dds/exchange/channel.h"
#include "bus/dds/exchange/exchange.h"
#include "bus/dds/exchange/numbering.h"
#include "bus/dds/exchange/received_counts.h"
#include "bus/dds/exchange/stream.h"
#include "bus/dds/exchange/waiter.h"
#include "bus/ports/exchange.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class Exchange::Member {
 public:
  Member(const common::Session& session, NodeId self);

  void wait_ready(std::chrono::milliseconds patience);
  void send(std::span<const std::byte> message);
  ports::Exchange::Received receive();
  void leave();

 private:
  using Clock = std::chrono::steady_clock;

  struct Other {
    explicit Other(Stream its_stream) : stream(std::move(its_stream)) {}
    Stream stream;
    std::uint32_t round = 0;  // the last kClose's; 0: none
    bool confirmed = false;   // whether kClosed has been said for `round`
  };
  // A result of receive() to come; no bytes: gone.
  struct Coming {
    NodeId from{};
    common::Bytes bytes;
  };

  // Takes the samples that have come; returns whether there were any.
  bool take();
  void drain_data();
  void on_data(const common::Said& said);
  void on_control(const common::Said& said);
  void on_fence(const common::Said& said);
  void on_close(const common::Said& said);
  void on_again(const common::Said& said);
  void deliver(NodeId from);  // delivers entries_
  void confirm(NodeId of, Other& other);
  void report_received();
  Other& other(NodeId node);

  void say(Channel& channel, common::Kind kind) { channel.say({.sender = self_, .kind = kind}); }
  bool everybody(const std::set<NodeId>& said) const;
  [[noreturn]] void give_up(std::chrono::milliseconds waited) const;
  bool nobody_left() const { return gone_.size() == others_.size(); }
  // Throws if waiting is in vain; otherwise returns the time of the next check, if one is needed.
  std::optional<Clock::time_point> look_around();
  // Notes members that DDS has lost, and found again.
  void note_lost();
  void wait(std::optional<Clock::time_point> until);

  const common::Session session_;
  const NodeId self_;
  common::Participant participant_;
  Channel data_;
  Channel control_;
  Waiter waiter_;

  Numbering control_numbers_;
  std::map<NodeId, Other> others_;
  ReceivedTable received_table_;
  std::size_t received_bytes_ = 0;                       // since the last kReceived
  std::set<NodeId> data_hello_, control_hello_, ready_;  // members that have said it
  std::set<NodeId> gone_;                                // known here; receive() may still have to report it
  std::map<NodeId, Clock::time_point> lost_;             // until when it may come back
  bool all_ready_ = false;
  bool cut_off_ = false;
  bool supervisor_left_ = false;
  bool left_ = false;
  Clock::time_point last_death_{};
  std::vector<common::Entry> entries_;  // scratch
  std::deque<Coming> coming_;
  common::Bytes current_;  // the last result of receive()
};

}  // namespace ttf::bus::dds::exchange
