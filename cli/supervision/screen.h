// The one place that all words of a launch go to: a terminal, a pipe or a file, which may be slower than those who
// speak, or be stopped (Ctrl-S, less). Nobody waits for it: what does not fit in a bounded queue is left out, whole
// lines of it, and the number of lines that were is shown in their place. (Children's output is complete in their text
// files.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

class Screen {
 public:
  // `fd` is not closed. Lines go to `copy`, a file, as well, if it is open: complete, and without colour.
  explicit Screen(int fd, Descriptor copy = {}) : fd_(fd), copy_(std::move(copy)) {}

  // Queues a line. `plain` is what the copy gets.
  void line(std::string_view text, std::string_view plain);

  // To be polled for POLLOUT; -1: nothing to write, or nobody to write to any more.
  int fd_to_write() const { return queue_.empty() ? -1 : fd_; }
  // Writes as much as surely does not block, after poll() has said that some does not.
  void write_some();
  std::uint64_t lines_left_out() const { return left_out_; }

  static constexpr std::size_t kLongestQueue = 1 << 20;  // bytes

 private:
  void admit_gap();

  int fd_;
  Descriptor copy_;
  std::string queue_;
  std::uint64_t gap_ = 0;       // lines left out since the last one that was queued
  std::uint64_t left_out_ = 0;  // in all
};

// Whether colour is wanted on `fd`: it is a terminal, and NO_COLOR (https://no-color.org) is unset or empty.
bool colour_wanted(int fd);

}  // namespace ttf::cli::supervision
