#include "report/plots/position_plot.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ttf::report::plots {
namespace {

double seconds(TrueTime t) { return static_cast<double>(t.ns) * 1e-9; }

// True time of a global instant, as the clock that stamped the record shows. A recording without true time
// (all zero) keeps global time.
double seconds(GlobalTime t, const recording::records::Stamp& stamp) {
  // In doubles: exact for runs of up to 100 days, and without overflow for whatever a damaged log says.
  const auto ns = [](std::int64_t count) { return static_cast<double>(count); };
  const double offset = stamp.true_time.ns != 0 ? ns(stamp.true_time.ns) - ns(stamp.global.ns) : 0.0;
  return (ns(t.ns) + offset) * 1e-9;
}

constexpr double kLongestUse = 1.0;  // s from an image to its last use; older ones are refused

bool earlier(const PositionPlots::Sample& a, const PositionPlots::Sample& b) { return a.t < b.t; }

// Linear interpolation in samples ordered by time; nothing outside them (by more than `slack`).
std::optional<PositionPlots::Sample> interpolate(const std::vector<PositionPlots::Sample>& samples, double t,
                                                 double slack) {
  if (samples.empty() || t < samples.front().t - slack || t > samples.back().t + slack) return std::nullopt;
  const auto after = std::ranges::lower_bound(samples, t, {}, &PositionPlots::Sample::t);
  if (after == samples.begin()) return samples.front();
  if (after == samples.end()) return samples.back();
  const PositionPlots::Sample &a = *(after - 1), &b = *after;
  const double f = b.t > a.t ? (t - a.t) / (b.t - a.t) : 0;
  return PositionPlots::Sample{t, a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), {}};
}

}  // namespace

PositionPlots::PositionPlots(drawing::Names names, PositionOptions options)
    : names_(std::move(names)), options_(std::move(options)) {}

void PositionPlots::on(const recording::records::ObservationSeen& r) {
  observations_.push_back({seconds(r.measured, r.stamp), r.x, r.y, r.id});
}
void PositionPlots::on(const recording::records::ListFused& r) {
  using recording::records::Disposition;
  if (r.disposition == Disposition::kFused || r.disposition == Disposition::kFusedLate)
    fused_.push_back({r.step, r.id, r.disposition == Disposition::kFusedLate, seconds(r.measured, r.stamp)});
}
void PositionPlots::on(const recording::records::FusionStep& r) {
  steps_.push_back({r.step, r.stamp.true_time.ns != 0 ? seconds(r.stamp.true_time) : seconds(r.stamp.global, r.stamp)});
}
void PositionPlots::on(const recording::records::TrackState& r) {
  if (!r.predicted_for_image) tracks_.push_back({{seconds(r.valid_at, r.stamp), r.state[0], r.state[1], {}}, r.step});
}
void PositionPlots::on(const recording::records::ImageWritten& r) {
  Image& image = images_.emplace_back(Image{r.sequence, seconds(r.stamp.global, r.stamp), {}});
  for (const recording::records::ImageObject& o : r.objects)
    image.objects.push_back({seconds(r.valid_at, r.stamp), o.x, o.y, {}});
}
void PositionPlots::on(const recording::records::FeatureUsed& r) {
  if (!r.stale) uses_.push_back({r.image_sequence, seconds(r.stamp.global, r.stamp)});
}
// A fusion node that restarts counts its images anew: a use belongs to an image of just before.
bool PositionPlots::is_used(const Image& image) const {
  return std::ranges::any_of(uses_, [&](const Use& use) {
    return use.image == image.sequence && use.t >= image.written && use.t < image.written + kLongestUse;
  });
}
void PositionPlots::on(const recording::records::ReferenceFix& r) {
  if (r.object == options_.object)
    fixes_.push_back(
        {r.measured_true.ns != 0 ? seconds(r.measured_true) : static_cast<double>(r.measured.ns) * 1e-9, r.x, r.y, {}});
}
void PositionPlots::on(const recording::records::TruthState& r) {
  // Several nodes may have recorded it at one instant.
  if (r.object != options_.object || (!truth_.empty() && truth_.back().t == seconds(r.at))) return;
  truth_.push_back({seconds(r.at), r.x, r.y, {}});
}

bool PositionPlots::Selection::empty() const {
  return truth.empty() && reference.empty() && fusion.empty() && unused.empty() &&
         std::ranges::all_of(observations, [](const auto& list) { return list.empty(); });
}

PositionPlots::Selection PositionPlots::select() const {
  // Records arrive in the order of a log, which may be by process: time decides here.
  std::vector<Sample> truth = truth_, fixes = fixes_;
  std::ranges::stable_sort(truth, earlier);
  std::ranges::stable_sort(fixes, earlier);
  const std::vector<Sample>& guide = truth.empty() ? fixes : truth;
  const double slack = truth.empty() ? 0.5 : 0.1;  // s beyond the ends of the guide
  const auto inside = [&](double t) {
    return (!options_.from || t >= seconds(*options_.from)) && (!options_.to || t <= seconds(*options_.to));
  };
  // Distance to the chosen object; nothing if it is another object or out of the window.
  const auto distance = [&](const Sample& s) -> std::optional<double> {
    if (!inside(s.t) || !std::isfinite(s.x) || !std::isfinite(s.y)) return std::nullopt;
    if (guide.empty()) return 0.0;
    const auto at = interpolate(guide, s.t, slack);
    if (!at) return std::nullopt;
    const double d = std::hypot(s.x - at->x, s.y - at->y);
    return d <= options_.gate_m ? std::optional(d) : std::nullopt;
  };
  const bool all = guide.empty();
  Selection out;
  for (const Sample& s : truth)
    if (inside(s.t)) out.truth.push_back(s);
  for (const Sample& s : fixes)
    if (inside(s.t)) out.reference.push_back(s);

  // Observations: the nearest of each list. A list is one measurement: id and time (a wire counter wraps).
  std::map<std::pair<MeasurementId, std::int64_t>, std::pair<double, std::size_t>> best;
  std::vector<Sample> chosen;
  for (const Sample& s : observations_) {
    const auto d = distance(s);
    if (!d) continue;
    const std::int64_t time_us = std::llround(s.t * 1e6);
    const auto [entry, first] = best.try_emplace({s.id, time_us}, *d, chosen.size());
    if (first || all)
      chosen.push_back(s);
    else if (*d < entry->second.first)
      entry->second.first = *d, chosen[entry->second.second] = s;
  }
  for (const Sample& s : chosen) {
    out.observations.resize(std::max(out.observations.size(), index_of(s.id.sensor) + 1));
    out.observations[index_of(s.id.sensor)].push_back(s);
  }
  const auto add_nearest = [&](const std::vector<Sample>& candidates, std::vector<Sample>& to) {
    const Sample* nearest = nullptr;
    double nearest_distance = 0;
    for (const Sample& s : candidates) {
      const auto d = distance(s);
      if (!d) continue;
      if (all)
        to.push_back(s);
      else if (nearest == nullptr || *d < nearest_distance)
        nearest = &s, nearest_distance = *d;
    }
    if (nearest != nullptr) to.push_back(*nearest);
  };
  std::vector<Sample> images;
  for (const Image& image : images_) {
    std::vector<Sample>& of_kind = is_used(image) ? out.fusion : out.unused;
    const auto before = static_cast<std::ptrdiff_t>(of_kind.size());
    add_nearest(image.objects, of_kind);
    images.insert(images.end(), of_kind.begin() + before, of_kind.end());
  }
  for (auto* list : {&out.fusion, &out.unused, &images}) std::ranges::stable_sort(*list, earlier);

  // Where the fused result was at each step: the nearest track, else the image, else the observation itself.
  std::map<std::uint32_t, std::vector<Sample>> tracks;
  for (const Positioned& p : tracks_) tracks[p.step].push_back(p.sample);
  std::map<std::uint32_t, double> step_time;
  for (const Step& s : steps_) step_time[s.step] = s.t;
  std::map<std::uint32_t, Instant> instants;
  for (const FusedList& f : fused_) {
    const auto t = step_time.find(f.step);
    if (t == step_time.end() || !inside(t->second)) continue;
    const bool laser = drawing::look_of(names_.sensor(f.id.sensor)) == drawing::SensorLook::kLaser;
    const Sample* measured = nullptr;
    for (const Sample& s : chosen)
      if (s.id == f.id && std::abs(s.t - f.measured) < 1e-3) measured = &s;
    std::vector<Sample> at_step;
    if (const auto it = tracks.find(f.step); it != tracks.end()) add_nearest(it->second, at_step);
    std::optional<Sample> at = at_step.empty() ? interpolate(images, t->second, 0.05) : std::optional(at_step.front());
    if (!at && measured != nullptr) at = *measured;
    if (!at) continue;
    at->t = t->second;
    Instant& instant = instants.try_emplace(f.step, Instant{f.step, *at, false}).first->second;
    instant.laser |= laser;
    if (laser && measured != nullptr) out.laser_arrows.push_back({*measured, *at, f.late});
  }
  for (const auto& [step, instant] : instants) out.instants.push_back(instant);
  return out;
}

}  // namespace ttf::report::plots
