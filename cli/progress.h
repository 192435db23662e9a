// How much of long work is done, how fast it goes, and how long the rest will take; on a terminal only.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

namespace ttf::cli {

class Progress {
 public:
  // "runs", "faults": of what.
  explicit Progress(std::string of) : of_(std::move(of)), shown_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) fmt::print(stderr, "\r{:78}\r", "");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `now`: of `done`, those done since this began. Where they are all, it is the same.
  void operator()(std::uint64_t done, std::uint64_t all, std::uint64_t now) const {
    if (!shown_ || now == 0 || all < done) return;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began_;
    const double rate = static_cast<double>(now) / passed.count();
    fmt::print(stderr, "\r{} of {} {}, {:.1f}/s, {:.0f} s to go {:8}", done, all, of_, rate,
               static_cast<double>(all - done) / rate, "");
    std::fflush(stderr);
  }

 private:
  std::string of_;
  bool shown_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace ttf::cli
