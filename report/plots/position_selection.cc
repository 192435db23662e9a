// Selects the data of a position plot: the chosen object's, in the time window.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "report/plots/position_plot.h"
#include "report/plots/position_samples.h"

namespace ttf::report::plots {
namespace {

constexpr double kLongestUse = 1.0;  // s from an image to its last use; older images are refused

}  // namespace

class PositionPlots::Selector {
 public:
  explicit Selector(const PositionPlots& plots)
      : plots_(plots), truth_(by_time(plots.truth_of_chosen())), fixes_(by_time(plots.fixes_)) {
    for (const Positioned& p : plots.tracks_) tracks_[p.step].push_back(p.sample);
    for (const Step& s : plots.steps_) step_times_[s.step] = s.t;
  }

  Selection selection() {
    std::ranges::copy_if(truth_, std::back_inserter(out_.truth), [&](const Sample& s) { return inside(s.t); });
    std::ranges::copy_if(fixes_, std::back_inserter(out_.reference), [&](const Sample& s) { return inside(s.t); });
    choose_observations();
    choose_images();
    find_instants();
    return std::move(out_);
  }

 private:
  bool inside(double t) const { return plots_.inside(t); }

  // The truth gives the chosen object's place, or else the reference. Without both, everything in the time
  // window is shown.
  bool shows_all() const { return truth_.empty() && fixes_.empty(); }
  std::optional<Sample> object_at(double t) const {
    return truth_.empty() ? interpolate(fixes_, t, 0.5) : interpolate(truth_, t, 0.1);
  }

  // Returns the distance to the chosen object; no value outside the gate or the time window.
  std::optional<double> distance(const Sample& s) const {
    if (!inside(s.t) || !std::isfinite(s.x) || !std::isfinite(s.y)) return std::nullopt;
    if (shows_all()) return 0.0;
    const auto at = object_at(s.t);
    if (!at) return std::nullopt;
    const double d = std::hypot(s.x - at->x, s.y - at->y);
    return d <= plots_.options_.gate_m ? std::optional(d) : std::nullopt;
  }

  // Returns the candidate nearest to the object at one instant, or all candidates if everything is shown.
  std::vector<Sample> shown_of(const std::vector<Sample>& candidates) const {
    std::vector<Sample> shown;
    double least = 0;
    for (const Sample& s : candidates) {
      const auto d = distance(s);
      if (!d) continue;
      if (shows_all() || shown.empty())
        shown.push_back(s), least = *d;
      else if (*d < least)
        shown.front() = s, least = *d;
    }
    return shown;
  }

  // Chooses the nearest observation of each list. Id and time identify a list, because a restarted sensor numbers anew.
  void choose_observations() {
    struct Nearest {
      double distance;
      std::size_t at;  // index in chosen_
    };
    std::map<std::pair<MeasurementId, std::int64_t>, Nearest> lists;
    for (const Sample& s : plots_.observations_) {
      const auto d = distance(s);
      if (!d) continue;
      const auto [list, first] = lists.try_emplace({s.id, std::llround(s.t * 1e6)}, Nearest{*d, chosen_.size()});
      Nearest& nearest = list->second;
      if (first || shows_all())
        chosen_.push_back(s);
      else if (*d < nearest.distance)
        nearest.distance = *d, chosen_[nearest.at] = s;
    }
    for (const Sample& s : chosen_) {
      out_.observations.resize(std::max(out_.observations.size(), index_of(s.id.sensor) + 1));
      out_.observations[index_of(s.id.sensor)].push_back(s);
    }
  }

  // A restarted fusion node numbers its images anew, so a use belongs to an image from shortly before it.
  bool is_used(const Image& image) const {
    return std::ranges::any_of(plots_.uses_, [&](const Use& use) {
      return use.image == image.sequence && use.t >= image.written && use.t < image.written + kLongestUse;
    });
  }

  void choose_images() {
    for (const Image& image : plots_.images_) {
      std::vector<Sample>& of_kind = is_used(image) ? out_.fusion : out_.unused;
      for (const Sample& s : shown_of(image.objects)) {
        of_kind.push_back(s);
        images_.push_back(s);
      }
    }
    for (auto* list : {&out_.fusion, &out_.unused, &images_}) std::ranges::stable_sort(*list, earlier);
  }

  const Sample* measured(const FusedList& list) const {
    const Sample* newest = nullptr;
    for (const Sample& s : chosen_)
      if (s.id == list.id && std::abs(s.t - list.measured) < 1e-3) newest = &s;
    return newest;
  }

  // Returns the place of the fused result at a fusion instant: the nearest track, else the image, else the observation.
  std::optional<Sample> result_at(std::uint32_t step, double t, const Sample* observation) const {
    if (const auto tracks = tracks_.find(step); tracks != tracks_.end())
      if (const auto nearest = shown_of(tracks->second); !nearest.empty()) return nearest.front();
    if (const auto image = interpolate(images_, t, 0.05)) return image;
    return observation != nullptr ? std::optional(*observation) : std::nullopt;
  }

  void find_instants() {
    std::map<std::uint32_t, Instant> instants;
    for (const FusedList& f : plots_.fused_) {
      const auto t = step_times_.find(f.step);
      if (t == step_times_.end() || !inside(t->second)) continue;
      const Sample* observation = measured(f);
      std::optional<Sample> at = result_at(f.step, t->second, observation);
      if (!at) continue;
      at->t = t->second;
      const bool laser = look_of(plots_.names_, f.id.sensor) == drawing::SensorLook::kLaser;
      instants.try_emplace(f.step, Instant{f.step, *at, false}).first->second.laser |= laser;
      if (laser && observation != nullptr) out_.laser_arrows.push_back({*observation, *at, f.late});
    }
    for (const auto& [step, instant] : instants) out_.instants.push_back(instant);
  }

  const PositionPlots& plots_;
  std::vector<Sample> truth_, fixes_;                    // by time
  std::map<std::uint32_t, std::vector<Sample>> tracks_;  // by step
  std::map<std::uint32_t, double> step_times_;
  std::vector<Sample> chosen_;  // observations
  std::vector<Sample> images_;  // used or not, by time
  Selection out_;
};

bool PositionPlots::Selection::empty() const {
  return truth.empty() && reference.empty() && fusion.empty() && unused.empty() &&
         std::ranges::all_of(observations, [](const auto& list) { return list.empty(); });
}

PositionPlots::Selection PositionPlots::select() const { return Selector(*this).selection(); }

}  // namespace ttf::report::plots
