// One node of a launch, as the supervisor keeps it. For the supervisor's own files.
#pragma once

#include <memory>
#include <optional>

#include "cli/supervision/supervisor.h"

namespace ttf::cli::supervision {

struct Supervisor::Node {
  Node(std::size_t number, NodeSpec given, const Backoff::Limits& limits)
      : index(number), spec(std::move(given)), speaker{printable(spec.name), number + 1}, backoff(limits) {}

  // Whether there is a process, or will be one.
  bool expected() const { return child != nullptr || restart_at.has_value(); }

  std::size_t index;
  NodeSpec spec;
  Speaker speaker;
  Backoff backoff;
  std::unique_ptr<Child> child;
  LineCutter lines;  // of the present process, as is `ready`
  Duration began{};
  bool ready = false;
  bool failed = false;  // and does not come back
  std::optional<Duration> restart_at;
};

}  // namespace ttf::cli::supervision
