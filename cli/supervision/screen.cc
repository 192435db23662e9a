#include "cli/supervision/screen.h"

#include <fmt/format.h>
#include <limits.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <utility>

namespace ttf::cli::supervision {
namespace {

// A failure to write the copy (a full disk) is no reason to stop a drive.
void write_whole(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

void Screen::line(std::string_view text, std::string_view plain) {
  if (copy_.open()) write_whole(copy_.get(), fmt::format("{}\n", plain));
  if (fd_ < 0) return;
  if (queue_.size() + text.size() >= kLongestQueue) {
    ++gap_;
    ++left_out_;
    return;
  }
  erase_status();
  admit_gap();
  queue_ += text;
  queue_ += '\n';
}

void Screen::status(std::string lines) {
  if (fd_ < 0) return;
  status_ = std::move(lines);
  if (!queue_.empty()) {
    if (status_.empty()) erase_status();
    return;
  }
  erase_status();
  draw_status();
}

// Moves up to the first of the lines, and clears from there on.
void Screen::erase_status() {
  if (drawn_ > 0) queue_ += fmt::format("\x1b[{}A\x1b[J", drawn_);
  drawn_ = 0;
}

void Screen::draw_status() {
  queue_ += status_;
  drawn_ = static_cast<std::size_t>(std::ranges::count(status_, '\n'));
}

void Screen::admit_gap() {
  if (gap_ == 0) return;
  queue_ += fmt::format("[{} lines left out: the reader is too slow]\n", gap_);
  gap_ = 0;
}

void Screen::write_some() {
  if (queue_.empty() && gap_ == 0) return;
  // PIPE_BUF is what a ready pipe surely takes.
  const ssize_t written = write(fd_, queue_.data(), std::min<std::size_t>(queue_.size(), PIPE_BUF));
  if (written > 0) {
    queue_.erase(0, static_cast<std::size_t>(written));
    if (queue_.empty()) admit_gap();
    if (queue_.empty() && drawn_ == 0) draw_status();
  } else if (written < 0 && errno != EAGAIN && errno != EINTR) {
    fd_ = -1;  // the reader is gone; the nodes continue
    queue_.clear();
  }
}

bool moves_cursor(int fd) {
  const char* const kind = std::getenv("TERM");
  return isatty(fd) != 0 && (kind == nullptr || std::string_view(kind) != "dumb");
}

TerminalSize terminal_size(int fd) {
  winsize reported{};
  TerminalSize size;
  if (ioctl(fd, TIOCGWINSZ, &reported) != 0) return size;
  if (reported.ws_col > 0) size.columns = reported.ws_col;
  if (reported.ws_row > 0) size.rows = reported.ws_row;
  return size;
}

std::string fitted(std::string_view lines, const TerminalSize& size) {
  std::string out;
  for (std::size_t row = 0; row + 1 < size.rows && !lines.empty(); ++row) {
    const std::size_t end = std::min(lines.find('\n'), lines.size());
    std::size_t shown = 0, cut = 0;
    for (; cut < end; ++cut) {
      const bool begins = (static_cast<unsigned char>(lines[cut]) & 0xc0u) != 0x80u;
      if (begins && ++shown == size.columns) break;  // a full line would begin another one on some terminals
    }
    out += lines.substr(0, cut);
    out += '\n';
    lines.remove_prefix(std::min(end + 1, lines.size()));
  }
  return out;
}

bool colour_wanted(int fd) {
  const char* const refused = std::getenv("NO_COLOR");
  return isatty(fd) != 0 && (refused == nullptr || *refused == '\0');
}

}  // namespace ttf::cli::supervision
