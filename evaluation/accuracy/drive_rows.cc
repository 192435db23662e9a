#include "evaluation/accuracy/drive_rows.h"

#include <cmath>
#include <limits>

#include "fusion/metrics/chi_square.h"

namespace ttf::evaluation::accuracy {
namespace {

constexpr double kNoRow = std::numeric_limits<double>::quiet_NaN();
constexpr double kNeesWindows = 25;

// Returns 1, 2 or 5 times a power of ten, at least `least`.
double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least) return step * power;
  return 10.0 * power;
}

}  // namespace

std::vector<NeesRow> nees_rows(const std::vector<ErrorRow>& errors) {
  std::vector<NeesRow> rows;
  if (errors.empty()) return rows;
  const double begin = static_cast<double>(errors.front().at.ns) * 1e-9,
               end = static_cast<double>(errors.back().at.ns) * 1e-9;
  const double step = end > begin ? round_step((end - begin) / kNeesWindows) : 1.0;
  for (const ErrorRow& error : errors) {
    if (std::isnan(error.nees)) continue;
    const double from = std::floor(static_cast<double>(error.at.ns) * 1e-9 / step) * step;
    if (rows.empty() || rows.back().from_s != from) rows.push_back({from, from + step, 0, 0.0, 0.0, 0.0});
    ++rows.back().samples;
    rows.back().mean += error.nees;
  }
  for (NeesRow& row : rows) {
    const auto n = static_cast<double>(row.samples);
    row.mean /= n;
    row.low = fusion::metrics::chi_square_quantile(0.025, 4.0 * n) / n;
    row.high = fusion::metrics::chi_square_quantile(0.975, 4.0 * n) / n;
  }
  return rows;
}

void DriveRows::add_age(AgeOf of, SensorId sensor, Duration age) {
  std::int64_t bin = age.ns / kAgeBin.ns;
  if (age.ns < 0 && age.ns % kAgeBin.ns != 0) --bin;
  ++ages_[{of, sensor}][bin];
}

bool DriveRows::used(const recording::records::FeatureUsed&, std::span<const PlaneEstimate>,
                     std::span<const SensorAge> ages) {
  for (const SensorAge& newest : ages) add_age(AgeOf::kUsed, newest.sensor, newest.age);
  return true;
}

void DriveRows::judged(const JudgedUse& use) {
  for (const UsedObject& object : use.objects) {
    ErrorRow& row = errors_.emplace_back(ErrorRow{use.at, object.object, object.error, {}, kNoRow});
    row.sigma.fill(kNoRow);
    if (!object.belief) continue;
    row.sigma = object.belief->sigma;
    row.nees = object.belief->nees;
  }
}

void DriveRows::on(const recording::records::ReferenceFix& fix) {
  if (!referenced_) referenced_ = fix.object;
}

}  // namespace ttf::evaluation::accuracy
