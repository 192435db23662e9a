// Shows the progress, the rate and the remaining time of long work; on a terminal only. The first second shows nothing.
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
  // `of` names the units: "runs", "faults".
  explicit Progress(std::string of) : of_(std::move(of)), shown_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (drawn_) fmt::print(stderr, "\r{:78}\r", "");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `now` counts the part of `done` since the begin of this object; without earlier work both are equal.
  void operator()(std::uint64_t done, std::uint64_t all, std::uint64_t now) {
    if (!shown_ || now == 0 || all < done) return;
    const auto instant = std::chrono::steady_clock::now();
    if (instant < next_) return;
    next_ = instant + std::chrono::milliseconds(200);
    const std::chrono::duration<double> passed = instant - began_;
    const double rate = static_cast<double>(now) / passed.count();
    fmt::print(stderr, "\r{} of {} {}, {:.1f}/s, {:.0f} s to go {:8}", done, all, of_, rate,
               static_cast<double>(all - done) / rate, "");
    std::fflush(stderr);
    drawn_ = true;
  }

 private:
  std::string of_;
  bool shown_, drawn_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point next_ = began_ + std::chrono::seconds(1);
};

}  // namespace ttf::cli
