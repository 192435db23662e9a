// One child process of a launch, in a session and process group of its own, so that signals reach its children, too.
//
//   standard output and error   a pseudo terminal in raw mode: the child's buffers hold no output back, no CR is added,
//                               and the order of both is kept; standard input is /dev/null
//   control                     a socket pair (SOCK_SEQPACKET, one message per packet); its number in the child is in
//                               the environment variable TTF_CONTROL_FD (cli/supervision/control.h)
//   death                       the kernel kills the child when the launching thread ends, for any reason, and hangs up
//                               on its process group; so start children from a lasting thread, such as the main thread
//
// All descriptors are non-blocking; the child inherits only these three.
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
  std::vector<std::string> arguments;                            // [0] is the program, found in PATH if it has no slash
  std::vector<std::pair<std::string, std::string>> environment;  // added to our own; replaces equal names
};

// The end of a process.
struct Ending {
  bool by_signal = false;
  int value = 0;                // exit code, or the signal's number
  bool without_result = false;  // a code of 0 from a process that owed a result

  bool success() const { return !by_signal && value == 0 && !without_result; }
  // Returns a shell's code: the exit code, 128 + signal, or 1 without a result.
  int exit_code() const { return by_signal ? 128 + value : without_result ? 1 : value; }
  std::string text() const;  // "exit 3", "signal 9 (Killed)", "exit 0 without its result"
};

// The program cannot run: what() has the reason; ending() is as a shell's, 127 not found or 126 not executable.
class StartFailure : public std::runtime_error {
 public:
  StartFailure(const std::string& what, Ending ending) : std::runtime_error(what), ending_(ending) {}
  Ending ending() const { return ending_; }

 private:
  Ending ending_;
};

class Child {
 public:
  // Starts the program. Throws StartFailure if it cannot run, std::runtime_error if the system lacks
  // descriptors, processes or pseudo terminals.
  explicit Child(const ChildCommand& command);
  // Kills and reaps the whole group, if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  int process_fd() const { return process_.get(); }                    // readable when the process has ended
  int output_fd() const { return output_over_ ? -1 : output_.get(); }  // -1 when all holders have closed it
  int control_fd() const { return control_.get(); }                    // -1 when the child has closed its end

  // Signals the process and its whole group; has no effect after the reaping.
  void signal_group(int signal);

  // Returns up to `most` bytes of the child's output. Empty: no output now, or its end (see output_fd()). The terminal
  // stays open until the end, because closing it would hang up on a child that has only redirected its output.
  std::string read_output(std::size_t most);
  // Returns one message; no value: no message now, or their end (see control_fd()). A message longer than
  // kLongestMessage is cut and is no longer JSON.
  std::optional<std::string> read_control();
  // Returns false if the child does not take it: closed, or too many messages wait.
  bool send_control(const std::string& message);

  // After the process' end, kills the rest of its group and releases its number. Output and control remain
  // readable until they are empty.
  std::optional<Ending> reap();

 private:
  Descriptor process_, output_, control_;
  pid_t pid_ = -1;
  bool output_over_ = false;
  bool reaped_ = false;
};

}  // namespace ttf::cli::supervision
