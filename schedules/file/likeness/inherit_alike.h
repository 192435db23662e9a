// `like: OTHER` in a sensor or a PDU of a cluster file: the entry has the other's value for each key that it lacks.
//
// The other one may stand behind it, or be like a third one. A key that the entry does not read, as `offset` of a sensor that
// measures freely, is not taken.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/strict_yaml.h"
#include "schedules/model/cluster.h"

namespace ttf::schedules::file::likeness {

using NamedMaps = std::vector<std::pair<std::string, YamlMap>>;
// Returns whether an entry may be like the other one: a finding about a wrong name offers these.
using MayOffer = std::function<bool(std::size_t entry, std::size_t other)>;

// Lets entries with `like` inherit from others. Returns the other's number, by entry. A name of no other entry is a finding. So are
// a circle, once, and a misspelt `like`. An entry that leads there has no other findings.
std::vector<std::optional<std::size_t>> inherit_alike(
    NamedMaps& entries, std::string_view what,
    const MayOffer& may_offer = [](std::size_t, std::size_t) { return true; });

// Lists the keys that entries have from others, when all are read. A `like` without a key is a finding.
void note_inherited(NamedMaps& entries, const std::vector<std::optional<std::size_t>>& like, model::Cluster& cluster);

}  // namespace ttf::schedules::file::likeness
