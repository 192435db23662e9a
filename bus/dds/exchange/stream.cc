#include "bus/dds/exchange/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/check.h"

namespace ttf::bus::dds::exchange {
namespace {

// The approximate memory of a kept entry beside its bytes.
constexpr std::size_t kEntryBytes = 96;

std::size_t cost(const common::Entry& entry) { return kEntryBytes + (entry.bytes ? entry.bytes->size() : 0); }

std::string lost(NodeId sender, std::uint64_t first, std::uint64_t end) {
  return fmt::format("exchange: samples {} to {} of node {} are lost", first, end - 1, index_of(sender));
}

}  // namespace

void Stream::accept(common::Entry entry, std::vector<common::Entry>& received) {
  if (closed() || entry.number < next_) return;  // received before, or beyond the agreed end
  switch (phase_) {
    case Phase::kOpen:
      if (entry.number > next_) throw std::runtime_error(lost(sender_, next_, entry.number));
      receive(std::move(entry), received);
      return;
    case Phase::kFenced:
    case Phase::kClosing:
      waiting_.try_emplace(entry.number, entry);
      if (phase_ == Phase::kClosing) receive_waiting(received);
      return;
    case Phase::kClosed: return;
  }
}

std::uint64_t Stream::fence() {
  if (!closed()) phase_ = Phase::kFenced;
  return next_;
}

void Stream::close(std::uint64_t end, std::vector<common::Entry>& received) {
  TTF_CHECK(end >= next_, "node {} ends at {}, but {} were heard", index_of(sender_), end, next_);
  if (closed()) return;
  phase_ = Phase::kClosing;
  end_ = end;
  receive_waiting(received);
}

std::string Stream::missing() const {
  TTF_CHECK(wanting());
  return lost(sender_, next_, waiting_.empty() ? end_ : std::min(end_, waiting_.begin()->first));
}

std::vector<common::Entry> Stream::again(std::uint64_t first) const {
  const std::uint64_t oldest = next_ - kept_.size();
  if (first < oldest)
    throw std::runtime_error(lost(sender_, first, oldest) + " to others, and this node no longer has them");
  if (first >= next_) return {};
  return {kept_.begin() + static_cast<std::ptrdiff_t>(first - oldest), kept_.end()};
}

void Stream::receive(common::Entry entry, std::vector<common::Entry>& received) {
  keep(entry);
  ++next_;
  if (entry.kind == common::Kind::kBye) phase_ = Phase::kClosed;
  received.push_back(std::move(entry));
}

void Stream::receive_waiting(std::vector<common::Entry>& received) {
  while (!closed() && next_ < end_ && !waiting_.empty() && waiting_.begin()->first == next_)
    receive(std::move(waiting_.extract(waiting_.begin()).mapped()), received);
  if (closed() || next_ < end_) return;
  phase_ = Phase::kClosed;
  waiting_.clear();
  received.push_back({next_, common::Kind::kBye, nullptr});  // in place of the goodbye
}

void Stream::keep(const common::Entry& entry) {
  if (retain_bytes_ == 0) return;
  kept_.push_back(entry);
  kept_bytes_ += cost(entry);
  while (kept_bytes_ > retain_bytes_) forget();
}

void Stream::settle(std::uint64_t settled) {
  while (!kept_.empty() && kept_.front().number < settled) forget();
}

void Stream::forget() {
  kept_bytes_ -= cost(kept_.front());
  kept_.pop_front();
}

}  // namespace ttf::bus::dds::exchange
