// What a drive's figures are drawn from, as rows: how wrong every object of an image was when that was used, how wrong
// the filter believed it to be, and how old measurements were.
//
// The same pairs, errors and ages as in DriveMeasures (evaluation/accuracy/drive_measures.h), one by one instead of
// their means: at the instants the feature service used an image, against the truth at that true time.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/closest_pairs.h"
#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

struct ErrorRow {
  TrueTime at{};
  ObjectId object{};
  std::array<double, 4> error{};  // x, y [m], vx, vy [m/s]: estimate less truth
  // The filter's standard deviations of the same, and its normalised estimation error squared; not a number where the
  // image was used again, as its covariance says nothing about then.
  std::array<double, 4> sigma{};
  double nees = 0.0;
};

// Consecutive instants taken together: the mean of their NEES, and the band it lies in with 95 % if samples are
// independent and the model is right.
struct NeesRow {
  double from_s = 0.0, to_s = 0.0;
  std::uint64_t samples = 0;
  double mean = 0.0, low = 0.0, high = 0.0;
};
std::vector<NeesRow> nees_rows(const std::vector<ErrorRow>& errors);

enum class AgeOf : std::uint8_t {
  kFused,
  kUsed
};  // a measurement when fused; its sensor's newest when an image is used
inline constexpr Duration kAgeBin = Duration::milliseconds(1);

class DriveRows final : public recording::records::Sink {
 public:
  explicit DriveRows(double gate_m = kGate_m) : gate_(gate_m) {}
  void finish();  // completes what waits for its truth; once, at the end

  const std::vector<ErrorRow>& errors() const { return errors_; }
  // How many ages are in [n, n + 1) bins of kAgeBin.
  using Histogram = std::map<std::int64_t, std::uint64_t>;
  const std::map<std::pair<AgeOf, SensorId>, Histogram>& ages() const { return ages_; }
  std::optional<ObjectId> referenced() const { return referenced_; }  // the object that a reference is of

  using recording::records::Sink::on;
  void on(const recording::records::ListFused&) override;
  void on(const recording::records::TrackState&) override;
  void on(const recording::records::ImageWritten&) override;
  void on(const recording::records::FeatureUsed&) override;
  void on(const recording::records::TruthState&) override;
  void on(const recording::records::ReferenceFix&) override;

 private:
  struct Predicted {
    std::array<double, 4> state;
    std::array<double, 16> covariance;
  };
  struct Image {
    std::uint32_t sequence = 0;
    std::vector<std::pair<SensorId, TrueTime>> newest;
    std::vector<Predicted> predicted;  // as its objects
  };
  struct Use {
    TrueTime at{};
    std::uint32_t image = 0;
    bool fresh = true;
    std::vector<std::array<double, 4>> objects;
  };
  const Image* image_of(std::uint32_t sequence) const;
  void judge();
  void add_age(AgeOf of, SensorId sensor, Duration age);

  double gate_;
  std::vector<ErrorRow> errors_;
  std::map<std::pair<AgeOf, SensorId>, Histogram> ages_;
  std::optional<ObjectId> referenced_;
  std::map<SensorId, std::pair<MeasurementId, TrueTime>> newest_fused_;
  std::vector<Predicted> predicted_;  // for the image that is being written
  std::deque<Image> images_;          // the last few
  std::optional<Use> pending_;
  std::vector<recording::records::TruthState> truth_;  // of one instant
};

}  // namespace ttf::evaluation::accuracy
