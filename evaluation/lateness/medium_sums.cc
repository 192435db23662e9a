#include "evaluation/lateness/medium_sums.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace ttf::evaluation::lateness {
namespace {

using recording::records::MediumCounts;

constexpr std::array<std::uint64_t MediumCounts::*, 7> kCounts{
    &MediumCounts::sent,    &MediumCounts::received,  &MediumCounts::not_sent, &MediumCounts::lost,
    &MediumCounts::foreign, &MediumCounts::malformed, &MediumCounts::dropped};

bool is_of_another_process(const MediumCounts& newer, const MediumCounts& older) {
  return newer.stamp.local < older.stamp.local ||
         std::any_of(kCounts.begin(), kCounts.end(), [&](const auto count) { return newer.*count < older.*count; });
}

void add(MediumCounts& sum, const MediumCounts& more) {
  for (const auto count : kCounts) sum.*count += more.*count;
}

}  // namespace

void MediumSums::on(const MediumCounts& record) {
  Reported& reported = reported_.try_emplace(record.stamp.node, Reported{{}, record}).first->second;
  if (is_of_another_process(record, reported.newest)) add(reported.before, reported.newest);
  reported.newest = record;
}

std::map<NodeId, MediumCounts> MediumSums::nodes() const {
  std::map<NodeId, MediumCounts> nodes;
  for (const auto& [node, reported] : reported_) {
    MediumCounts& sum = nodes[node] = reported.newest;
    add(sum, reported.before);
  }
  return nodes;
}

}  // namespace ttf::evaluation::lateness
