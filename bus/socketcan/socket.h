// A raw CAN socket on one interface, ready for CAN FD. Every process on SocketCAN sends and receives through one.
//
// A fault of the interface ends set-up with one sentence and the command that helps. Afterwards nothing
// throws; the network's behaviour is a value. Frames that the kernel had no room for are counted one by one;
// no frame is lost silently.
//
// A stamp is the kernel's CLOCK_REALTIME when the frame reached the interface. A frame that its sender queued
// with a transmission time (SO_TXTIME) carries that time instead, which says nothing about its arrival.
#pragma once

#include <linux/can.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::bus::socketcan {

struct SocketOptions {
  std::string interface;
  bool flexible_data_rate = true;  // the interface must carry CAN FD; CAN FD frames arrive in either case
  bool own_frames = false;         // this socket's own frames also arrive here, once they have left
  bool error_frames = false;       // the driver's reports about the bus arrive as frames with CAN_ERR_FLAG
  // Frames that the receive buffer should hold. The kernel's default buffer has room for 278 CAN FD frames.
  int receive_buffer_frames = 16'384;
  std::vector<can_filter> filters;  // one must match, at most 512; without filters everything arrives
};

enum class Status : std::uint8_t {
  kDone,
  kNothing,  // received: no frame is waiting
  kNoRoom,   // sent: the interface's queue is full, and the frame is not sent
  kDown,     // the interface was taken down: frames of others may have been missed for good
  kGone,     // the interface was removed
  kFailed,   // any other error; failure() has the kernel's words
};

struct Received {
  canfd_frame can{};              // CANFD_FDF is set in its flags if and only if it is a CAN FD frame
  std::int64_t stamp_ns = 0;      // CLOCK_REALTIME; 0 if the kernel gave none
  bool own = false;               // sent by this very socket; stamped when it had left
  std::uint32_t lost_before = 0;  // frames lost just before this one, because the receive buffer was full
};

class Socket {
 public:
  // Throws InputError if the kernel or the interface is unsuitable.
  explicit Socket(const SocketOptions& options);
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&&) = delete;

  // Never blocks. CANFD_FDF in the flags sends a CAN FD frame; a classic one has at most 8 bytes.
  Status send(const canfd_frame& can);
  // Never blocks. Frames that arrived before the interface went down come first.
  Status receive(Received& received);
  // Receives the next frame if it is this socket's own; otherwise returns kNothing and leaves it there.
  Status receive_own(Received& received);
  // Sleeps until receive() has a result, for at most `longest`, or until a process signal. The kernel may make
  // it up to a thousandth longer. For an instant, or for several sockets: poll(descriptor()), with a timerfd.
  void wait(Duration longest) const;
  int descriptor() const { return descriptor_; }

  // Returns the frames lost since the beginning because the receive buffer was full, also after the last received one.
  std::uint32_t lost() const;
  // Returns one sentence with the command that helps if the kernel granted a smaller receive buffer; otherwise empty.
  const std::string& shortage() const { return shortage_; }
  // Returns one sentence about the last status except kDone, kNothing and kNoRoom, with the command that helps
  // if known.
  std::string failure() const;
  // Appends that sentence; allocates only memory of `text`.
  void report_failure(std::string& text) const;

 private:
  Status failed(int error);
  void set_up(const SocketOptions& options);
  void size_receive_buffer(int frames);

  std::string interface_;
  int descriptor_ = -1;
  int index_ = 0;
  std::string shortage_, when_down_, when_gone_;
  std::uint32_t lost_seen_ = 0;   // from the frames received so far
  Status state_ = Status::kDone;  // keeps the first failure
  int error_ = 0;
};

}  // namespace ttf::bus::socketcan
