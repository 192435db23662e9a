// Process signals for polling: during its life, SIGINT, SIGTERM and SIGHUP are blocked and readable from a
// descriptor. A write without a reader fails instead of raising SIGPIPE. Make it before other threads begin,
// so that they inherit the mask: a signal goes to any thread that takes it. Objects may nest. An ignored
// SIGHUP stays ignored (nohup).
#pragma once

#include <signal.h>

#include <optional>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

class SignalWatch {
 public:
  // Throws std::runtime_error if the system refuses the descriptor.
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  int fd() const { return fd_.get(); }
  // Returns the next pending signal; no value without one.
  std::optional<int> next();

 private:
  sigset_t watched_{}, before_{};
  struct sigaction pipe_before_ {};
  Descriptor fd_;
};

}  // namespace ttf::cli::supervision
