#include "cli/supervision/screen.h"

#include <fmt/format.h>
#include <limits.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

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
  admit_gap();
  queue_ += text;
  queue_ += '\n';
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
  } else if (written < 0 && errno != EAGAIN && errno != EINTR) {
    fd_ = -1;  // the reader is gone; the nodes continue
    queue_.clear();
  }
}

bool colour_wanted(int fd) {
  const char* const refused = std::getenv("NO_COLOR");
  return isatty(fd) != 0 && (refused == nullptr || *refused == '\0');
}

}  // namespace ttf::cli::supervision
