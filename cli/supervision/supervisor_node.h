// One node of a launch in the supervisor. Only for the supervisor's own files.
#pragma once

#include <memory>
#include <optional>

#include "cli/supervision/supervisor.h"

namespace ttf::cli::supervision {

struct Supervisor::Node {
  Node(std::size_t number, NodeSpec given, const Backoff::Limits& limits)
      : index(number), spec(std::move(given)), speaker{printable(spec.name), number + 1}, backoff(limits) {}

  // Returns whether a process exists or will be started.
  bool expected() const { return child != nullptr || restart_at.has_value(); }

  std::size_t index;
  NodeSpec spec;
  Speaker speaker;
  Backoff backoff;
  std::unique_ptr<Child> child;
  LineCutter lines;  // belongs to the present process, as `ready` and `done`
  Duration began{};
  bool ready = false;
  bool done = false;
  bool failed = false;  // and is not restarted
  std::optional<Duration> restart_at;
  ExternalHealth external;  // an external node's
};

}  // namespace ttf::cli::supervision
