// Completes a cluster that leaves parameters out, by the rules of schedules/file/derive.h. The loader reads a parameter or
// notes that it is absent; then it completes the global ones, each controller's clock, and at last all controllers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "schedules/file/derive.h"
#include "schedules/file/parameter_table.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file {

// Read a parameter, or note that it is absent where a rule gives its value.
template <class Struct>
void read_parameter(YamlMap& map, const IntegerParameter<Struct>& p, Struct& into, Absent& absent) {
  const Range<std::int64_t> allowed{p.low, p.high};
  if (p.otherwise)
    into.*p.member = static_cast<int>(map.integer_or(p.name, *p.otherwise, allowed, p.unit));
  else if (!is_derived(p.name))
    into.*p.member = static_cast<int>(map.integer(p.name, allowed, p.unit));
  else if (const auto value = map.integer_if(p.name, allowed, p.unit))
    into.*p.member = static_cast<int>(*value);
  else
    absent.emplace(p.name);
}
template <class Struct>
void read_parameter(YamlMap& map, const ScaledParameter<Struct>& p, Struct& into, Absent& absent) {
  const Range<std::int64_t> allowed{p.low, p.high};
  if (!is_derived(p.name))
    into.*p.member = map.scaled(p.name, p.scale, allowed, p.unit);
  else if (const auto value = map.scaled_if(p.name, p.scale, allowed, p.unit))
    into.*p.member = *value;
  else
    absent.emplace(p.name);
}

class Completion {
 public:
  Completion(model::Cluster& cluster, Findings& findings) : cluster_(cluster), findings_(findings) {}

  // `map`: that of the file, for findings about values that no rule gives or that are out of range.
  void globals(YamlMap& map, Absent absent);
  // Completes the microtick. The others wait until finish().
  void clock(std::size_t node, YamlMap& map, Absent absent);
  void finish();

 private:
  struct Waiting {
    std::size_t node;
    YamlMap map;
    Absent absent;
  };
  template <class Struct>
  void take(Struct& into, YamlMap& map, Absent& absent, std::string_view name, std::string_view derivation,
            std::optional<std::int64_t> value);
  void complete(Waiting& waiting, std::span<const NodeRule> rules, std::int64_t worst_drift_ppb);
  void say_shared_values_once();

  model::Cluster& cluster_;
  Findings& findings_;
  std::vector<Waiting> waiting_;
};

}  // namespace ttf::schedules::file
