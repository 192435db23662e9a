#include "bus/can/line.h"

#include <algorithm>
#include <numeric>

#include "core/check.h"
#include "core/int128.h"

namespace ttf::bus::can {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kEnduredBits = 8;
constexpr std::int64_t kRecessiveBits = 11;  // the end of a frame and its intermission

}  // namespace

Line::Line(const schedules::model::CanBus& bus, std::size_t controllers) : brought_(controllers) {
  TTF_CHECK(bus.nominal_bit_rate > 0 && bus.data_bit_rate > 0, "{} has no bit rate", bus.name);
  const std::int64_t common = std::gcd(bus.nominal_bit_rate, bus.data_bit_rate);
  nominal_ = bus.data_bit_rate / common;
  data_ = bus.nominal_bit_rate / common;
  units_per_second_ = bus.nominal_bit_rate * nominal_;
  for (std::size_t c = 0; c < controllers; ++c) members_.push_back({Protocol(bus.flexible_data_rate)});
}

TrueTime Line::time_of(std::int64_t units) const {
  const Int128 ns = (Int128{units} * kSecond_ns + units_per_second_ - 1) / units_per_second_;
  return origin_ + Duration{static_cast<std::int64_t>(ns)};
}

std::int64_t Line::units_at(TrueTime now) const {
  if (now == time_of(at_)) return at_;
  return std::max(at_, static_cast<std::int64_t>(Int128{(now - origin_).ns} * units_per_second_ / kSecond_ns));
}

std::int64_t Line::first_end() const {
  std::int64_t first = kNoBit;
  for (const Member& member : members_) first = std::min(first, member.bit_ends);
  return first;
}

TrueTime Line::next() const {
  const std::int64_t first = first_end();
  return first == kNoBit ? kNever<TrueTime> : time_of(first);
}

// Counts units from `now` on.
void Line::begin_at(TrueTime now) {
  const std::int64_t passed = units_at(now);
  for (Member& member : members_)
    if (member.bit_ends != kNoBit) member.bit_ends = std::max<std::int64_t>(0, member.bit_ends - passed);
  origin_ = now;
  at_ = 0;
}

void Line::power_on(std::size_t member, bool integrated, TrueTime now) {
  members_[member].protocol.power_on(integrated);
  members_[member].bit_ends = units_at(now) + nominal_;
}

// A member that goes off no longer drives the line.
void Line::release_line() {
  recessive_ =
      std::all_of(members_.begin(), members_.end(), [](const Member& member) { return member.protocol.drives(); });
}

void Line::power_off(std::size_t member) {
  members_[member].protocol.power_off();
  members_[member].bit_ends = kNoBit;
  release_line();
}

void Line::hold_off(std::size_t member) {
  members_[member].protocol.hold_off();
  members_[member].bit_ends = kNoBit;
  release_line();
}

void Line::release(std::size_t member, TrueTime now) {
  members_[member].protocol.release();
  members_[member].bit_ends = units_at(now) + nominal_;
}

void Line::start(std::size_t member, const FrameBits& frame, TrueTime now) {
  begin_at(now);
  members_[member].protocol.start(frame);
  members_[member].bit_ends = nominal_;
  recessive_ = false;
  for (Member& other : members_)
    if (other.protocol.waits()) other.bit_ends = nominal_;
}

void Line::align(TrueTime now) {
  begin_at(now);
  for (Member& member : members_)
    if (member.bit_ends != kNoBit) member.bit_ends = nominal_;
}

const std::vector<Protocol::Brought>& Line::step(const Disturbed& disturbed) {
  at_ = first_end();
  TTF_CHECK(at_ != kNoBit, "a line without a controller");
  bool inverted = false;
  if (disturbed.bit)
    for (const Member& member : members_)
      inverted |= member.protocol.transmits() && member.protocol.bit() == *disturbed.bit;
  const bool level = recessive_ && !disturbed.dominant;
  bool recessive = true;
  for (std::size_t m = 0; m < members_.size(); ++m) {
    Member& member = members_[m];
    brought_[m] = {};
    if (member.bit_ends == at_) {
      const bool wrong = inverted && (disturbed.by == nullptr || (*disturbed.by)[m]);
      brought_[m] = member.protocol.end_of_bit(level != wrong);
      member.bit_ends += length_of_bit(member.protocol);
    }
    recessive &= member.protocol.drives();
  }
  if (recessive_ && !recessive)
    for (Member& member : members_)
      if (member.protocol.waits()) member.bit_ends = at_ + nominal_;
  recessive_ = recessive;
  return brought_;
}

void Line::pass_by(TrueTime end) {
  const std::int64_t over = units_at(end);
  for (Member& member : members_) {
    member.protocol.pass_by();
    if (member.protocol.phase() == Protocol::Phase::kIdle)
      member.bit_ends = over + nominal_;
    else if (member.protocol.phase() == Protocol::Phase::kBusOff)
      member.bit_ends = std::max(at_, over - kRecessiveBits * nominal_) + nominal_;
  }
}

bool Line::endures_dominance() const {
  return std::all_of(members_.begin(), members_.end(),
                     [](const Member& member) { return member.protocol.endures_dominance(); });
}

void Line::endure(TrueTime until) {
  const std::int64_t room = units_at(until) - first_end();
  const std::int64_t period = kEnduredBits * nominal_;
  if (room < 2 * period) return;
  const std::int64_t passes = (room / period - 1) * period;
  for (Member& member : members_)
    if (member.bit_ends != kNoBit) member.bit_ends += passes;
}

}  // namespace ttf::bus::can
