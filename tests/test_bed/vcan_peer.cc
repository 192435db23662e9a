// One process on a vcan, for the scripts next to it: receives and sends FlexRay frames on CAN FD.
//
//   vcan_peer listen INTERFACE A|B IDLE_MS [ONTO]
//       Prints every frame and symbol of that channel until IDLE_MS without arrivals, then its counts. With ONTO, a
//       second interface, it repeats every complete frame there. Exit code 1 and one sentence if an interface fails.
//   vcan_peer node INTERFACE A|B SLOT NODES CYCLES START_S
//       Sends a frame in its slot of CYCLES cycles of 5 ms from that second (CLOCK_REALTIME) on. Prints the frames of
//       the other NODES - 1: the kernel's stamp, the instant of reading, slot, cycle and payload.
//   vcan_peer deaf INTERFACE FRAMES MS
//       Has room for that many frames, reads nothing for that long, then prints the numbers of received and lost ones.
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "bus/socketcan/flexray_on_can.h"
#include "bus/socketcan/socket.h"
#include "core/errors.h"

namespace {

using namespace ttf;
using namespace ttf::bus::socketcan;
using schedules::model::Channel;

constexpr std::int64_t kSecond = 1'000'000'000, kCycle = 5'000'000, kSlot = 100'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::int64_t{now.tv_sec} * kSecond + now.tv_nsec;
}

Channel channel_of(std::string_view name) { return name == "B" ? Channel::kB : Channel::kA; }

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte byte : bytes) text += fmt::format("{:02X}", static_cast<unsigned>(byte));
  return text;
}

std::string described(Channel channel, const bus::socketcan::Arrival& arrival) {
  if (const auto& follow_up = arrival.follow_up)
    return fmt::format("slot {} cycle {} left {} ns late", follow_up->slot, follow_up->cycle_counter,
                       follow_up->late.ns);
  if (arrival.signal != bus::ports::Signal::kFrame)
    return fmt::format("{} of {} ns",
                       arrival.signal == bus::ports::Signal::kCas      ? "CAS"
                       : arrival.signal == bus::ports::Signal::kWakeup ? "wake-up"
                                                                       : "noise",
                       arrival.duration.ns);
  const bus::wire::DecodedFrame frame = bus::wire::decode_frame(channel, arrival.frame);
  return fmt::format("slot {} cycle {} {}{}{}", arrival.slot, frame.header.cycle,
                     frame.error == bus::wire::FrameError::kNone ? "" : "broken ",
                     frame.header.null_frame ? "null " : "", hex(frame.payload));
}

int failed(const bus::socketcan::Socket& socket) {
  fmt::print(stderr, "{}\n", socket.failure());
  return 1;
}

bool send_all(bus::socketcan::Socket& socket, std::span<const canfd_frame> frames) {
  for (const canfd_frame& can : frames)
    if (socket.send(can) != bus::socketcan::Status::kDone) return false;
  return true;
}

int listen(const std::string& interface, Channel channel, std::int64_t idle_ms, const std::string& onto) {
  bus::socketcan::Socket socket({.interface = interface, .filters = {}});
  std::vector<bus::socketcan::Socket> out;
  if (!onto.empty()) out.emplace_back(bus::socketcan::SocketOptions{.interface = onto, .filters = {}});
  fmt::print(stderr, "listening\n");
  bus::socketcan::Reassembly reassembly(channel);
  for (;;) {
    bus::socketcan::Received received;
    bus::socketcan::Status status = socket.receive(received);
    if (status == bus::socketcan::Status::kNothing) {
      socket.wait(Duration::milliseconds(idle_ms));
      status = socket.receive(received);
    }
    if (status == bus::socketcan::Status::kNothing) break;
    if (status != bus::socketcan::Status::kDone) return failed(socket);
    const bus::socketcan::Arrival arrival = reassembly.arrive(received.can);
    if (arrival.outcome != bus::socketcan::Outcome::kComplete) continue;
    fmt::print("{}\n", described(channel, arrival));
    if (out.empty()) continue;
    const auto one = [&](const canfd_frame& can) { return out[0].send(can) == bus::socketcan::Status::kDone; };
    const bool done = arrival.follow_up ? one(follow_up_to_can(channel, *arrival.follow_up))
                      : arrival.signal == bus::ports::Signal::kFrame
                          ? send_all(out[0], bus::socketcan::frame_to_can(arrival.slot, arrival.frame).all())
                          : one(bus::socketcan::symbol_to_can(channel, arrival.signal, arrival.duration));
    if (!done) return failed(out[0]);
  }
  fmt::print("complete {} fragments {} foreign {} malformed {} displaced {} abandoned {} lost {}\n",
             reassembly.count(bus::socketcan::Outcome::kComplete), reassembly.count(bus::socketcan::Outcome::kFragment),
             reassembly.count(bus::socketcan::Outcome::kForeign), reassembly.count(bus::socketcan::Outcome::kMalformed),
             reassembly.count(bus::socketcan::Outcome::kDisplaced), reassembly.abandoned(), socket.lost());
  return 0;
}

// Frames of all lengths take their turns, fragments among them.
bool send_frame(bus::socketcan::Socket& socket, Channel channel, int slot, int cycle) {
  const std::size_t words = static_cast<std::size_t>((slot * 17 + cycle * 5) % 128);
  std::vector<std::byte> payload(2 * words, static_cast<std::byte>(slot + cycle));
  bus::wire::FrameHeader header;
  header.frame_id = static_cast<std::uint16_t>(slot);
  header.cycle = static_cast<std::uint8_t>(cycle % 64);
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame{};
  const std::size_t size = bus::wire::encode_frame(header, channel, payload, frame);
  return send_all(socket, bus::socketcan::frame_to_can(slot, std::span(frame).first(size)).all());
}

// Wakes at an instant, to the microsecond; a timeout of poll() comes up to a thousandth of its length late.
class Alarm {
 public:
  Alarm() : descriptor_(timerfd_create(CLOCK_REALTIME, TFD_CLOEXEC)) { prctl(PR_SET_TIMERSLACK, 1UL); }
  ~Alarm() { close(descriptor_); }
  Alarm(const Alarm&) = delete;
  Alarm& operator=(const Alarm&) = delete;

  void set(std::int64_t at) {
    itimerspec when{};
    when.it_value = {.tv_sec = at / kSecond, .tv_nsec = at % kSecond};
    timerfd_settime(descriptor_, TFD_TIMER_ABSTIME, &when, nullptr);
  }
  // Until the instant that was set has come, or something is there to be received.
  void wait(const bus::socketcan::Socket& socket) const {
    pollfd either[] = {{.fd = descriptor_, .events = POLLIN, .revents = 0},
                       {.fd = socket.descriptor(), .events = POLLIN, .revents = 0}};
    poll(either, 2, -1);
  }

 private:
  int descriptor_;
};

// Prints everything sent until that instant.
bool receive_until(bus::socketcan::Socket& socket, Channel channel, bus::socketcan::Reassembly& reassembly,
                   Alarm& alarm, std::int64_t until) {
  alarm.set(until);
  for (;;) {
    bus::socketcan::Received received;
    const bus::socketcan::Status status = socket.receive(received);
    if (status == bus::socketcan::Status::kNothing) {
      if (now_ns() >= until) return true;
      alarm.wait(socket);
      continue;
    }
    if (status != bus::socketcan::Status::kDone) return false;
    const std::int64_t read_at = now_ns();
    const bus::socketcan::Arrival arrival = reassembly.arrive(received.can);
    fmt::print("{} {} {} {}\n", received.stamp_ns, read_at, static_cast<int>(arrival.outcome),
               arrival.outcome == bus::socketcan::Outcome::kComplete ? described(channel, arrival) : "");
  }
}

int node(const std::string& interface, Channel channel, int slot, int nodes, int cycles, std::int64_t start) {
  bus::socketcan::Socket socket({.interface = interface, .filters = {}});
  bus::socketcan::Reassembly reassembly(channel);
  Alarm alarm;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    if (!receive_until(socket, channel, reassembly, alarm, start + cycle * kCycle + slot * kSlot))
      return failed(socket);
    if (!send_frame(socket, channel, slot, cycle)) return failed(socket);
  }
  if (!receive_until(socket, channel, reassembly, alarm, start + cycles * kCycle + kCycle)) return failed(socket);
  const auto expected = static_cast<std::uint64_t>((nodes - 1) * cycles);
  fmt::print("complete {} of {} lost {}\n", reassembly.count(bus::socketcan::Outcome::kComplete), expected,
             socket.lost());
  return reassembly.count(bus::socketcan::Outcome::kComplete) == expected && socket.lost() == 0 ? 0 : 1;
}

int deaf(const std::string& interface, int frames, std::int64_t ms) {
  bus::socketcan::Socket socket({.interface = interface, .receive_buffer_frames = frames, .filters = {}});
  fmt::print(stderr, "listening\n");
  const timespec pause{.tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1'000'000};
  nanosleep(&pause, nullptr);
  int count = 0;
  for (bus::socketcan::Received received; socket.receive(received) == bus::socketcan::Status::kDone;) ++count;
  fmt::print("heard {} lost {}\n", count, socket.lost());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto number = [&](std::size_t i) { return std::atoll(words[i].c_str()); };
  const auto whole = [&](std::size_t i) { return static_cast<int>(number(i)); };
  try {
    if (words.size() >= 4 && words[0] == "listen")
      return listen(words[1], channel_of(words[2]), number(3), words.size() > 4 ? words[4] : "");
    if (words.size() == 7 && words[0] == "node")
      return node(words[1], channel_of(words[2]), whole(3), whole(4), whole(5), number(6) * kSecond);
    if (words.size() == 4 && words[0] == "deaf") return deaf(words[1], whole(2), number(3));
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  fmt::print(stderr, "vcan_peer listen|node|deaf ...: the beginning of vcan_peer.cc says how\n");
  return 2;
}
