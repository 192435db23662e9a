// The refusal of bad input, as tests compare it: the findings of an InputError, or its message.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace ttf::support {

// Returns the findings with which `work` refuses its input; none if it accepts the input.
template <class Work> std::vector<Finding> findings_of(Work&& work) {
  try {
    std::forward<Work>(work)();
  } catch (const InputError& error) {
    return error.findings();
  }
  return {};
}

// Returns the message with which `work` refuses its input, or `accepted`.
template <class Work> std::string refusal_of(Work&& work, std::string accepted = "") {
  try {
    std::forward<Work>(work)();
  } catch (const InputError& error) {
    return error.what();
  }
  return accepted;
}

// Returns the sentence of each finding.
template <class Work> std::vector<std::string> sentences_of(Work&& work) {
  std::vector<std::string> sentences;
  for (const Finding& finding : findings_of(std::forward<Work>(work))) sentences.push_back(finding.sentence());
  return sentences;
}

}  // namespace ttf::support
