#include "nodes/runner/vehicle/record.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ttf::nodes::runner::vehicle {
namespace {

using sim::world::vehicle::Actuation;
using sim::world::vehicle::Inserted;

constexpr std::uint32_t kMagic = 0x31565454;  // "TTV1"

// All processes are of one host, so numbers travel in its own form.
template <typename T> void put(std::byte*& at, T value) {
  std::memcpy(at, &value, sizeof value);
  at += sizeof value;
}
template <typename T> T taken(const std::byte*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}

bool is_sound(const Actuation& one) {
  return one.from.ns > 0 && std::isfinite(one.acceleration) && std::isfinite(one.steering);
}

}  // namespace

std::span<const std::byte> Record::report(const Actuation& actuation) {
  (void)driven_.insert(actuation);
  std::shift_left(newest_.begin(), newest_.end(), 1);
  newest_.back() = actuation;
  ++counts_.reported;
  return written(Kind::kReported, 0, std::span(newest_).last(std::min<std::size_t>(counts_.reported, kRepeated)));
}

std::span<const std::byte> Record::ask() { return written(Kind::kQuestion, complete_to_, {}); }

Record::Reaction Record::take(std::span<const std::byte> message) {
  if (!read(message)) {
    ++counts_.malformed;
    return {};
  }
  const std::span<const Actuation> received(in_.actuations.data(), in_.count);
  switch (in_.kind) {
    case Kind::kReported: return reported(received);
    case Kind::kQuestion: return {counts_.whole ? answer(in_.after) : std::span<const std::byte>{}, false};
    case Kind::kAnswer:
    case Kind::kLastAnswer: {
      add(received);
      if (counts_.whole || in_.after > complete_to_) return {};
      // Several processes answer. One of them is enough to ask for the next page.
      const bool further = !received.empty() && received.back().from.ns > complete_to_;
      if (further) complete_to_ = received.back().from.ns;
      counts_.whole = in_.kind == Kind::kLastAnswer && complete_to_ >= needed_to_;
      return {{}, further && in_.kind == Kind::kAnswer};
    }
  }
  return {};
}

// Nothing is missing if the oldest of the repeated ones is known, or is the first that there was. As long as something
// is missing, each message is an occasion to ask again.
Record::Reaction Record::reported(std::span<const Actuation> received) {
  if (received.empty()) return {};
  const std::span<const Actuation> known = driven_.actuations();
  const bool first_of_all = known.empty() && received.size() < kRepeated;
  if (counts_.whole && !first_of_all && !has(received.front())) {
    counts_.whole = false;
    ++counts_.gaps;
    complete_to_ = known.empty() ? 0 : known.back().from.ns;
    needed_to_ = received.front().from.ns;
  }
  add(received);
  return {{}, !counts_.whole};
}

bool Record::has(const Actuation& actuation) const {
  return std::ranges::binary_search(driven_.actuations(), actuation.from, {}, &Actuation::from);
}

void Record::add(std::span<const Actuation> received) {
  for (const Actuation& one : received) {
    const Inserted how = driven_.insert(one);
    counts_.received += how == Inserted::kNew || how == Inserted::kLate;
    counts_.late += how == Inserted::kLate;
  }
}

std::span<const std::byte> Record::answer(std::int64_t after) {
  const std::span<const Actuation> all = driven_.actuations();
  const auto first = std::ranges::upper_bound(all, TrueTime{after}, {}, &Actuation::from);
  const std::span<const Actuation> rest = all.subspan(static_cast<std::size_t>(first - all.begin()));
  const bool last = rest.size() <= kPage;
  return written(last ? Kind::kLastAnswer : Kind::kAnswer, after, last ? rest : rest.first(kPage));
}

std::span<const std::byte> Record::written(Kind kind, std::int64_t after, std::span<const Actuation> actuations) {
  std::byte* at = out_.data();
  put(at, kMagic);
  put(at, static_cast<std::uint32_t>(kind));
  put(at, after);
  put(at, static_cast<std::uint64_t>(actuations.size()));
  for (const Actuation& one : actuations) {
    put(at, one.from.ns);
    put(at, one.acceleration);
    put(at, one.steering);
  }
  return std::span<const std::byte>(out_).first(static_cast<std::size_t>(at - out_.data()));
}

// Returns whether the bytes are a message, now in in_: of its length, with instants in order and finite values.
bool Record::read(std::span<const std::byte> bytes) {
  if (bytes.size() < kHead || bytes.size() > kLargest) return false;
  const std::byte* at = bytes.data();
  if (taken<std::uint32_t>(at) != kMagic) return false;
  const auto kind = taken<std::uint32_t>(at);
  if (kind < static_cast<std::uint32_t>(Kind::kReported) || kind > static_cast<std::uint32_t>(Kind::kLastAnswer))
    return false;
  in_.kind = static_cast<Kind>(kind);
  in_.after = taken<std::int64_t>(at);
  const auto count = taken<std::uint64_t>(at);
  if (count > kPage || bytes.size() != kHead + count * kEach) return false;
  in_.count = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < in_.count; ++i) {
    Actuation& one = in_.actuations[i];
    one.from = TrueTime{taken<std::int64_t>(at)};
    one.acceleration = taken<double>(at);
    one.steering = taken<double>(at);
    if (!is_sound(one) || (i > 0 && one.from <= in_.actuations[i - 1].from)) return false;
  }
  return true;
}

}  // namespace ttf::nodes::runner::vehicle
