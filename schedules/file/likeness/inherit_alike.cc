#include "schedules/file/likeness/inherit_alike.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace ttf::schedules::file::likeness {
namespace {

class Heirs {
 public:
  Heirs(NamedMaps& entries, std::string_view what, const MayOffer& may_offer)
      : entries_(entries), what_(what), may_offer_(may_offer), like_(entries.size()), refused_(entries.size()) {}

  std::vector<std::optional<std::size_t>> inherit() {
    std::vector<std::size_t> unknown;
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (!find_other(i)) unknown.push_back(i);
    refuse_circles();
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (like_[i]) map(i).inherit(map(*like_[i]));
    for (const std::size_t i : unknown) refuse_unknown(i);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (is_lost(i)) map(i).mute();
    return std::move(like_);
  }

 private:
  YamlMap& map(std::size_t entry) { return entries_[entry].second; }

  // Returns false for a `like` that is no other entry's name.
  bool find_other(std::size_t entry) {
    if (!map(entry).has("like")) {
      refused_[entry] = map(entry).refuse_misspelt("like");
      return true;
    }
    const std::string name = map(entry).value_text("like");
    for (std::size_t other = 0; other < entries_.size(); ++other)
      if (other != entry && entries_[other].first == name) like_[entry] = other;
    refused_[entry] = !like_[entry];
    return like_[entry].has_value();
  }

  // Each circle is one finding, at its first entry.
  void refuse_circles() {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const std::vector<std::size_t> circle = circle_from(i);
      std::string words;
      for (const std::size_t one : circle) words += fmt::format(", which is like {}", entries_[*like_[one]].first);
      for (const std::size_t one : circle) {
        refused_[one] = true;
        like_[one].reset();
      }
      if (!circle.empty())
        map(i).fail("like", fmt::format("must not lead back to {0}: {0} {1}", entries_[i].first, words.substr(8)));
    }
  }

  // Returns the entries from this one back to it; none if its way does not lead back.
  std::vector<std::size_t> circle_from(std::size_t entry) const {
    std::vector<std::size_t> way;
    for (auto at = std::optional(entry); at && way.size() <= entries_.size(); at = like_[*at]) {
      if (*at == entry && !way.empty()) return way;
      way.push_back(*at);
    }
    return {};
  }

  void refuse_unknown(std::size_t entry) {
    std::vector<std::string_view> others;
    for (std::size_t other = 0; other < entries_.size(); ++other)
      if (other != entry && !is_lost(other) && may_offer_(entry, other)) others.emplace_back(entries_[other].first);
    map(entry).fail("like",
                    others.empty() ? fmt::format("must be another {} of this file, which has none to copy", what_)
                                   : fmt::format("must be another {} of this file: {}", what_, fmt::join(others, ", ")),
                    map(entry).value_text("like"));
  }

  // Returns whether the entry is refused, or leads to one that is. The keys that it lacks are no mistakes of their own.
  bool is_lost(std::size_t entry) const {
    for (auto at = std::optional(entry); at; at = like_[*at])
      if (refused_[*at]) return true;
    return false;
  }

  NamedMaps& entries_;
  std::string_view what_;
  const MayOffer& may_offer_;
  std::vector<std::optional<std::size_t>> like_;  // by entry
  std::vector<bool> refused_;
};

}  // namespace

std::vector<std::optional<std::size_t>> inherit_alike(NamedMaps& entries, std::string_view what,
                                                      const MayOffer& may_offer) {
  return Heirs(entries, what, may_offer).inherit();
}

void note_inherited(NamedMaps& entries, const std::vector<std::optional<std::size_t>>& like, model::Cluster& cluster) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    YamlMap& map = entries[i].second;
    if (!like[i]) continue;
    const std::vector<std::string> keys = map.inherited();
    for (const std::string& key : keys) {
      std::size_t owner = *like[i];
      while (like[owner] && !entries[owner].second.has_own(key)) owner = *like[owner];
      cluster.inherited[fmt::format("{}.{}", map.path(), key)] = {entries[owner].second.path(), map.line("like")};
    }
    if (keys.empty())
      map.fail("like",
               fmt::format("has no effect: {} has each of its keys itself, here or in a file that this one extends",
                           entries[i].first));
  }
}

}  // namespace ttf::schedules::file::likeness
