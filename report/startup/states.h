// Turns changes of state into the duration of each state, and gives states their colours and short names.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "report/startup/data.h"

namespace ttf::report::startup {

struct StateSpan {
  NodeId node{};
  recording::records::PocKind state{};
  TrueTime start{}, end{};
  std::string name;  // as in the log
  std::string why;   // the cause of its entry; empty if the log has no cause
};

// Returns the nodes that were normal active before the log mentions their state: a drive that begins
// integrated does not record it. Such a node loses its supply without having gained it, or only sends.
std::set<NodeId> active_from_the_start(const StartupData& data);

// Returns the states of all nodes in the order of entry. Each lasts until it was left, its node lost its
// supply, or `end`. A node's state before its first change lasts since `begin`, as does normal active of the
// nodes above. A first change out of default config is an exception: the node was powered on with it. States
// without a duration are left out.
std::vector<StateSpan> state_spans(const StartupData& data, TrueTime begin, TrueTime end);

// The phase of a state; states of one phase have one colour.
struct StatePhase {
  std::string_view words;  // for the legend
  std::string colour;
};
StatePhase phase_of(recording::records::PocKind state);
// Returns a name for narrow bars, or "" if the state has no short name.
std::string_view short_name(recording::records::PocKind state);

}  // namespace ttf::report::startup
