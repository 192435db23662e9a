#include "evaluation/accuracy/service_account.h"

#include <algorithm>
#include <utility>

#include "evaluation/accuracy/plane.h"

namespace ttf::evaluation::accuracy {

ServiceAccount::ServiceAccount(TrueTime from, std::map<SensorId, Duration> bounds)
    : ImageUses(kGate_m), last_(from), from_(from), bounds_(std::move(bounds)) {}

bool ServiceAccount::used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate>,
                          std::span<const SensorAge> ages) {
  const TrueTime at = use.stamp.true_time;
  if (at < from_) return false;
  gaps_.add(at - last_);
  last_ = at;
  ++findings_.uses;
  if (use.stale) ++findings_.refused;
  if (use.stale || !has_image(use.image_sequence)) return false;
  for (const auto& [sensor, bound] : bounds_) {
    const auto one = std::ranges::find(ages, sensor, &SensorAge::sensor);
    TrueTime& newest = newest_.try_emplace(sensor, from_).first->second;
    if (one != ages.end()) newest = at - one->age;
    const Duration age = at - newest;
    if (age <= bound) continue;
    ServiceFindings::Older& older = findings_.older[sensor];
    ++older.uses;
    older.worst = std::max(older.worst, age);
    older.bound = bound;
    if (one == ages.end()) ++older.missing;
  }
  return false;
}

ServiceFindings ServiceAccount::finish(TrueTime end) {
  if (findings_.uses == 0) return findings_;
  const Duration usual = gaps_.quantile(500), longest = std::max(gaps_.longest(), end - last_);
  if (longest > 3 * usual) findings_.gap = longest;
  return findings_;
}

}  // namespace ttf::evaluation::accuracy
