#include "recording/exports/lateness_sums.h"

namespace ttf::recording::exports {
namespace {

bool is_of_another_process(const records::BinnedDurations& newer, const records::BinnedDurations& older) {
  const auto after = newer.counts(), before = older.counts();
  if (after.size() < before.size()) return true;
  for (std::size_t bin = 0; bin < before.size(); ++bin)
    if (after[bin] < before[bin]) return true;
  return false;
}

}  // namespace

void LatenessSums::on(const records::LatenessHistogram& record) {
  if (record.of < 1 || record.of > kKinds) return;  // from a later version
  Told& told = told_[record.stamp.node][record.of - 1u];
  const records::BinnedDurations newest(record.counts, record.longest);
  if (record.stamp.local < told.at || is_of_another_process(newest, told.newest)) told.before.add(told.newest);
  told.newest = newest;
  told.at = record.stamp.local;
}

std::map<NodeId, NodeLateness> LatenessSums::nodes() const {
  std::map<NodeId, NodeLateness> nodes;
  for (const auto& [node, told] : told_) {
    const auto sum = [&kinds = told](std::uint8_t of) {
      records::BinnedDurations all = kinds[of - 1u].before;
      all.add(kinds[of - 1u].newest);
      return all;
    };
    nodes[node] = {sum(records::kLatenessOfWakeUps), sum(records::kLatenessOfFloor),
                   sum(records::kLatenessOfDepartures), sum(records::kLatenessOfArrivals),
                   sum(records::kLatenessOfTransits)};
  }
  return nodes;
}

}  // namespace ttf::recording::exports
