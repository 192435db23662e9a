#include "schedules/file/likeness/inherit_alike.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace ttf::schedules::file::likeness {

std::vector<std::optional<std::size_t>> inherit_alike(NamedMaps& entries, std::string_view what) {
  std::vector<std::optional<std::size_t>> like(entries.size());
  std::vector<std::size_t> refused;
  const auto refuse = [&](std::size_t entry, std::string expected) {
    if (!expected.empty()) entries[entry].second.fail("like", std::move(expected));
    refused.push_back(entry);
  };
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!entries[i].second.has("like")) continue;
    const std::string name = entries[i].second.text("like");
    std::vector<std::string_view> others;
    for (std::size_t other = 0; other < entries.size(); ++other) {
      if (other == i) continue;
      others.emplace_back(entries[other].first);
      if (!like[i] && entries[other].first == name) like[i] = other;
    }
    if (like[i]) continue;
    const bool is_text = !name.empty();  // else a finding already
    refuse(i, is_text ? fmt::format("must be another {} of this file: {}", what, fmt::join(others, ", ")) : "");
  }
  const auto leads_back = [&](std::size_t entry) {
    auto at = like[entry];
    for (std::size_t steps = 0; at && *at != entry && steps < entries.size(); ++steps) at = like[*at];
    return at == entry;
  };
  const std::size_t unknown = refused.size();
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (leads_back(i)) refuse(i, fmt::format("must not lead back to {}", entries[i].first));
  for (std::size_t i = unknown; i < refused.size(); ++i) like[refused[i]].reset();
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (like[i]) entries[i].second.inherit(entries[*like[i]].second);
  // Keys that it lacks are no mistakes of their own.
  const auto whole =
      std::find_if(entries.begin(), entries.end(), [](const auto& one) { return !one.second.has("like"); });
  for (const std::size_t entry : refused)
    if (whole != entries.end()) entries[entry].second.inherit(whole->second);
  return like;
}

}  // namespace ttf::schedules::file::likeness
