// A member's view of another: that one's samples in order, each once, up to the last. Pure;
// bus/dds/exchange/exchange.h carries the samples.
//
// One survivor may have received more of a dead member than another. So the survivors agree on its end: the
// supervisor has all of them fence the stream and report how far they got. It then closes the stream at the
// best report, and the best informed survivor repeats the samples that others lack. A sample that no survivor
// received is lost to all.
//
//   open --fence()--> fenced --close()--> closing --(all there)--> closed
//   open --kBye--> closed        fenced and closing may be fenced again, by a later round
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "bus/dds/common/said.h"
#include "core/ids.h"

namespace ttf::bus::dds::exchange {

class Stream {
 public:
  // `retain_bytes`: how much is kept for repetition; 0: nothing.
  Stream(NodeId sender, std::size_t retain_bytes) : sender_(sender), retain_bytes_(retain_bytes) {}

  // Takes a sample from the sender itself, or a repeated one. Appends to `received` the samples that can now be
  // received, in order; the last is of kind kBye. Throws std::runtime_error if the sender skipped a number:
  // samples are lost.
  void accept(common::Entry entry, std::vector<common::Entry>& received);
  // Forgets the samples before number `settled`, which all members have received.
  void settle(std::uint64_t settled);
  // Stops receiving until close(). Returns the number of samples received so far.
  std::uint64_t fence();
  // Ends the stream before number `end`, which is never before a received sample.
  void close(std::uint64_t end, std::vector<common::Entry>& received);

  std::uint64_t received() const { return next_; }  // the number of samples
  bool closed() const { return phase_ == Phase::kClosed; }
  // Returns whether the stream waits for repeated samples.
  bool wanting() const { return phase_ == Phase::kClosing; }
  // Returns the missing samples in words. Precondition: wanting().
  std::string missing() const;
  // Returns the samples received from number `first` on. Throws std::runtime_error if they are no longer kept.
  std::vector<common::Entry> again(std::uint64_t first) const;

 private:
  enum class Phase { kOpen, kFenced, kClosing, kClosed };

  void receive(common::Entry entry, std::vector<common::Entry>& received);
  void receive_waiting(std::vector<common::Entry>& received);
  void keep(const common::Entry& entry);
  void forget();  // drops the oldest kept sample

  NodeId sender_;
  std::size_t retain_bytes_;
  Phase phase_ = Phase::kOpen;
  std::uint64_t next_ = 0;                          // the next number to receive
  std::uint64_t end_ = 0;                           // of kClosing
  std::map<std::uint64_t, common::Entry> waiting_;  // after the fence, or after a gap
  std::deque<common::Entry> kept_;                  // the last received, without a gap, up to next_
  std::size_t kept_bytes_ = 0;
};

}  // namespace ttf::bus::dds::exchange
