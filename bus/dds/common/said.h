// One sample of an exchange, as the rest of the room sees it: its sender, its number and its subject.
//
// There are two topics. On `data` members send their messages and their goodbyes. On `control` members and the
// exchange supervisor agree on joins and ends. Each sender numbers its samples on each topic from 0 without a gap,
// so that a missing sample shows. When DDS lost and found a writer again, a repeated sample shows by its number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ttf::bus::dds::common {

enum class Kind : std::uint8_t {
  kHello,     // the first sample of every sender on either topic
  kReady,     // control: the sender receives the hello of all others
  kMessage,   // data: `bytes`
  kBye,       // the last sample on either topic
  kFence,     // control, supervisor: `about` is dead; it is not received until kClose of this `round`
  kReport,    // control, member, on kFence: the sender has received the samples of `about` before number `end`
  kClose,     // control, supervisor: `about` ends before number `end`; `holder`, if any, repeats it from `first` on
  kAgain,     // control, holder: sample `first` of `about`, whose kind is `inner`
  kAllAgain,  // control, holder: all of `about` has been repeated in this `round`
  kClosed,    // control, member: the sender has received all of `about` up to the end of this `round`
  kReceived,  // control, member, now and then: its counts of samples received (bus/dds/exchange/received_counts.h)
};
inline constexpr std::uint8_t kKinds = 11;

struct Said {
  NodeId sender{};
  Kind kind{};
  NodeId about = kNoNode;
  NodeId holder = kNoNode;
  Kind inner{};
  std::uint32_t round = 0;
  std::uint64_t number = 0;
  std::uint64_t first = 0;
  std::uint64_t end = 0;
  std::span<const std::byte> bytes = {};
};

inline constexpr const char* kDataTopic = "ttf_exchange";
inline constexpr const char* kControlTopic = "ttf_exchange_control";

// The supervisor is no node.
inline constexpr NodeId kSupervisor = kNoNode;

// A sample's bytes, kept until they are received and need not be repeated.
using Bytes = std::shared_ptr<const std::vector<std::byte>>;

struct Entry {
  std::uint64_t number = 0;
  Kind kind{};
  Bytes bytes;
};

}  // namespace ttf::bus::dds::common
