// File and process operations of the tests' child.
#pragma once

#include <sys/types.h>

#include <string>

namespace ttf::cli::supervision {

// Sends the unchanged text on the control line.
void report(int control_fd, const std::string& text);
// A file that appears complete.
void leave_number(const std::string& path, pid_t number);
// Forks a process that waits for ever, with its number in the file.
void descend(const std::string& path);
// Returns the number of calls with this file, this one included.
int times(const std::string& path);
// Describes the standard descriptors, the environment and all open descriptors besides the control line.
std::string surroundings(int control_fd);
// Runs a supervisor of `DIR/child` and `DIR/grandchild`; its exit code.
int supervise(const std::string& folder);

}  // namespace ttf::cli::supervision
