// Controllers on one line, bit by bit, in exact time: the line is dominant while one of them drives it so.
//
// Lines have no delay, and all controllers the same clock. Each has bits of its own, which begin where its bits before
// ended. So bits of controllers differ only while some are at the data rate of CAN FD and others have left it with an
// error. A controller samples at the end of its bit. One that waits takes up the time of a falling edge (hard
// synchronisation). Instants are counted in whole units, of which both bit rates have a whole number in a bit; they
// are rounded up to nanoseconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bus/can/protocol.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::bus::can {

class Line {
 public:
  Line(const schedules::model::CanBus& bus, std::size_t controllers);

  std::size_t size() const { return members_.size(); }
  const Protocol& operator[](std::size_t member) const { return members_[member].protocol; }

  void power_on(std::size_t member, bool integrated, TrueTime now);
  void power_off(std::size_t member);
  void hold_off(std::size_t member);               // as in Protocol
  void release(std::size_t member, TrueTime now);  // the same
  void set_acknowledging(std::size_t member, bool does) { members_[member].protocol.set_acknowledging(does); }
  // Returns whether all members let the line be recessive in the present bit.
  bool recessive() const { return recessive_; }
  // Begins a frame at `now`, with its start of frame. Precondition: the member is idle.
  void start(std::size_t member, const FrameBits& frame, TrueTime now);

  // Returns the end of the first bit that is not over; never, if all are off.
  TrueTime next() const;
  struct Disturbed {
    bool dominant = false;                  // something holds the line
    std::optional<std::size_t> bit;         // it is seen inverted, in the frame on the line
    const std::vector<bool>* by = nullptr;  // by these members; null: by all
  };
  // Ends the bits that end at next(). The outcome is valid until the next step; members whose bit goes on have none.
  const std::vector<Protocol::Brought>& step(const Disturbed& disturbed);
  // Lets an idle line be idle from `now` on: its members' bits begin there.
  void align(TrueTime now);
  // A frame that no member makes out goes by, and the line is idle from `end` on (Protocol::pass_by). The bits of idle
  // members begin there, and those of members that are bus off with the eleven recessive ones at its end.
  void pass_by(TrueTime end);
  // Returns whether no member changes while something holds the line, for however long.
  bool endures_dominance() const;
  // Lets time pass up to shortly before `until`, in whole eights of nominal bits. Precondition: endures_dominance().
  void endure(TrueTime until);

 private:
  static constexpr std::int64_t kNoBit = std::int64_t{1} << 62;
  struct Member {
    Protocol protocol;
    std::int64_t bit_ends = kNoBit;
  };
  std::int64_t length_of_bit(const Protocol& protocol) const { return protocol.data_rate() ? data_ : nominal_; }
  std::int64_t first_end() const;
  TrueTime time_of(std::int64_t units) const;
  std::int64_t units_at(TrueTime now) const;
  void begin_at(TrueTime now);
  void release_line();

  std::int64_t nominal_ = 1, data_ = 1;  // units in a bit
  std::int64_t units_per_second_ = 1;
  std::vector<Member> members_;
  std::vector<Protocol::Brought> brought_;
  bool recessive_ = true;  // as the members drive it
  TrueTime origin_{};      // where units count from
  std::int64_t at_ = 0;    // the last step
};

}  // namespace ttf::bus::can
