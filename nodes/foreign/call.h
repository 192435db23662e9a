// Calls into a library's code. A call has a time limit by the wall, and a crash in it has a sentence.
//
// A timer of the calling thread ticks while a call lasts. At the last tick the handler writes the call's sentence and ends
// the process with exit code 1; it needs nothing that a hanging call might hold. The limit is counted in ticks, so a
// process that was stopped for an hour and goes on loses one of them. A crash ends the process by its signal, after its
// sentence. Handlers of others, such as a sanitizer's, stay.
//
// A call begins with the default floating-point environment, and its changes there are undone.
#pragma once

#include <cfenv>
#include <string>

#include "core/time.h"

namespace ttf::nodes::foreign {

// The sentences of a step's calls, prepared before any of them, and their limit.
struct CallTerms {
  std::string hang, crash;
  Duration limit{};
};

// Writes the sentences behind `place`, which names the task and its library.
CallTerms terms_of(const std::string& place, Duration limit);

// Guards the calling thread from construction to destruction. Guards do not nest. The first one of a thread allocates.
class Call {
 public:
  explicit Call(const CallTerms& terms);  // `terms` must outlive it
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  std::fenv_t environment_;
};

}  // namespace ttf::nodes::foreign
