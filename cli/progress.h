// Shows the progress, the rate and the remaining time of long work; on a terminal only.
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
    if (shown_) fmt::print(stderr, "\r{:78}\r", "");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // `now` counts the part of `done` since the begin of this object; without earlier work both are equal.
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
