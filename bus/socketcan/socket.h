// A raw CAN socket on one interface, ready for CAN FD: what every process on SocketCAN speaks through.
//
// What is wrong with the interface ends set-up with one sentence and the command that helps. Afterwards nothing
// throws: what the network does is a value. A frame that the kernel had no room for is counted, one by one; none is
// lost silently.
//
// Stamps are the kernel's when the frame reached the interface, CLOCK_REALTIME. A frame that its sender had queued
// with a transmission time (SO_TXTIME) carries that time instead: such stamps say nothing about its arrival.
#pragma once

#include <linux/can.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::bus::socketcan {

struct SocketOptions {
  std::string interface;
  bool flexible_data_rate = true;  // the interface must carry CAN FD; what it carries arrives in either case
  bool own_frames = false;         // those of this socket arrive here too, once they have left
  bool error_frames = false;       // what the driver says about the bus arrives as frames with CAN_ERR_FLAG
  // What the receive buffer should hold. The kernel's usual one has room for 278 CAN FD frames.
  int receive_buffer_frames = 16'384;
  std::vector<can_filter> filters;  // of which one must match, at most 512; none: everything arrives
};

enum class Status : std::uint8_t {
  kDone,
  kNothing,  // received: nothing is there
  kNoRoom,   // sent: the interface's queue is full, the frame is not sent
  kDown,     // the interface was taken down: frames of others may have gone by unseen, for good
  kGone,     // the interface is no more
  kFailed,   // anything else; failure() has the kernel's words
};

struct Received {
  canfd_frame can{};              // CANFD_FDF is set in its flags if and only if it is a CAN FD frame
  std::int64_t stamp_ns = 0;      // CLOCK_REALTIME; 0 where the kernel gave none
  bool own = false;               // sent by this very socket; stamped when it had left
  std::uint32_t lost_before = 0;  // frames that were lost just before this one, for want of room in the receive buffer
};

class Socket {
 public:
  // Throws InputError where kernel or interface are not as they must be.
  explicit Socket(const SocketOptions& options);
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&&) = delete;

  // Never blocks. CANFD_FDF in the flags says that it goes as a CAN FD frame; a classic one has at most 8 bytes.
  Status send(const canfd_frame& can);
  // Never blocks. What arrived before the interface went down is handed out first.
  Status receive(Received& received);
  // The next thing that is there if it is a frame of this socket's own; else kNothing, and it stays there.
  Status receive_own(Received& received);
  // Sleeps until receive() has something to say, for that long, or until a signal. The kernel may make
  // it up to a thousandth longer; for an instant, or for more than one socket: poll(descriptor()), with a timerfd.
  void wait(Duration longest) const;
  int descriptor() const { return descriptor_; }

  // Frames lost for want of room in the receive buffer since the beginning, those after the last received one included.
  std::uint32_t lost() const;
  // One sentence with the command that helps where the kernel gave a smaller receive buffer than asked for; else empty.
  const std::string& shortage() const { return shortage_; }
  // One sentence about the last status but kDone, kNothing and kNoRoom, with the command that helps where one is known.
  std::string failure() const;
  // Appends it; allocates nothing but what `text` needs.
  void tell_failure(std::string& text) const;

 private:
  Status failed(int error);
  void set_up(const SocketOptions& options);
  void size_receive_buffer(int frames);

  std::string interface_;
  int descriptor_ = -1;
  int index_ = 0;
  std::string shortage_, when_down_, when_gone_;
  std::uint32_t lost_seen_ = 0;   // as told by the frames received
  Status state_ = Status::kDone;  // once it is another it stays
  int error_ = 0;
};

}  // namespace ttf::bus::socketcan
