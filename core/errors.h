// Bad input: what is wrong, where, and what would be right.
//
// Everything that reads input collects Findings, so that all mistakes of a file are reported at once, and throws
// one InputError at the end of set-up. The program prints each finding as one sentence and exits with code 2.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ttf {

// One mistake. `line` is 1-based, 0 where the input has no lines; `value` may be empty; `expected` is the allowed
// range or what is missing, in words.
struct Finding {
  std::string file;
  int line = 0;
  std::string key;
  std::string value;
  std::string expected;

  // "clusters/a.yaml:12: flexray.gdNIT = 900: must be 2..805 macroticks". Always one line: control characters of the
  // input are written as \xNN, and what is very long is cut.
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

// Collects findings in the order they were met.
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

}  // namespace ttf
