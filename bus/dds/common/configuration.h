// How Cyclone DDS is set up where nobody says otherwise: for processes of one machine, over its loopback interface,
// seen and heard by no other machine. The same text, with what to change for several machines, is in
// bus/dds/loopback.xml; whoever sets CYCLONEDDS_URI gets what that says instead.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace ttf::bus::dds::common {

// Participants of one domain on one machine: more would reach into the next domain's UDP ports, which are
// 7400 + 250 domain + 10 + 2 index and the one after (DDSI-RTPS 2.3, 9.6.1).
inline constexpr int kMaxParticipants = 120;
inline constexpr std::uint32_t kMaxDomain = 231;  // the last whose ports are all below 65536

// A writer that has so much unacknowledged waits. Survivors of a dead reader reach it only if they say more than
// this before its lease runs out.
inline constexpr std::int64_t kMaxUnacknowledgedBytes = 8 << 20;

// What is asked of the kernel for what has arrived and nobody has taken yet: about a second of two full channels. It
// grants no more than net.core.rmem_max, without a word.
inline constexpr std::int64_t kReceiveBufferBytes = 4 << 20;

// `lease`: a participant from which nothing has come for so long is taken to be gone.
std::string loopback_configuration(std::chrono::milliseconds lease);

}  // namespace ttf::bus::dds::common
