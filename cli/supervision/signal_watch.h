// Signals as something to poll: while it lives, SIGINT, SIGTERM and SIGHUP are blocked and readable from a descriptor,
// and a write to whom nobody reads is an error, not a signal. Make it before other threads begin, so that they inherit
// the mask: a signal goes to any thread that takes it. One may live within another's life. SIGHUP stays ignored where
// it is (nohup).
#pragma once

#include <signal.h>

#include <optional>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

class SignalWatch {
 public:
  // Throws std::runtime_error where the system does not give the descriptor.
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  int fd() const { return fd_.get(); }
  // The next one that came; nothing: none there now.
  std::optional<int> next();

 private:
  sigset_t watched_{}, before_{};
  struct sigaction pipe_before_ {};
  Descriptor fd_;
};

}  // namespace ttf::cli::supervision
