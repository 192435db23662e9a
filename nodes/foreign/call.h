// Calls into a library's code. A call has a time limit by the wall, and a crash in it has a sentence.
//
// A timer of the calling thread ticks while a call lasts. At the last tick the handler writes the call's sentence and ends
// the process with exit code 1; it needs nothing that a hanging call might hold. The limit is counted in ticks, so a
// process that was stopped for an hour and goes on loses one of them. A crash ends the process by its signal, after its
// sentence. Handlers of others, such as a sanitizer's, stay. exit() in a call ends the process with exit code 1, after a
// sentence; _exit() has no handler.
//
// A call begins with the default floating-point environment. Its changes there and of the signal mask are undone. A call
// that blocks the tick's signal has no limit until it returns.
#pragma once

#include <signal.h>

#include <cfenv>
#include <exception>
#include <optional>
#include <string>

#include "core/time.h"

namespace ttf::nodes::foreign {

// The sentences of a step's calls, prepared before any of them, and their limit.
struct CallTerms {
  std::string hang, crash, exit;
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
  sigset_t mask_;
};

// Calls `code` of a library under guard. Returns what it threw, in words; no value if it returned. The exception ends
// within the guard: its words are code of the library, too.
template <class Code> std::optional<std::string> thrown_by(const CallTerms& terms, const Code& code) {
  const Call call(terms);
  try {
    code();
  } catch (const std::exception& error) {
    return std::string("threw: ") + error.what();
  } catch (...) {
    return "threw something else than a std::exception";
  }
  return std::nullopt;
}

}  // namespace ttf::nodes::foreign
