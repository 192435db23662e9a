#include "cli/supervision/signal_watch.h"

#include <sys/signalfd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "core/errors.h"

namespace ttf::cli::supervision {

SignalWatch::SignalWatch() {
  sigemptyset(&watched_);
  sigaddset(&watched_, SIGINT);
  sigaddset(&watched_, SIGTERM);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaddset(&watched_, SIGHUP);
  fd_ = Descriptor(signalfd(-1, &watched_, SFD_NONBLOCK | SFD_CLOEXEC));
  if (!fd_.open()) throw std::runtime_error(std::string("cannot open a signalfd: ") + system_message(errno));
  pthread_sigmask(SIG_BLOCK, &watched_, &before_);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &pipe_before_);
}

SignalWatch::~SignalWatch() {
  while (next()) {
  }  // discards signals that came after the end
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  sigaction(SIGPIPE, &pipe_before_, nullptr);
}

std::optional<int> SignalWatch::next() {
  signalfd_siginfo info{};
  return read(fd_.get(), &info, sizeof info) == sizeof info ? std::optional<int>(static_cast<int>(info.ssi_signo))
                                                            : std::nullopt;
}

}  // namespace ttf::cli::supervision
