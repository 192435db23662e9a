#include "cli/supervision/screen.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>

#include <algorithm>

#include "cli/supervision/signal_watch.h"

namespace ttf::cli::supervision {
namespace {

struct Pipe {
  Pipe() {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    out = Descriptor(ends[0]);
    in = Descriptor(ends[1]);
  }
  Descriptor out, in;
};

bool takes_some(int fd) {
  pollfd watched{fd, POLLOUT, 0};
  return poll(&watched, 1, 0) > 0;
}

std::string read_some(int fd) {
  std::string bytes(1 << 16, '\0');
  pollfd watched{fd, POLLIN, 0};
  if (poll(&watched, 1, 0) <= 0) return {};
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(read(fd, bytes.data(), bytes.size()), 0)));
  return bytes;
}

TEST(Screen, ShowsLinesInOrder) {
  Pipe pipe;
  Screen screen(pipe.in.get());
  EXPECT_EQ(screen.fd_to_write(), -1);
  screen.line("one", "one");
  screen.line("two", "two");
  EXPECT_EQ(screen.fd_to_write(), pipe.in.get());
  screen.write_some();
  EXPECT_EQ(screen.fd_to_write(), -1);
  EXPECT_EQ(read_some(pipe.out.get()), "one\ntwo\n");
}

// A reader stops reading: writers do not wait, whole lines are left out, and their number stands in their
// place.
TEST(Screen, LeavesOutWhatASlowReaderDoesNotTake) {
  Pipe pipe;
  const int copy = memfd_create("copy", 0);
  Screen screen(pipe.in.get(), Descriptor(fcntl(copy, F_DUPFD_CLOEXEC, 0)));
  const std::string text(999, 'x');
  constexpr std::uint64_t kLines = 3000;  // 3 MB
  for (std::uint64_t i = 0; i < kLines; ++i) {
    screen.line(text, "plain");
    if (takes_some(screen.fd_to_write())) screen.write_some();
  }
  EXPECT_FALSE(takes_some(pipe.in.get()));
  ASSERT_GT(screen.lines_left_out(), 0u);
  std::string seen;
  while (screen.fd_to_write() >= 0) {
    if (takes_some(screen.fd_to_write())) screen.write_some();
    seen += read_some(pipe.out.get());
  }
  for (std::string more = read_some(pipe.out.get()); !more.empty(); more = read_some(pipe.out.get())) seen += more;
  const auto lines = static_cast<std::uint64_t>(std::ranges::count(seen, '\n'));
  EXPECT_EQ(lines - 1 + screen.lines_left_out(), kLines);
  EXPECT_TRUE(
      seen.ends_with("x\n[" + std::to_string(screen.lines_left_out()) + " lines left out: the reader is too slow]\n"));
  EXPECT_EQ(lseek(copy, 0, SEEK_END), static_cast<off_t>(kLines * 6));  // the copy is complete
  close(copy);
}

TEST(Screen, GoesOnWithoutAReader) {
  const SignalWatch no_sigpipe;
  Pipe pipe;
  Screen screen(pipe.in.get());
  pipe.out.close();
  screen.line("one", "one");
  EXPECT_TRUE(takes_some(screen.fd_to_write()));
  screen.write_some();
  EXPECT_EQ(screen.fd_to_write(), -1);
  screen.line("two", "two");
  EXPECT_EQ(screen.fd_to_write(), -1);
}

// Lines go above the status; it is drawn anew below them, once nothing else waits.
TEST(Screen, KeepsTheStatusBelow) {
  Pipe pipe;
  Screen screen(pipe.in.get());
  const auto written = [&] {
    while (screen.fd_to_write() >= 0) screen.write_some();
    return read_some(pipe.out.get());
  };
  screen.status("a\nb\n");
  EXPECT_EQ(written(), "a\nb\n");
  screen.line("one", "one");
  screen.line("two", "two");
  EXPECT_EQ(written(), "\x1b[2A\x1b[Jone\ntwo\na\nb\n");
  screen.status("c\n");
  EXPECT_EQ(written(), "\x1b[2A\x1b[Jc\n");
  screen.line("three", "three");
  screen.status("d\n");  // the line is still to come
  EXPECT_EQ(written(), "\x1b[1A\x1b[Jthree\nd\n");
  screen.status("");
  EXPECT_EQ(written(), "\x1b[1A\x1b[J");
  screen.line("four", "four");
  EXPECT_EQ(written(), "four\n");
}

TEST(Screen, ADumbTerminalDoesNotMoveItsCursor) {
  const Descriptor terminal(posix_openpt(O_RDWR | O_NOCTTY));
  Pipe pipe;
  setenv("TERM", "xterm", 1);
  EXPECT_TRUE(moves_cursor(terminal.get()));
  EXPECT_FALSE(moves_cursor(pipe.in.get()));
  setenv("TERM", "dumb", 1);
  EXPECT_FALSE(moves_cursor(terminal.get()));
  unsetenv("TERM");
}

TEST(Screen, CutsLinesToTheTerminal) {
  EXPECT_EQ(fitted("abcdef\nab\n", {4, 24}), "abc\nab\n");
  EXPECT_EQ(fitted("\u00e4\u00f6\u00fcx\n", {4, 24}), "\u00e4\u00f6\u00fc\n");
  EXPECT_EQ(fitted("1\n2\n3\n4\n", {80, 3}), "1\n2\n");
  EXPECT_EQ(fitted("", {80, 24}), "");
}

TEST(Screen, IsColouredOnATerminalThatWantsIt) {
  const Descriptor terminal(posix_openpt(O_RDWR | O_NOCTTY));
  Pipe pipe;
  unsetenv("NO_COLOR");
  EXPECT_TRUE(colour_wanted(terminal.get()));
  EXPECT_FALSE(colour_wanted(pipe.in.get()));
  setenv("NO_COLOR", "", 1);
  EXPECT_TRUE(colour_wanted(terminal.get()));
  setenv("NO_COLOR", "1", 1);
  EXPECT_FALSE(colour_wanted(terminal.get()));
  unsetenv("NO_COLOR");
}

}  // namespace
}  // namespace ttf::cli::supervision
