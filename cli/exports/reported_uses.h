// Reports the ages and the errors of a drive's used images, while its records are read.
#pragma once

#include <functional>
#include <span>
#include <utility>

#include "evaluation/accuracy/drive_rows.h"

namespace ttf::cli::exports {

class ReportedUses final : public evaluation::accuracy::ImageUses {
 public:
  using Use = recording::records::FeatureUsed;
  using Ages = std::span<const evaluation::accuracy::SensorAge>;
  using OnAges = std::function<void(const Use&, Ages)>;
  using OnErrors = std::function<void(const evaluation::accuracy::JudgedUse&)>;

  ReportedUses(OnAges on_ages, OnErrors on_errors)
      : ImageUses(evaluation::accuracy::kGate_m), on_ages_(std::move(on_ages)), on_errors_(std::move(on_errors)) {}
  void finish() { finish_use(); }  // judges the last use; call it once, at the end

 private:
  void fused(SensorId, Duration) override {}
  bool used(const Use& use, std::span<const evaluation::accuracy::PlaneEstimate>, Ages ages) override {
    if (!ages.empty()) on_ages_(use, ages);
    return !use.stale;
  }
  void judged(const evaluation::accuracy::JudgedUse& use) override { on_errors_(use); }

  OnAges on_ages_;
  OnErrors on_errors_;
};

}  // namespace ttf::cli::exports
