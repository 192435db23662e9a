#include "nodes/runner/paced_can.h"

#include <algorithm>
#include <limits>

#include "bus/wire/can_timing.h"
#include "core/check.h"

namespace ttf::nodes::runner {

PacedCan::PacedCan(const schedules::model::Cluster& cluster, std::size_t can_bus, std::size_t most,
                   std::function<recording::records::Stamp()> now)
    : bus_(cluster.can_buses[can_bus]), can_bus_(static_cast<std::uint8_t>(can_bus)), now_(std::move(now)),
      ring_(most) {}

void PacedCan::send(const bus::ports::CanFrame& frame) {
  if (count_ == ring_.size()) {
    ++dropped_;
    return;
  }
  Waiting& waiting = ring_[(first_ + count_) % ring_.size()];
  TTF_CHECK(frame.data.size() <= waiting.data.size(), "{} bytes", frame.data.size());
  waiting.identifier = frame.identifier;
  waiting.flexible_data_rate = frame.flexible_data_rate;
  waiting.size = frame.data.size();
  std::copy(frame.data.begin(), frame.data.end(), waiting.data.begin());
  if (++count_ == 1) begin_first(std::max(now_().true_time, idle_from_));
}

void PacedCan::begin_first(TrueTime at) {
  const Waiting& waiting = ring_[first_];
  began_ = now_();
  began_.true_time = at;
  const bus::wire::CanFrameTimes times =
      bus::wire::can_frame_times(bus_, waiting.identifier, std::span(waiting.data).first(waiting.size));
  through_ = at + times.accepted;
  idle_from_ = at + times.idle;
}

TrueTime PacedCan::next() const { return count_ == 0 ? TrueTime{std::numeric_limits<std::int64_t>::max()} : through_; }

PacedCan::Departure PacedCan::leave() {
  TTF_CHECK(count_ > 0, "nothing waits on {}", bus_.name);
  const Waiting& waiting = ring_[first_];
  const std::span<const std::byte> data = std::span<const std::byte>(waiting.data).first(waiting.size);
  Departure departure;
  departure.frame = {waiting.identifier, waiting.flexible_data_rate, data};
  departure.sent.bus = can_bus_;
  departure.sent.start = began_;
  departure.sent.end.true_time = through_;
  departure.sent.identifier = waiting.identifier;
  departure.sent.flexible_data_rate = waiting.flexible_data_rate;
  departure.sent.data = data;
  first_ = (first_ + 1) % ring_.size();
  // A late departure does not delay the next frame, which was already waiting.
  if (--count_ > 0) begin_first(idle_from_);
  return departure;
}

}  // namespace ttf::nodes::runner
