// What one member hears of another: its samples in order, each once, up to the one with which it ends. Pure; who
// carries the samples is bus/dds/exchange/exchange.h's business.
//
// A member that dies may have been heard further by one survivor than by another. So its end is agreed upon: the
// supervisor has everybody fence the stream and report how far it got; it then closes the stream where the best
// informed survivor is, and that one says again what others lack. What was not heard by any survivor is not heard
// at all.
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
  // `retain_bytes`: how much of what was heard is kept to be said again; 0: nothing.
  Stream(NodeId sender, std::size_t retain_bytes) : sender_(sender), retain_bytes_(retain_bytes) {}

  // A sample from the sender itself, or said again. What can now be heard, in order, is appended to `heard`; the
  // last is of kind kBye. Throws std::runtime_error where the sender skipped a number: samples are lost.
  void accept(common::Entry entry, std::vector<common::Entry>& heard);
  // Everybody has heard the samples before number `settled`; they need not be kept.
  void settle(std::uint64_t settled);
  // Nothing further is heard until close(). Returns the number of samples heard so far.
  std::uint64_t fence();
  // The stream ends before number `end`; never before what has been heard.
  void close(std::uint64_t end, std::vector<common::Entry>& heard);

  std::uint64_t heard() const { return next_; }  // how many samples
  bool closed() const { return phase_ == Phase::kClosed; }
  // Waits for something to be said again.
  bool wanting() const { return phase_ == Phase::kClosing; }
  // What is still missing, in words. Precondition: wanting().
  std::string missing() const;
  // What was heard from number `first` on. Throws std::runtime_error where it is no longer kept.
  std::vector<common::Entry> again(std::uint64_t first) const;

 private:
  enum class Phase { kOpen, kFenced, kClosing, kClosed };

  void hear(common::Entry entry, std::vector<common::Entry>& heard);
  void hear_waiting(std::vector<common::Entry>& heard);
  void keep(const common::Entry& entry);
  void forget();  // the oldest that is kept

  NodeId sender_;
  std::size_t retain_bytes_;
  Phase phase_ = Phase::kOpen;
  std::uint64_t next_ = 0;                          // the number that is heard next
  std::uint64_t end_ = 0;                           // of kClosing
  std::map<std::uint64_t, common::Entry> waiting_;  // behind the fence, or behind what is missing
  std::deque<common::Entry> kept_;                  // heard last, without a gap, up to next_
  std::size_t kept_bytes_ = 0;
};

}  // namespace ttf::bus::dds::exchange
