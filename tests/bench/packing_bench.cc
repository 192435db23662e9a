// The cost of packing 4096 signals of 6 nodes into frames of 32 bits: bound, search and check. The aim is 5 s; a first
// fit alone takes milliseconds. `Published` is the instance of docs/schedules/packing.md, where it is there; `Like` are drawn
// ones like it. With variants, four of a vehicle share the schedule.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>

#include "cli/schedule/packing/signal_file.h"
#include "schedules/packing/check.h"
#include "schedules/packing/packer.h"
#include "schedules/packing/variants/check.h"
#include "schedules/packing/variants/packer.h"
#include "tests/schedules/packing/like_variants.h"
#include "tests/support/recordings.h"

namespace ttf::schedules::packing {
namespace {

void pack_and_check(benchmark::State& state, const Instance& instance) {
  Solution solution;
  for (auto _ : state) {
    solution = pack(instance);
    const auto numbers = slot_numbers({}, solution.bins, 1, ChannelUse::kOne);
    if (!violations(instance, assigned(solution.places, numbers)).empty()) state.SkipWithError("breaks a rule");
  }
  state.counters["slots"] = solution.bins;
  state.counters["least"] = solution.bound();
}

void Like(benchmark::State& state) {
  Instance instance = like_instance(4096, 1, static_cast<int>(state.range(0)));
  instance.shared_slots = state.range(1) != 0;
  pack_and_check(state, instance);
}
BENCHMARK(Like)->ArgsProduct({{12, 60}, {0, 1}})->ArgNames({"windowed", "shared"})->Unit(benchmark::kMillisecond);

// One schedule of four variants: half of the signals are in all of them, the others in a drawn set.
void pack_and_check_variants(benchmark::State& state, Instance instance, bool shared) {
  instance = like_variants(std::move(instance), 4, 1);
  instance.shared_slots = shared;
  Solution solution;
  for (auto _ : state) {
    solution = variants::pack_variants(instance);
    const auto numbers = slot_numbers({}, solution.bins, 1, ChannelUse::kOne);
    if (!variants::variant_violations(instance, assigned(solution.places, numbers)).empty())
      state.SkipWithError("breaks a rule");
  }
  state.counters["slots"] = solution.bins;
  state.counters["least"] = solution.bound();
}

void LikeVariants(benchmark::State& state) {
  pack_and_check_variants(state, like_instance(4096, 1), state.range(0) != 0);
}
BENCHMARK(LikeVariants)->Arg(0)->Arg(1)->ArgName("shared")->Unit(benchmark::kMillisecond);

void PublishedVariants(benchmark::State& state) {
  const std::string path = support::recording_path("flexray_signals/signals_4096.csv");
  if (!std::filesystem::exists(path)) {
    state.SkipWithError("there is no published instance");
    return;
  }
  pack_and_check_variants(state, cli::schedule::packing::read_signals(path, {}).instance, state.range(0) != 0);
}
BENCHMARK(PublishedVariants)->Arg(0)->Arg(1)->ArgName("shared")->Unit(benchmark::kMillisecond);

void Published(benchmark::State& state) {
  const std::string path = support::recording_path("flexray_signals/signals_4096.csv");
  if (!std::filesystem::exists(path)) {
    state.SkipWithError("there is no published instance");
    return;
  }
  Instance instance = cli::schedule::packing::read_signals(path, {}).instance;
  instance.shared_slots = state.range(0) != 0;
  pack_and_check(state, instance);
}
BENCHMARK(Published)->Arg(0)->Arg(1)->ArgName("shared")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ttf::schedules::packing

BENCHMARK_MAIN();
