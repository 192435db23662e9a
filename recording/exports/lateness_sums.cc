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
  const std::size_t of = index_of(record.of);
  if (of < 1 || of > kKinds) return;  // from a later version
  Reported& reported = reported_[record.stamp.node][of - 1];
  const records::BinnedDurations newest(record.counts, record.longest);
  if (record.stamp.local < reported.at || is_of_another_process(newest, reported.newest))
    reported.before.add(reported.newest);
  reported.newest = newest;
  reported.at = record.stamp.local;
}

std::map<NodeId, NodeLateness> LatenessSums::nodes() const {
  using records::LatenessOf;
  std::map<NodeId, NodeLateness> nodes;
  for (const auto& [node, reported] : reported_) {
    const auto sum = [&kinds = reported](LatenessOf of) {
      const Reported& one = kinds[index_of(of) - 1];
      records::BinnedDurations all = one.before;
      all.add(one.newest);
      return all;
    };
    nodes[node] = {sum(LatenessOf::kWakeUps), sum(LatenessOf::kFloor), sum(LatenessOf::kDepartures),
                   sum(LatenessOf::kArrivals), sum(LatenessOf::kTransits)};
  }
  return nodes;
}

}  // namespace ttf::recording::exports
