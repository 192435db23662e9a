// The real-time medium over DDS under the load of a big cluster. Five processes each send 840 frames a second
// on either channel, at their own instants, and receive those of the four others. The benchmark counts losses
// and costs. It measures a frame's way from its sender's stamp to its receiver's thread, and the duration of
// send(); also while a sixth process, which receives everything, is stopped. One iteration is a second of it.
//
//   ttf_bench_live --benchmark_counters_tabular=true
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bus/dds/live/medium.h"
#include "bus/wire/flexray_frame.h"
#include "core/check.h"
#include "tests/support/child_process.h"

namespace ttf::bench {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kSenders = 5;
constexpr std::int64_t kFramesPerSecond = 4200;  // on each channel, of all together
constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kPeriod = kSecond * kSenders / kFramesPerSecond;
constexpr std::uint32_t kLiveDomain = 19;  // used by no other test
constexpr std::size_t kPayload = 32;

struct Totals {
  std::uint64_t sent = 0, received = 0, lost = 0;
  std::int64_t cpu_us = 0;
};

struct Job {
  bus::dds::common::Session session;
  NodeId self{};
  bus::dds::live::Delivery delivery{};
  std::int64_t seconds = 0;
};

Job job_of(char** words) {
  Job job;
  job.session.domain = kLiveDomain;
  job.session.name = words[2];
  job.self = NodeId{static_cast<std::uint8_t>(std::stoul(words[3]))};
  for (std::size_t i = 0; i < std::stoul(words[4]); ++i)
    job.session.members.push_back(NodeId{static_cast<std::uint8_t>(i)});
  job.delivery =
      std::string(words[5]) == "reliable" ? bus::dds::live::Delivery::kReliable : bus::dds::live::Delivery::kBestEffort;
  job.seconds = std::stol(words[6]);
  return job;
}

std::int64_t cpu_us() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return (used.ru_utime.tv_sec + used.ru_stime.tv_sec) * 1'000'000 + used.ru_utime.tv_usec + used.ru_stime.tv_usec;
}

void put(const void* bytes, std::size_t size) { TTF_CHECK(std::fwrite(bytes, 1, size, stdout) == size); }
void put(const std::vector<std::int64_t>& values) {
  const std::uint64_t count = values.size();
  put(&count, sizeof count);
  put(values.data(), count * sizeof values[0]);
}

// Reads values in the order of put(); returns false when too few are left.
class Reported {
 public:
  explicit Reported(std::string bytes) : bytes_(std::move(bytes)) {}
  bool get(void* into, std::size_t size) {
    if (bytes_.size() - at_ < size) return false;
    std::memcpy(into, bytes_.data() + at_, size);
    at_ += size;
    return true;
  }
  // Appends to the contents of `values`.
  bool get(std::vector<std::int64_t>& values) {
    std::uint64_t count = 0;
    if (!get(&count, sizeof count)) return false;
    const std::size_t before = values.size();
    values.resize(before + count);
    return get(values.data() + before, count * sizeof values[0]);
  }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class Member {
 public:
  explicit Member(const Job& job) : medium_(job.session, job.self, plans(job), job.delivery), job_(job) {
    medium_.wait_ready(30s);
    ways_.reserve(static_cast<std::size_t>(2 * kFramesPerSecond * (job.seconds + 1)));
    sends_.reserve(ways_.capacity());
    for (const bus::ports::Line line : {0, 1}) medium_.watch(line, true);
  }
  // From `begin` on; receives for a while longer.
  void work(bus::ports::MachineTime begin) {
    const std::int64_t cpu_before = cpu_us();
    const bool sends = index_of(job_.self) < kSenders;
    bus::ports::MachineTime next =
        begin + Duration::nanoseconds(kPeriod * static_cast<std::int64_t>(index_of(job_.self)) / 5);
    const bus::ports::MachineTime end = begin + Duration::nanoseconds(job_.seconds * kSecond);
    const bus::ports::MachineTime silence = end + Duration::milliseconds(500);
    for (bus::ports::MachineTime now = bus::ports::host_now(); now < silence; now = bus::ports::host_now()) {
      while (const auto received = medium_.receive()) ways_.push_back((bus::ports::host_now() - received->at).ns);
      const bool more = sends && next < end;
      if (more && now >= next) {
        send(next);
        next += Duration::nanoseconds(kPeriod / 2);  // A and B in turn
        continue;
      }
      sleep((more ? next : silence) - now);
    }
    const bus::ports::LiveCounts counts = medium_.counts();
    const Totals totals{counts.sent, counts.received, counts.lost, cpu_us() - cpu_before};
    put(&totals, sizeof totals);
    put(ways_);
    put(sends_);
  }

 private:
  static std::vector<bus::dds::live::LiveLinePlan> plans(const Job& job) {
    return {{0, bus::dds::live::live_topic(schedules::model::Channel::kA), job.session.members},
            {1, bus::dds::live::live_topic(schedules::model::Channel::kB), job.session.members}};
  }
  void send(bus::ports::MachineTime due) {
    channel_ =
        channel_ == schedules::model::Channel::kA ? schedules::model::Channel::kB : schedules::model::Channel::kA;
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(1 + index_of(job_.self));
    std::array<std::byte, bus::wire::kMaxFrameBytes> frame;
    const std::size_t size = bus::wire::encode_frame(header, channel_, std::array<std::byte, kPayload>{}, frame);
    bus::ports::LiveSignal signal;
    signal.channel = channel_;
    signal.slot = header.frame_id;
    signal.bytes = std::span(frame).first(size);
    const bus::ports::MachineTime before = bus::ports::host_now();
    TTF_CHECK(medium_.send(signal, due) == bus::ports::LiveStatus::kDone);
    sends_.push_back((bus::ports::host_now() - before).ns);
  }
  void sleep(Duration patience) {
    std::array<pollfd, 2> lines{{{medium_.descriptor(0), POLLIN, 0}, {medium_.descriptor(1), POLLIN, 0}}};
    const timespec timeout{patience.ns / kSecond, patience.ns % kSecond};
    ppoll(lines.data(), lines.size(), &timeout, nullptr);
  }

  bus::dds::live::DdsMedium medium_;
  Job job_;
  schedules::model::Channel channel_ = schedules::model::Channel::kB;
  std::vector<std::int64_t> ways_, sends_;  // ns
};

// Starts at the instant, in nanoseconds, that it reads once it is ready.
int be_member(char** words) {
  Member member(job_of(words));
  fmt::print("ready\n");
  std::fflush(stdout);
  bus::ports::MachineTime begin;
  if (std::scanf("%" SCNd64, &begin.ns) != 1) return 1;
  member.work(begin);
  return 0;
}

std::vector<std::string> words_of(const std::string& session, std::size_t self, std::size_t members, bool reliable,
                                  std::int64_t seconds) {
  return {"/proc/self/exe",
          "--member",
          session,
          std::to_string(self),
          std::to_string(members),
          reliable ? "reliable" : "best-effort",
          std::to_string(seconds)};
}

double share_us(std::vector<std::int64_t>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at) / 1000;
}

void DdsLivePaced(benchmark::State& state) {
  static int made = 0;
  const bool reliable = state.range(0) != 0, with_stopped = state.range(1) != 0;
  const std::size_t members = kSenders + (with_stopped ? 1 : 0);
  const auto seconds = static_cast<std::int64_t>(state.max_iterations);
  const std::string session = "live-" + std::to_string(getpid()) + "-" + std::to_string(made++);
  std::deque<test::ChildProcess> children;
  for (std::size_t i = 0; i < members; ++i) children.emplace_back(words_of(session, i, members, reliable, seconds));
  for (test::ChildProcess& child : children) child.await_ready();
  if (with_stopped) children.back().signal(SIGSTOP);
  const bus::ports::MachineTime begin = bus::ports::host_now() + Duration::milliseconds(200);
  for (const test::ChildProcess& child : children) child.report(std::to_string(begin.ns));
  Totals all;
  std::vector<std::int64_t> ways, sends;
  for (auto _ : state) std::this_thread::sleep_for(1s);
  bool well = true;
  for (std::size_t i = 0; i < kSenders; ++i) {
    Totals one;
    well = children[i].wait() == 0 && well;
    Reported reported(children[i].said_after_ready());
    well = well && reported.get(&one, sizeof one) && reported.get(ways) && reported.get(sends);
    all = {all.sent + one.sent, all.received + one.received, all.lost + one.lost, all.cpu_us + one.cpu_us};
  }
  if (!well) return state.SkipWithError("a member has failed");
  state.counters["sent"] = static_cast<double>(all.sent);
  state.counters["missing"] = static_cast<double>(all.sent * (kSenders - 1)) - static_cast<double>(all.received);
  state.counters["lost"] = static_cast<double>(all.lost);
  state.counters["cores"] = static_cast<double>(all.cpu_us) / 1e6 / static_cast<double>(seconds);
  state.counters["way_p50_us"] = share_us(ways, 0.5);
  state.counters["way_p99_us"] = share_us(ways, 0.99);
  state.counters["way_max_us"] = share_us(ways, 1);
  state.counters["send_p50_us"] = share_us(sends, 0.5);
  state.counters["send_p99_us"] = share_us(sends, 0.99);
  state.counters["send_max_us"] = share_us(sends, 1);
}
BENCHMARK(DdsLivePaced)
    ->ArgNames({"reliable", "one_stopped"})
    ->ArgsProduct({{0, 1}, {0, 1}})
    ->Iterations(20)
    ->UseRealTime()
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace ttf::bench

int main(int count, char** words) {
  if (count == 7 && std::string(words[1]) == "--member") {
    try {
      return ttf::bench::be_member(words);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}\n", error.what());
      return 1;
    }
  }
  benchmark::Initialize(&count, words);
  if (benchmark::ReportUnrecognizedArguments(count, words)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
