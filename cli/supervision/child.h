// One child process of a launch, in a session and process group of its own: what it starts in turn can be signalled
// with it.
//
//   standard output and error   a pseudo terminal in raw mode, so that nothing is held back in the child's buffers, no
//                               CR is added, and the order of both is kept; standard input is /dev/null
//   control                     a socket pair (SOCK_SEQPACKET, one message per packet); its number in the child is in
//                               the environment variable TTF_CONTROL_FD (cli/supervision/control.h)
//   death                       the kernel kills the child when the launching thread ends, however that happens, and
//                               hangs up on its process group; so start children from a thread that lives on, as the
//                               main thread does
//
// All descriptors are non-blocking; none but these three is inherited.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/supervision/descriptor.h"

namespace ttf::cli::supervision {

struct ChildCommand {
  std::vector<std::string> arguments;  // [0] is the program, looked for in PATH if it has no slash
  std::vector<std::pair<std::string, std::string>> environment;  // added to our own, or instead of ours
};

// How a process ended.
struct Ending {
  bool by_signal = false;
  int value = 0;  // exit code, or number of the signal

  bool success() const { return !by_signal && value == 0; }
  // What a shell would say: the code, or 128 + signal.
  int exit_code() const { return by_signal ? 128 + value : value; }
  std::string text() const;  // "exit 3", "signal 9 (Killed)"
};

// The program does not run at all: what() says why; ending() is a shell's, 127 not found or 126 not to be run.
class StartFailure : public std::runtime_error {
 public:
  StartFailure(const std::string& what, Ending ending) : std::runtime_error(what), ending_(ending) {}
  Ending ending() const { return ending_; }

 private:
  Ending ending_;
};

class Child {
 public:
  // Starts it. Throws StartFailure where the program cannot be run, std::runtime_error where the system lacks what is
  // needed (descriptors, processes, pseudo terminals).
  explicit Child(const ChildCommand& command);
  // Whoever still lives is killed, with the whole group, and reaped.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  int process_fd() const { return process_.get(); }                    // readable when the process has ended
  int output_fd() const { return output_over_ ? -1 : output_.get(); }  // -1 when nobody has it open any more
  int control_fd() const { return control_.get(); }                    // -1 when the child has closed its end

  // To the process and all of its group; nothing once it has been reaped.
  void signal_group(int signal);

  // Up to `most` bytes of what it prints. Empty: nothing there now, or no more to come (output_fd() tells). The
  // terminal itself stays until the end, because closing it would hang up on a child that has only redirected its
  // output.
  std::string read_output(std::size_t most);
  // One message; nothing: none there now, or no more to come (control_fd() tells). One that is longer than
  // kLongestMessage is cut, and no JSON any more.
  std::optional<std::string> read_control();
  // False where the child does not take it: closed, or too many waiting.
  bool send_control(const std::string& message);

  // If it has ended: kills what is left of its group, then gives its number back to the system. Output and control can
  // still be read until they are empty.
  std::optional<Ending> reap();

 private:
  Descriptor process_, output_, control_;
  pid_t pid_ = -1;
  bool output_over_ = false;
  bool reaped_ = false;
};

}  // namespace ttf::cli::supervision
