// The built-in set-up of Cyclone DDS serves processes of one machine, over its loopback interface. Other
// machines do not see it. The same text is in bus/dds/loopback.xml, with the changes for several machines.
// CYCLONEDDS_URI replaces it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace ttf::bus::dds::common {

// Participants of one domain on one machine. More would reach into the next domain's UDP ports: 7400 + 250
// domain + 10 + 2 index and the one after (DDSI-RTPS 2.3, 9.6.1).
inline constexpr int kMaxParticipants = 120;
inline constexpr std::uint32_t kMaxDomain = 231;  // the last whose ports are all below 65536

// A writer with that much unacknowledged waits. Survivors of a dead reader wait only if they send more than
// this before its lease ends.
inline constexpr std::int64_t kMaxUnacknowledgedBytes = 8 << 20;

// The socket receive buffer asked of the kernel: about a second of two full channels. The kernel silently
// grants no more than net.core.rmem_max.
inline constexpr std::int64_t kReceiveBufferBytes = 4 << 20;

// `lease`: a participant that is silent for that long counts as gone.
std::string loopback_configuration(std::chrono::milliseconds lease);

}  // namespace ttf::bus::dds::common
