#include "cli/supervision/policy.h"

#include <signal.h>

#include <algorithm>

namespace ttf::cli::supervision {

std::string_view name_of(Policy policy) {
  switch (policy) {
    case Policy::kRequired: return "required";
    case Policy::kRestart: return "restart";
    case Policy::kOptional: return "optional";
  }
  return "";
}

std::optional<Policy> policy_of(std::string_view name) {
  for (const Policy policy : {Policy::kRequired, Policy::kRestart, Policy::kOptional})
    if (name_of(policy) == name) return policy;
  return std::nullopt;
}

std::optional<Duration> Backoff::next(Duration lasted) {
  if (lasted >= limits_.settled) tried_ = 0;
  if (tried_ >= limits_.count) return std::nullopt;
  Duration wait = std::min(limits_.first, limits_.most);
  for (int i = 0; i < tried_ && wait < limits_.most; ++i) wait = std::min(wait * 2, limits_.most);
  ++tried_;
  return wait;
}

std::optional<int> StopOrder::begin(Duration now) { return begun() ? std::nullopt : hurry(now); }

std::optional<int> StopOrder::hurry(Duration now) {
  switch (signal_) {
    case 0: next_ = now + grace_.interrupt; return signal_ = SIGINT;
    case SIGINT: next_ = now + grace_.terminate; return signal_ = SIGTERM;
    case SIGTERM: next_ = std::nullopt; return signal_ = SIGKILL;
  }
  return std::nullopt;
}

std::optional<int> StopOrder::due(Duration now) { return next_ && now >= *next_ ? hurry(now) : std::nullopt; }

}  // namespace ttf::cli::supervision
