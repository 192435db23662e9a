#include "nodes/runner/vehicle/line.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include "nodes/driving/actuator.h"

namespace ttf::nodes::runner::vehicle {
namespace {

constexpr int kAskAgain_ms = 20;
constexpr int kAtOnce = 64;  // messages; the node has other work to do

}  // namespace

Line::Line(const LinePlan& plan, sim::world::vehicle::Driven& driven)
    : start_(plan.start), socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)), record_(driven) {
  if (socket_ < 0) throw std::system_error(errno, std::system_category(), "cannot open a socket for the vehicle");
  const Address own = address_of(plan.session, plan.self);
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&own.name), own.size) != 0) {
    const int why = errno;
    close(socket_);
    if (why == EADDRINUSE)
      throw std::runtime_error(fmt::format(
          "this process of the session {} runs already on this host: give each drive a --session of its own",
          plan.session));
    throw std::system_error(why, std::system_category(), "cannot name a socket for the vehicle");
  }
  for (const std::size_t other : plan.others) others_.push_back(address_of(plan.session, other));
}

Line::~Line() { close(socket_); }

Line::Address Line::address_of(const std::string& session, std::size_t process) {
  const std::string name = fmt::format("ttfusion/{}/vehicle/{}", session, process);
  Address address;
  if (name.size() >= sizeof address.name.sun_path)
    throw std::runtime_error(fmt::format("the session's name is too long for the vehicle's sockets: {}", session));
  address.name.sun_family = AF_UNIX;
  std::memcpy(address.name.sun_path + 1, name.data(), name.size());  // behind a zero: an abstract name
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

bool Line::catch_up(std::chrono::milliseconds patience) {
  record_.begins_later();
  const auto until = std::chrono::steady_clock::now() + patience;
  while (!record_.whole() && std::chrono::steady_clock::now() < until) {
    send_to_all(record_.ask());
    pollfd one{socket_, POLLIN, 0};
    (void)poll(&one, 1, kAskAgain_ms);
    take_in();
  }
  return record_.whole();
}

void Line::report(const host::Actuation& actuation) {
  send_to_all(record_.report({TrueTime{} + (actuation.from - start_), actuation.acceleration, actuation.steering}));
}

void Line::take_in() {
  Address sender;
  for (int taken = 0; taken < kAtOnce; ++taken) {
    sender.size = sizeof sender.name;
    const ssize_t size =
        recvfrom(socket_, in_.data(), in_.size(), 0, reinterpret_cast<sockaddr*>(&sender.name), &sender.size);
    if (size < 0) return;
    const Record::Reaction reaction =
        record_.take(std::span<const std::byte>(in_).first(static_cast<std::size_t>(size)));
    if (!reaction.answer.empty()) send(reaction.answer, sender);
    if (reaction.asks) send_to_all(record_.ask());
  }
}

// A process that is not there, or does not take its messages in, is no failure of this one.
void Line::send(std::span<const std::byte> message, const Address& to) const {
  (void)sendto(socket_, message.data(), message.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to.name),
               to.size);
}

void Line::send_to_all(std::span<const std::byte> message) const {
  for (const Address& other : others_) send(message, other);
}

std::vector<std::size_t> processes_of(const schedules::model::Cluster& cluster) {
  std::vector<std::size_t> processes;
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const bool acts = schedules::model::has_step(cluster.nodes[n], driving::Actuator::kName);
    const bool measures = std::ranges::any_of(
        cluster.sensors, [n](const auto& sensor) { return sensor.device == static_cast<NodeId>(n); });
    if (acts || measures) processes.push_back(n);
  }
  return processes;
}

}  // namespace ttf::nodes::runner::vehicle
