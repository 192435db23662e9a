// A cluster's text without the values that follow from the others.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "schedules/exchange/cluster_yaml.h"
#include "schedules/file/loader.h"
#include "tests/schedules/cluster_file.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::left_out {

// Returns a whole cluster's text (exchange/cluster_yaml.h) without what follows, where `leave()` says so.
inline std::string without_derived(const std::string& whole, const std::function<bool()>& leave) {
  struct Part {
    support::Pattern line, part;
  };
  static const Part kParts[] = {
      {"kind: time", ", base_cycle: \\d+(, repetition: \\d+), offset: \\d+"},
      {"kind: time", ", repetition: \\d+"},
      {"measurement: scheduled", ", base_cycle: \\d+(, repetition: \\d+), offset: \\d+"},
      {"^ +deadline: ", "^ +deadline: .*"},
      {"shortest_period: [^,}]*\\}", ", shortest_period: [^,}]*"},
      {"slot: .*pdu: ", "slot: \\d+, (.*)base_cycle: \\d+, "},
      {"slot: .*pdu: |sender: .*pdu: ", "repetition: \\d+, "},
      {"sender: .*pdu: ", ", fragments: \\d+"},
      {"sender: ", "channels: [AB]+, "},
      {"slot: .*sender: [a-z_]+, base_cycle: 0, repetition: 1\\}", ", base_cycle: 0, repetition: 1"},
      {"- \\{slot: \\d+, (channels: [AB]+, )?sender: [a-z_]+(, base_cycle: 0, repetition: 1)?\\}", "slot: \\d+, "},
  };
  std::string left;
  for (std::size_t at = 0; at < whole.size();) {
    const std::size_t end = whole.find('\n', at);
    std::string line = whole.substr(at, end - at);
    at = end + 1;
    for (const Part& part : kParts)
      if (support::found(line, part.line) && support::found(line, part.part) && leave())
        line = support::replaced(line, part.part, "$1");
    if (!line.empty()) left += line + "\n";
  }
  return left;
}

// Returns a shipped cluster's text without all that follows.
inline const std::string& without_derived(const std::string& name) {
  static std::map<std::string, std::string> made;  // many tests ask for the same
  const auto [at, is_new] = made.try_emplace(name);
  if (is_new)
    at->second =
        without_derived(exchange::cluster_yaml(file::load_cluster(shipped_path(name)), ""), [] { return true; });
  return at->second;
}

}  // namespace ttf::schedules::left_out
