// The common output of a launch: a terminal, a pipe or a file. It may be slower than the speakers, or stopped
// (Ctrl-S, less). No speaker waits for it: whole lines beyond a bounded queue are dropped, and their number
// is shown instead. The children's text files are complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

class Screen {
 public:
  // `fd` is not closed. `copy`, a file, if open, gets every line, without colour.
  explicit Screen(int fd, Descriptor copy = {}) : fd_(fd), copy_(std::move(copy)) {}

  // Queues a line; `plain` goes to the copy.
  void line(std::string_view text, std::string_view plain);
  // Keeps these lines below all others, in place of the last such lines. It needs a terminal. They are drawn when nothing else
  // is queued. They have no copy. A line must be narrower than the terminal. An empty text removes them.
  void status(std::string lines);

  // Returns the descriptor to poll for POLLOUT; -1 without pending output or reader.
  int fd_to_write() const { return queue_.empty() ? -1 : fd_; }
  // Writes only as much as surely does not block, after poll() has reported room.
  void write_some();
  std::uint64_t lines_left_out() const { return left_out_; }

  static constexpr std::size_t kLongestQueue = 1 << 20;  // bytes

 private:
  void admit_gap();
  void erase_status();
  void draw_status();

  int fd_;
  Descriptor copy_;
  std::string queue_;
  std::uint64_t gap_ = 0;       // lines dropped since the last queued line
  std::uint64_t left_out_ = 0;  // in all
  std::string status_;
  std::size_t drawn_ = 0;  // lines of the status at the end of the queue's text
};

// Returns whether `fd` is a terminal that moves its cursor: TERM is not "dumb".
bool moves_cursor(int fd);

struct TerminalSize {
  std::size_t columns = 80, rows = 24;  // where the terminal does not say
};
TerminalSize terminal_size(int fd);
// Cuts lines of UTF-8 to less than the terminal's width. Leaves out lines beyond its height.
std::string fitted(std::string_view lines, const TerminalSize& size);

// Returns whether `fd` gets colour: it is a terminal, and NO_COLOR (https://no-color.org) is unset or empty.
bool colour_wanted(int fd);

}  // namespace ttf::cli::supervision
