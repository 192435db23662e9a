// Sessions for tests: each is different, even when several test programs run in parallel.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <string>

#include "bus/dds/common/session.h"

namespace ttf::bus::dds::common {

// Differs from the usual default domain.
inline constexpr std::uint32_t kTestDomain = 17;

inline Session session(std::size_t members) {
  static int made = 0;
  Session session;
  session.domain = kTestDomain;
  session.name = "test-" + std::to_string(getpid()) + "-" + std::to_string(made++);
  for (std::size_t i = 0; i < members; ++i) session.members.push_back(NodeId{static_cast<std::uint8_t>(i)});
  return session;
}

}  // namespace ttf::bus::dds::common
