// Clusters start through the guardians.
#include <gtest/gtest.h>

#include "tests/sim/guarded.h"

namespace ttf::sim {
namespace {

using bus::GuardianReason;
using bus::PocKind;
using bus::PocReason;

constexpr Duration kAssumedPrecision{(34 + 20 * 2) * 25 + 2 * 2500};

TEST(GuardianStartup, Explore) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Guarded started(star_cluster(4, 3, 4), seed, Duration::milliseconds(9));
    started.run_cycles(40);
    printf("seed %d: ", int(seed));
    for (std::size_t n = 0; n < 4; ++n) printf(" %d(%d)", int(started.kind(n)), int(started.logs[n]->states.active_in()));
    for (auto ch : kBothChannels) { auto& c = started.coupler(ch); c.catch_up(started.simulation->now());
      printf(" | %d fwd %d", int(c.state().kind), int(c.forwarded()));
      for (auto r : bus::kAllGuardianReasons) if (r != GuardianReason::kForwarded && c.blocked(r)) printf(" [%s %d]", std::string(to_text(r)).c_str(), int(c.blocked(r))); }
    printf(" problems %d precision %d\n", int(started.problems()), int(started.simulation->precision().ns));
  }
}

}  // namespace
}  // namespace ttf::sim
