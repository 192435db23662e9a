// Finds every key that a loader reads: reads described files with every answer that may change the next questions.
//
// The first run has the usual answers. Each decision that a run is the first to meet gets one more run for each other
// answer; all else is answered as in the run that met it. If such an answer changes the keys of its own mapping, all
// decisions of this mapping are tried again under it. So the number of runs grows with the number of decisions, not
// with their combinations.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/strict_yaml.h"
#include "keys/described_reading.h"

namespace ttf::keys {

// Its findings are ignored: they are about made-up values.
using Loader = std::function<void(const StrictYaml&)>;

struct Run {
  DescribedReading::Answers answers;  // the unusual ones
  std::size_t parent = 0;
  std::optional<DescribedReading::Decision> changed;  // with the parent's answer; none in the first run
  bool changes_keys = false;                          // the changed answer changes the keys of its mapping
  std::set<std::string> changes_within;               // and these mappings of its keys, by their paths
  std::vector<DescribedReading> readings;             // usual, least and largest numbers

  const DescribedReading& usual() const { return readings.front(); }
};

struct Exploration {
  std::deque<Run> runs;  // a run stays where it is while others are added
  // By a key's path, the paths of the keys by which its bounds, or its default, change.
  std::map<std::string, std::set<std::string>> bounds_by, default_by;
};

Exploration explore(const Loader& load);

}  // namespace ttf::keys
