// The rows behind a drive's figures: the error of every object of an image when used, the filter's belief about
// it, and the ages of measurements. DriveMeasures has the means of the same errors and ages.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/image_uses.h"
#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

struct ErrorRow {
  TrueTime at{};
  ObjectId object{};
  std::array<double, 4> error{};  // x, y [m], vx, vy [m/s]: estimate minus truth
  // The filter's standard deviations of the same, and its normalised estimation error squared. The covariance
  // holds at the first use of an image only, so both are not a number at later uses.
  std::array<double, 4> sigma{};
  double nees = 0.0;
};

// The mean NEES over consecutive instants. It lies in the band with 95 % if the samples are independent and the
// model is right.
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

class DriveRows final : public ImageUses {
 public:
  explicit DriveRows(double gate_m = kGate_m) : ImageUses(gate_m) {}
  void finish() { finish_use(); }  // judges the last use; call it once, at the end

  const std::vector<ErrorRow>& errors() const { return errors_; }
  // The number of ages in [n, n + 1) bins of kAgeBin, by n.
  using Histogram = std::map<std::int64_t, std::uint64_t>;
  const std::map<std::pair<AgeOf, SensorId>, Histogram>& ages() const { return ages_; }
  std::optional<ObjectId> referenced() const { return referenced_; }  // the object of the reference

  using ImageUses::on;
  void on(const recording::records::ReferenceFix&) override;

 private:
  void fused(SensorId sensor, Duration age) override { add_age(AgeOf::kFused, sensor, age); }
  bool used(const recording::records::FeatureUsed&, std::span<const PlaneEstimate>,
            std::span<const SensorAge> ages) override;
  void judged(const JudgedUse& use) override;
  void add_age(AgeOf of, SensorId sensor, Duration age);

  std::vector<ErrorRow> errors_;
  std::map<std::pair<AgeOf, SensorId>, Histogram> ages_;
  std::optional<ObjectId> referenced_;
};

}  // namespace ttf::evaluation::accuracy
