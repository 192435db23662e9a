#include "bus/socketcan/socket.h"

#include <fmt/format.h>
#include <linux/can/raw.h>
#include <linux/sock_diag.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "bus/socketcan/interface.h"
#include "core/check.h"
#include "core/errors.h"

namespace ttf::bus::socketcan {
namespace {

// Bytes of the receive buffer per queued CAN FD frame, with bookkeeping: 212,992 bytes hold 278 frames.
constexpr int kBytesPerFrame = 768;

std::string words_of(int error) { return std::system_category().message(error); }

template <class Value> bool set_option(int socket, int level, int option, const Value& value) {
  return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

}  // namespace

Socket::Socket(const SocketOptions& options) : interface_(options.interface) {
  TTF_CHECK(options.receive_buffer_frames > 0 && options.receive_buffer_frames <= 1'000'000, "{} frames",
            options.receive_buffer_frames);
  TTF_CHECK(options.filters.size() <= CAN_RAW_FILTER_MAX, "{} filters", options.filters.size());
  when_down_ = fmt::format("{0}: the interface went down during the run: ip link set {0} up", interface_);
  when_gone_ = fmt::format("{}: {}", interface_,
                           Problem{"the interface was removed during the run",
                                   link_problem(interface_, {}, options.flexible_data_rate).commands}
                               .text());
  const InterfaceState state = interface_state(options.interface);
  if (std::string problem = interface_problem(options.interface, state, options.flexible_data_rate); !problem.empty())
    throw InputError(Finding{options.interface, 0, "", "", std::move(problem)});
  descriptor_ = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  try {
    set_up(options);
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

// Options come first: they apply to frames from bind() on.
void Socket::set_up(const SocketOptions& options) {
  const auto refuse = [&](const char* what) {
    throw InputError(Finding{interface_, 0, "", "", fmt::format("{}: {}", what, words_of(errno))});
  };
  if (descriptor_ < 0) refuse("cannot open a CAN socket");
  const int on = 1;
  if (!set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on)) refuse("cannot use CAN FD frames");
  if (options.own_frames && !set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, on))
    refuse("cannot receive its own frames");
  const can_err_mask_t all = CAN_ERR_MASK;
  if (options.error_frames && !set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, all))
    refuse("cannot receive error frames");
  if (!options.filters.empty() && setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, options.filters.data(),
                                             static_cast<socklen_t>(options.filters.size() * sizeof(can_filter))) != 0)
    refuse("cannot set filters");
  if (!set_option(descriptor_, SOL_SOCKET, SO_RXQ_OVFL, on)) refuse("cannot count lost frames");
  if (!set_option(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, on)) refuse("cannot stamp frames");
  size_receive_buffer(options.receive_buffer_frames);
  index_ = static_cast<int>(if_nametoindex(interface_.c_str()));
  if (index_ == 0) refuse("the interface was removed");
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index_;
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    refuse("cannot bind to the interface");
}

// The kernel doubles the size asked for. SO_RCVBUFFORCE exceeds net.core.rmem_max and needs CAP_NET_ADMIN.
void Socket::size_receive_buffer(int frames) {
  const int wanted = frames * kBytesPerFrame, asked = wanted / 2;
  if (set_option(descriptor_, SOL_SOCKET, SO_RCVBUFFORCE, asked)) return;
  set_option(descriptor_, SOL_SOCKET, SO_RCVBUF, asked);
  int granted = 0;
  socklen_t size = sizeof granted;
  getsockopt(descriptor_, SOL_SOCKET, SO_RCVBUF, &granted, &size);
  if (granted < wanted)
    shortage_ = fmt::format("{}: the receive buffer holds {} frames, not {}: sysctl -w net.core.rmem_max={}",
                            interface_, granted / kBytesPerFrame, frames, asked);
}

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

Socket::Socket(Socket&& other) noexcept
    : interface_(std::move(other.interface_)), descriptor_(std::exchange(other.descriptor_, -1)), index_(other.index_),
      shortage_(std::move(other.shortage_)), when_down_(std::move(other.when_down_)),
      when_gone_(std::move(other.when_gone_)), lost_seen_(other.lost_seen_), state_(other.state_),
      error_(other.error_) {}

Status Socket::failed(int error) {
  if (state_ == Status::kDone) {
    state_ = error == ENETDOWN ? Status::kDown : error == ENODEV || error == ENXIO ? Status::kGone : Status::kFailed;
    error_ = error;
  }
  return state_;
}

Status Socket::send(const canfd_frame& can) {
  if (state_ != Status::kDone) return state_;
  const bool flexible = (can.flags & CANFD_FDF) != 0;
  TTF_CHECK(can.len <= (flexible ? CANFD_MAX_DLEN : CAN_MAX_DLEN), "{} bytes", can.len);
  const std::size_t size = flexible ? CANFD_MTU : CAN_MTU;
  for (;;) {
    if (const ssize_t written = write(descriptor_, &can, size); written >= 0) {
      TTF_CHECK(written == static_cast<ssize_t>(size), "{} of {} bytes", written, size);
      return Status::kDone;
    }
    if (errno == EINTR) continue;
    if (errno == ENOBUFS || errno == EAGAIN) return Status::kNoRoom;
    return failed(errno);
  }
}

Status Socket::receive(Received& received) {
  received = {};
  iovec place{.iov_base = &received.can, .iov_len = sizeof received.can};
  alignas(cmsghdr) std::array<std::byte, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> control;
  msghdr message{};
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  ssize_t size = -1;
  do {
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    size = recvmsg(descriptor_, &message, 0);
    if (size >= 0 || errno == EINTR) continue;
    // The kernel reports an error of the interface once, before the frames that still wait.
    if (errno == EAGAIN) return state_ == Status::kDone ? Status::kNothing : state_;
    if (failed(errno) == Status::kFailed) return state_;
  } while (size < 0);
  TTF_CHECK(size == CAN_MTU || size == CANFD_MTU, "{} bytes", size);
  received.own = (message.msg_flags & MSG_CONFIRM) != 0;
  received.can.flags = static_cast<std::uint8_t>(size == CANFD_MTU ? received.can.flags | CANFD_FDF : 0);
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr; head = CMSG_NXTHDR(&message, head)) {
    if (head->cmsg_level != SOL_SOCKET) continue;
    if (head->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(head), sizeof stamp);
      received.stamp_ns = std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec;
    } else if (head->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t lost = 0;
      std::memcpy(&lost, CMSG_DATA(head), sizeof lost);
      received.lost_before = lost - std::exchange(lost_seen_, lost);
    }
  }
  return Status::kDone;
}

Status Socket::receive_own(Received& received) {
  msghdr message{};  // without room: only its flags are read
  ssize_t size = -1;
  do {
    size = recvmsg(descriptor_, &message, MSG_PEEK);
    if (size >= 0 || errno == EINTR) continue;
    if (errno == EAGAIN) return state_ == Status::kDone ? Status::kNothing : state_;
    if (failed(errno) == Status::kFailed) return state_;
  } while (size < 0);
  return (message.msg_flags & MSG_CONFIRM) != 0 ? receive(received) : Status::kNothing;
}

void Socket::wait(Duration longest) const {
  if (state_ != Status::kDone) return;
  pollfd one{.fd = descriptor_, .events = POLLIN, .revents = 0};
  const timespec timeout{.tv_sec = longest.ns / 1'000'000'000, .tv_nsec = longest.ns % 1'000'000'000};
  ppoll(&one, 1, &timeout, nullptr);
}

std::uint32_t Socket::lost() const {
  std::array<std::uint32_t, SK_MEMINFO_VARS> info{};
  socklen_t size = sizeof info;
  if (getsockopt(descriptor_, SOL_SOCKET, SO_MEMINFO, info.data(), &size) != 0) return lost_seen_;
  return info[SK_MEMINFO_DROPS];
}

std::string Socket::failure() const {
  std::string text;
  report_failure(text);
  return text;
}

void Socket::report_failure(std::string& text) const {
  switch (state_) {
    case Status::kDown: text += when_down_; break;
    case Status::kGone: text += when_gone_; break;
    case Status::kFailed: text.append(interface_).append(": ").append(strerrordesc_np(error_)); break;
    case Status::kDone:
    case Status::kNothing:
    case Status::kNoRoom: break;
  }
}

}  // namespace ttf::bus::socketcan
