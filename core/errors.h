// Errors in input: the mistake, its place and the correct form.
//
// All readers of input collect Findings, so that all mistakes of a file are reported at once. At the end of
// set-up they throw one InputError. The program prints each finding as one sentence and exits with code 2.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ttf {

// A finding is one mistake. `line` is 1-based, 0 for input without lines; `value` may be empty; `expected` names
// the allowed range or the missing part.
struct Finding {
  std::string file;
  int line = 0;
  std::string key;
  std::string value;
  std::string expected;

  // Returns for example "clusters/a.yaml:12: flexray.gdNIT = 900: must be 2..805 macroticks". The sentence is
  // always one line: control characters of the input become \xNN, and long texts are cut.
  std::string sentence() const;
};

class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Finding> findings);
  explicit InputError(Finding finding) : InputError(std::vector<Finding>{std::move(finding)}) {}
  const std::vector<Finding>& findings() const { return findings_; }

 private:
  std::vector<Finding> findings_;
};

// Collects findings in the order of their discovery.
class Findings {
 public:
  void add(Finding finding) { list_.push_back(std::move(finding)); }
  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  const std::vector<Finding>& list() const { return list_; }
  void throw_if_any() const;

 private:
  std::vector<Finding> list_;
};

// Returns the words for a value of errno. Threads may call it at once, unlike std::strerror.
std::string system_message(int error);

}  // namespace ttf
