// A cluster's text without the values that follow from the others.
#pragma once

#include <functional>
#include <regex>
#include <string>

#include "schedules/exchange/cluster_yaml.h"
#include "schedules/file/loader.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules::left_out {

// Returns a whole cluster's text (exchange/cluster_yaml.h) without what follows, where `leave()` says so.
inline std::string without_derived(const std::string& whole, const std::function<bool()>& leave) {
  struct Part {
    std::regex line, part;
  };
  static const Part kParts[] = {
      {std::regex("kind: time"), std::regex(", base_cycle: \\d+(, repetition: \\d+), offset: \\d+")},
      {std::regex("kind: time"), std::regex(", repetition: \\d+")},
      {std::regex("measurement: scheduled"), std::regex(", base_cycle: \\d+(, repetition: \\d+), offset: \\d+")},
      {std::regex("^ +deadline: "), std::regex("^ +deadline: .*")},
      {std::regex("shortest_period: [^,}]*\\}"), std::regex(", shortest_period: [^,}]*")},
      {std::regex("slot: .*pdu: "), std::regex("slot: \\d+, (.*)base_cycle: \\d+, ")},
      {std::regex("slot: .*pdu: |sender: .*pdu: "), std::regex("repetition: \\d+, ")},
      {std::regex("sender: .*pdu: "), std::regex(", fragments: \\d+")},
      {std::regex("sender: "), std::regex("channels: [AB]+, ")},
      {std::regex("slot: .*sender: [a-z_]+, base_cycle: 0, repetition: 1\\}"),
       std::regex(", base_cycle: 0, repetition: 1")},
      {std::regex("- \\{slot: \\d+, (channels: [AB]+, )?sender: [a-z_]+(, base_cycle: 0, repetition: 1)?\\}"),
       std::regex("slot: \\d+, ")},
  };
  std::string left;
  for (std::size_t at = 0; at < whole.size();) {
    const std::size_t end = whole.find('\n', at);
    std::string line = whole.substr(at, end - at);
    at = end + 1;
    for (const Part& part : kParts)
      if (std::regex_search(line, part.line) && std::regex_search(line, part.part) && leave())
        line = std::regex_replace(line, part.part, "$1");
    if (!line.empty()) left += line + "\n";
  }
  return left;
}

// Returns a shipped cluster's text without all that follows.
inline std::string without_derived(const std::string& name) {
  return without_derived(exchange::cluster_yaml(file::load_cluster(shipped_path(name)), ""), [] { return true; });
}

}  // namespace ttf::schedules::left_out
