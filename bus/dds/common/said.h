// One sample of an exchange, as the rest of the room sees it: who says it, which of his it is, and what it is about.
//
// There are two topics. On `data` members say their messages, and that they leave. On `control` members and the
// supervisor settle who is there and who is gone. On both, each sender numbers its samples from 0, without a gap,
// so that what is missing is seen; what a reader hears twice, because DDS lost and found a writer again, is known
// by its number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/ids.h"

namespace ttf::bus::dds::common {

enum class Kind : std::uint8_t {
  kHello,     // the first sample of everybody on either topic
  kReady,     // control: I hear the hello of everybody
  kMessage,   // data: `bytes`
  kBye,       // the last sample on either topic
  kFence,     // control, supervisor: `about` is dead; nothing further of it is heard until kClose of this `round`
  kReport,    // control, member, on kFence: I have heard the samples of `about` before number `end`
  kClose,     // control, supervisor: `about` ends before number `end`; `holder`, if any, repeats it from `first` on
  kAgain,     // control, holder: sample `first` of `about`, whose kind is `inner`
  kAllAgain,  // control, holder: all of `about` has been said again in this `round`
  kClosed,    // control, member: I have heard all of `about` that `round` promised
  kHeard,     // control, member, now and then: how much I have heard of each (bus/dds/exchange/heard.h)
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

// The supervisor is nobody's node.
inline constexpr NodeId kSupervisor = kNoNode;

// A sample's bytes, kept for as long as anybody needs them: to be heard, and to be said again.
using Bytes = std::shared_ptr<const std::vector<std::byte>>;

struct Entry {
  std::uint64_t number = 0;
  Kind kind{};
  Bytes bytes;
};

}  // namespace ttf::bus::dds::common
