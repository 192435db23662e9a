// From changes of state to how long each state lasted, and how a state looks.
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
  std::uint8_t state = 0;
  TrueTime start{}, end{};
  std::string name;  // as the log has it
  std::string why;   // it was entered; empty where the log does not say
};

// The nodes that were normal active before the log says anything of their state: a run that begins integrated does not
// tell. They lose their supply without having been given one, or do nothing but send.
std::set<NodeId> active_from_the_start(const StartupData& data);

// The states of all nodes in the order they were entered, each until it was left, its node lost its supply, or `end`.
// What a node was in before its first change is a state since `begin`, as is normal active of those above, but for a
// node whose first change is out of default config: that was powered on with it. States that lasted no time are left
// out.
std::vector<StateSpan> state_spans(const StartupData& data, TrueTime begin, TrueTime end);

// What a node is about in a state: states of one phase have one colour.
struct StatePhase {
  std::string_view words;  // for the legend
  std::string colour;
};
StatePhase phase_of(std::uint8_t state);
// A name for narrow bars; empty where there is none.
std::string_view short_name(std::uint8_t state);

// The faults that are there in a window, with all that is known of them.
std::vector<StartupData::Fault> faults_within(const std::vector<StartupData::Fault>& faults, TrueTime from,
                                              TrueTime to);

}  // namespace ttf::report::startup
