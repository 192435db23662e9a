// The paper's figures 5 to 8 from the records of a drive: the object's x and y over time, and y over x. They show DGPS
// fixes of the reference (circles), the observations of each sensor (its marker: report/drawing/names.h), and the fused
// image (squares; grey if unused). They also show the truth (thin line), numbered fusion instants (boxed), and arrows
// from each laser measurement to the fusion instant that fused it. Several objects are shown by their truths and tracks
// (report/plots/crowd_panel.h).
//
// Axes follow ISO 8855 (x forward, y left, metres), and the pictures say so. Times are true times in seconds.
// The stamp of its record converts a global time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "recording/records/records.h"
#include "report/drawing/names.h"

namespace ttf::report::plots {

struct PositionOptions {
  std::string title{};
  std::optional<TrueTime> from{}, to{};  // the whole drive if absent
  // The object shown, by the observation of each list and the track of each image nearest to it within the gate.
  // The object's place at that time is its truth, or else its reference. Without both, everything is shown.
  // Absent: all objects if there are several (Crowd), else object 0.
  std::optional<ObjectId> object{};
  double gate_m = 6.0;
};

enum class PositionView : std::uint8_t { kXOverTime, kYOverTime, kPlane };

class PositionPlots : public recording::records::Sink {
 public:
  PositionPlots(drawing::Names names, PositionOptions options);

  using recording::records::Sink::on;  // kinds of record that are not shown
  void on(const recording::records::ObservationSeen& r) override;
  void on(const recording::records::ListFused& r) override;
  void on(const recording::records::FusionStep& r) override;
  void on(const recording::records::TrackState& r) override;
  void on(const recording::records::ImageWritten& r) override;
  void on(const recording::records::FeatureUsed& r) override;
  void on(const recording::records::ReferenceFix& r) override;
  void on(const recording::records::TruthState& r) override;

  // x above y over a common time axis, and y over x. Both throw InputError if paper is too narrow.
  std::string over_time_svg(const drawing::Sheet& sheet = {}) const;
  std::string plane_svg(const drawing::Sheet& sheet = {}) const;

  // The data of a panel, selected and in the time window; also for tests and tables.
  struct Sample {
    double t = 0, x = 0, y = 0;  // s, m, m
    MeasurementId id{};          // the observation's
  };
  struct Integration {  // a measurement and the fusion instant that fused it
    Sample measured, fused;
    bool late = false;  // out of sequence
  };
  struct Instant {  // a fusion instant that fused at least one list
    std::uint32_t step = 0;
    Sample at;
    bool laser = false;  // at least one fused list is a laser's
  };
  struct Selection {
    std::vector<Sample> truth, reference;
    std::vector<Sample> fusion;                     // used images, at the instants they were predicted to
    std::vector<Sample> unused;                     // unused images, or images refused as too old
    std::vector<std::vector<Sample>> observations;  // per sensor
    std::vector<Integration> laser_arrows;
    std::vector<Instant> instants;
    bool empty() const;
  };
  Selection select() const;

  // The data of a panel of several objects. Each track of an image belongs to the nearest true object within the gate.
  struct Crowd {
    static constexpr std::size_t kMostTrails = 36;  // more objects are drawn as a density
    struct Trail {
      ObjectId object{};
      std::vector<Sample> truth, track;  // by time
      std::vector<bool> missed;          // by sample of the truth: the newest image has no track of the object
    };
    std::vector<Trail> trails;   // by object; in a density without tracks
    std::vector<Sample> tracks;  // in a density all, else those without an object
    bool dense() const { return trails.size() > kMostTrails; }
  };
  std::vector<ObjectId> objects() const;  // those with truth, in the whole log
  bool several() const;                   // no object is chosen, and more than one true object is in the time window
  Crowd crowd() const;
  const drawing::Names& names() const { return names_; }
  const PositionOptions& options() const { return options_; }

 private:
  class Selector;
  ObjectId chosen() const { return options_.object.value_or(ObjectId{0}); }
  std::vector<Sample> truth_of_chosen() const;
  bool inside(double t) const;  // the time window
  static double seconds(TrueTime t) { return static_cast<double>(t.ns) * 1e-9; }
  struct Step {
    std::uint32_t step;
    double t;
  };
  struct FusedList {
    std::uint32_t step;
    MeasurementId id;
    bool late;
    double measured;
  };
  struct Image {
    std::uint32_t sequence;
    double written;  // s
    std::vector<Sample> objects;
  };
  struct Use {
    std::uint32_t image;
    double t;  // s
  };
  struct Positioned {
    Sample sample;
    std::uint32_t step;
  };

  drawing::Names names_;
  PositionOptions options_;
  std::map<ObjectId, std::vector<Sample>> truths_;
  std::vector<Sample> fixes_, observations_;  // fixes only of the chosen object
  std::vector<Image> images_;
  std::vector<Use> uses_;
  std::vector<Positioned> tracks_;
  std::vector<Step> steps_;
  std::vector<FusedList> fused_;
};

// Draws one view of several drives as panels with the same axes, side by side; on narrow paper also below each other.
// `titles` has one entry per panel.
std::string comparison_svg(std::span<const PositionPlots* const> plots, std::span<const std::string> titles,
                           PositionView view = PositionView::kPlane, std::string_view title = {},
                           const drawing::Sheet& sheet = {});

}  // namespace ttf::report::plots
