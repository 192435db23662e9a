// The host whose clock the test turns keeps a clock's laws, and runs events in their due order.
#include "tests/nodes/runner/turned_host.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>
#include <vector>

#include "tests/nodes/runner/machine_clock_laws.h"

namespace ttf::nodes::runner {
namespace {

struct TurnedBench {
  MachineClock& clock() { return own; }
  TurnedHost host;
  TurnedHost::Process& own = host.process();
};
INSTANTIATE_TYPED_TEST_SUITE_P(Turned, MachineClockLaws, TurnedBench);

using Done = std::vector<std::pair<char, std::int64_t>>;  // process, when

// a wakes up at 10, 20, ...; b at 15, 30, ..., 2 late; an event happens at 20, before a wakes up.
TEST(TurnedHost, DoesWhatIsDueInItsOrder) {
  TurnedHost host({0});
  TurnedHost::Process &a = host.process(), &b = host.process(late_by({2'000}));
  Done done;
  const auto every = [&](TurnedHost::Process& process, char name, std::int64_t period) {
    for (int i = 1; i <= 3; ++i) {
      process.wait_until({i * period});
      done.emplace_back(name, host.now().ns);
    }
  };
  host.at({20'000}, [&] { done.emplace_back('!', host.now().ns); });
  host.run({[&] { every(a, 'a', 10'000); }, [&] { every(b, 'b', 15'000); }});
  EXPECT_EQ(
      done,
      (Done{{'a', 10'000}, {'b', 17'000}, {'!', 20'000}, {'a', 20'000}, {'a', 30'000}, {'b', 32'000}, {'b', 47'000}}));
}

// A write wakes the other up with its kernel's lateness, while the first goes on.
TEST(TurnedHost, WakesUpWhoWatches) {
  const int event = eventfd(0, EFD_CLOEXEC);
  TurnedHost host({0});
  TurnedHost::Process &writer = host.process(), &reader = host.process(late_by({3'000}));
  Done done;
  host.run({[&] {
              writer.wait_until({50'000});
              eventfd_write(event, 1);
              done.emplace_back('w', host.now().ns);
              writer.wait_until({51'000});
              done.emplace_back('w', host.now().ns);
            },
            [&] {
              reader.watch(event);
              reader.wait_until({900'000});
              done.emplace_back('r', host.now().ns);
            }});
  EXPECT_EQ(done, (Done{{'w', 50'000}, {'w', 51'000}, {'r', 53'000}}));
  close(event);
}

TEST(TurnedHost, AStoppedHostWakesUpWhenItGoesOn) {
  TurnedHost host({0});
  TurnedHost::Process& process = host.process(stopped({100'000}, {200'000}));
  std::vector<std::int64_t> woken;
  for (const std::int64_t until : {99'000, 100'000, 150'000, 300'000}) {
    process.wait_until({until});
    woken.push_back(host.now().ns);
  }
  EXPECT_THAT(woken, testing::ElementsAre(99'000, 200'000, 200'000 + TurnedHost::kShortest.ns, 300'000));
}

}  // namespace
}  // namespace ttf::nodes::runner
