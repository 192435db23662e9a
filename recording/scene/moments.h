// Gathers a drive's records into the moments of a scene: the truth of an instant, a sensor's list, an image, its use.
//
// Takes records in the order of MergedLogs::read(); call finish() at the end. Each moment comes once and whole, soon after
// its last record. Moments come in the order of their records; their own instants may differ from these by kNear.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/time.h"
#include "recording/records/records.h"
#include "recording/scene/instants.h"
#include "recording/scene/viewed.h"

namespace ttf::recording::scene {

// The observations of one list. Those whose position is not finite are left out.
struct SeenList {
  records::Stamp stamp;
  MeasurementId id;
  TrueTime measured{};
  std::vector<Point> points;
};

class Moments : public records::Sink {
 public:
  void finish();  // the last moments come

  using records::Sink::on;
  void on(const records::ObservationSeen&) final;
  void on(const records::ImageWritten&) final;
  void on(const records::FeatureUsed&) final;
  void on(const records::ReferenceFix&) final;
  void on(const records::TruthState&) final;
  void on(const records::EgoTruth&) final;
  void on(const records::OdometryTaken&) final;

 protected:
  // Returns the vehicle's state at the instant of truth(), while that is called; at the origin if the log has none.
  records::EgoTruth ego() const;
  // Returns the vehicle's motion as the fusion took it in last: an image's velocities are over ground. Absent in a drive
  // whose fusion reads no odometry: they are relative to the vehicle.
  const std::optional<OwnMotion>& own_motion() const { return own_; }

 private:
  // The true states of all objects at an instant, as the first node recorded them.
  virtual void truth(TrueTime at, std::span<const records::TruthState> states) = 0;
  virtual void list(const SeenList& list) = 0;
  virtual void odometry(SensorId) {}  // the fusion took in a sample of this sensor
  virtual void fix(TrueTime, const records::ReferenceFix&) {}
  virtual void image(TrueTime valid_at, const records::ImageWritten& image) = 0;
  virtual void use(TrueTime at, const records::FeatureUsed& use) = 0;
  // All moments of records before this instant have come.
  virtual void reached(TrueTime) {}

  void come_to(TrueTime at);
  void finish_truth();
  void finish_list();

  std::vector<records::TruthState> truth_;  // all have the same instant
  std::optional<records::EgoTruth> ego_;
  std::optional<OwnMotion> own_;
  std::optional<SeenList> list_;
};

}  // namespace ttf::recording::scene
