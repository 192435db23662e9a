// The findings of a launch, besides its drive's results.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ttf::cli::drive {

struct AbsentNode {
  std::string name, state;  // state: the controller's, or the failed process's ending
};

// A node in place of one of the launch's own.
struct ExternalNode {
  std::string node;
  std::uint64_t in_window = 0, early = 0, late = 0, missing = 0;  // frames
  std::vector<std::pair<std::string, std::uint64_t>> malformed;   // by kind
  std::vector<std::string> never_received;                        // lists and lines of a node that was heard
  std::optional<double> first_after_s;
  std::string state;
};

struct Verdict {
  bool matters = false;
  std::string sentence;
};

struct LaunchFindings {
  std::optional<std::vector<AbsentNode>> absent;  // not in operation at the end; no value if the drive did not begin
  std::vector<ExternalNode> external;
  std::optional<Verdict> verdict;  // only in real time
};

}  // namespace ttf::cli::drive
