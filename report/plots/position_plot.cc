#include "report/plots/position_plot.h"

#include <algorithm>
#include <utility>

namespace ttf::report::plots {
namespace {

// Returns the true time of a global instant by the clock that stamped the record. A recording without true
// time (all zero) keeps global time.
double true_seconds(GlobalTime t, const recording::records::Stamp& stamp) {
  // Doubles are exact for drives of up to 100 days, and do not overflow for any number in a damaged log.
  const auto ns = [](std::int64_t count) { return static_cast<double>(count); };
  const double offset = stamp.true_time.ns != 0 ? ns(stamp.true_time.ns) - ns(stamp.global.ns) : 0.0;
  return (ns(t.ns) + offset) * 1e-9;
}

}  // namespace

PositionPlots::PositionPlots(drawing::Names names, PositionOptions options)
    : names_(std::move(names)), options_(std::move(options)) {}

void PositionPlots::on(const recording::records::ObservationSeen& r) {
  observations_.push_back({true_seconds(r.measured, r.stamp), r.x, r.y, r.id});
}
void PositionPlots::on(const recording::records::ListFused& r) {
  using recording::records::Disposition;
  if (r.disposition == Disposition::kFused || r.disposition == Disposition::kFusedLate)
    fused_.push_back({r.step, r.id, r.disposition == Disposition::kFusedLate, true_seconds(r.measured, r.stamp)});
}
void PositionPlots::on(const recording::records::FusionStep& r) {
  steps_.push_back(
      {r.step, r.stamp.true_time.ns != 0 ? seconds(r.stamp.true_time) : true_seconds(r.stamp.global, r.stamp)});
}
void PositionPlots::on(const recording::records::TrackState& r) {
  if (!r.predicted_for_image)
    tracks_.push_back({{true_seconds(r.valid_at, r.stamp), r.state[0], r.state[1], {}}, r.step});
}
void PositionPlots::on(const recording::records::ImageWritten& r) {
  Image& image = images_.emplace_back(Image{r.sequence, true_seconds(r.stamp.global, r.stamp), {}});
  for (const recording::records::ImageObject& o : r.objects)
    image.objects.push_back({true_seconds(r.valid_at, r.stamp), o.x, o.y, {}});
}
void PositionPlots::on(const recording::records::FeatureUsed& r) {
  if (!r.stale) uses_.push_back({r.image_sequence, true_seconds(r.stamp.global, r.stamp)});
}
void PositionPlots::on(const recording::records::ReferenceFix& r) {
  if (r.object == chosen())
    fixes_.push_back(
        {r.measured_true.ns != 0 ? seconds(r.measured_true) : static_cast<double>(r.measured.ns) * 1e-9, r.x, r.y, {}});
}
void PositionPlots::on(const recording::records::TruthState& r) {
  // Several nodes may have recorded the same instant.
  std::vector<Sample>& truth = truths_[r.object];
  if (truth.empty() || truth.back().t != seconds(r.at)) truth.push_back({seconds(r.at), r.x, r.y, {}});
}

std::vector<PositionPlots::Sample> PositionPlots::truth_of_chosen() const {
  const auto found = truths_.find(chosen());
  return found == truths_.end() ? std::vector<Sample>{} : found->second;
}

std::vector<ObjectId> PositionPlots::objects() const {
  std::vector<ObjectId> objects;
  for (const auto& [object, samples] : truths_) objects.push_back(object);
  return objects;
}

bool PositionPlots::inside(double t) const {
  return (!options_.from || t >= seconds(*options_.from)) && (!options_.to || t <= seconds(*options_.to));
}

}  // namespace ttf::report::plots
