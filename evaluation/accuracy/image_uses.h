// Finds the uses of images in a drive's records, with the ages of their measurements and the errors of their
// objects against the truth at that time. DriveMeasures sums them up; DriveRows lists them one by one. Only objects that are
// in view count (evaluation/accuracy/judged_objects.h).
//
// The truth of an instant may precede or follow the use. A use is judged when the next one comes, when the
// truth of its instant is complete, or at the end.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/accuracy/box.h"
#include "evaluation/accuracy/plane.h"
#include "fusion/metrics/identity.h"
#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

// The age of a sensor's newest measurement in an image, when the image is used.
struct SensorAge {
  SensorId sensor{};
  Duration age{};
};

// Errors of an image's object against a true one: estimate minus truth, the heading in -pi..pi. By Quantity.
enum class Quantity : std::uint8_t { kHeading, kSpeed, kAcceleration, kLength, kWidth };
inline constexpr std::size_t kQuantities = 5;
template <class T> using ByQuantity = std::array<T, kQuantities>;

// The filter's belief about an object: standard deviations of x, y, vx, vy, and the normalised estimation error
// squared, of all four and of two each. It is predicted to the use with the full state and covariance, which the image
// rounds and shortens. Each quantity beside the state has its own square. It is not a number for one that the motion
// model has not, and in old logs.
struct Belief {
  std::array<double, 4> sigma{};
  double nees = 0.0, position_nees = 0.0, velocity_nees = 0.0;
  ByQuantity<double> quantity_nees{};
};
// An object of a used image that matches a true object. Errors are estimate minus truth.
struct UsedObject {
  ObjectId object{};
  std::array<double, 4> error{};  // x, y [m], vx, vy [m/s]
  BoxError box;
  double speed_mps = 0.0, acceleration_mps2 = 0.0;  // along the heading
  std::optional<Belief> belief;                     // absent if the image was used before: the belief held then
};
struct JudgedUse {
  TrueTime at{};
  std::size_t missed = 0;    // true objects without an image's object within the gate
  std::size_t spurious = 0;  // an image's objects without a true object within the gate
  std::size_t out_of_view = 0,
              shown_out_of_view = 0;  // true objects that are left out, and the image's objects on them
  std::vector<UsedObject> objects;
  // All that count of the true objects and of the image, named by ObjectId and TrackId.
  std::vector<fusion::metrics::Named> truths, shown;
};

class ImageUses : public recording::records::Sink {
 public:
  // `gate_m`: the largest distance of matched objects.
  explicit ImageUses(double gate_m) : gate_(gate_m) {}

  using recording::records::Sink::on;
  void on(const recording::records::ListFused&) override;
  void on(const recording::records::TrackState&) override;
  void on(const recording::records::ImageWritten&) override;
  void on(const recording::records::FeatureUsed&) override;
  void on(const recording::records::TruthState&) override;

 protected:
  // A measurement of this age was fused, in time or late.
  virtual void fused(SensorId sensor, Duration age) = 0;
  // An image is used, or refused as stale; then `ages` is empty. Returns false if the use is not to be judged.
  virtual bool used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
                    std::span<const SensorAge> ages) = 0;
  virtual void judged(const JudgedUse& use) = 0;

  // Judges the use that waits for its truth. Call it at the end.
  void finish_use();
  // Returns whether the log has the image; otherwise its measurements are unknown, and a use of it has no ages.
  bool has_image(std::uint32_t sequence) const { return image_of(sequence) != nullptr; }

 private:
  // x, y, vx, vy.
  struct Predicted {
    std::array<double, 4> state;
    std::array<double, 16> covariance;
    std::optional<recording::records::BelievedBox> box;
  };
  // A measurement, known by its number until the sensor restarts and counts anew.
  struct Fused {
    MeasurementId id;
    TrueTime measured{};
  };
  // An image's number and the measurements in it; its predictions are in the order of its objects.
  struct Image {
    std::uint32_t sequence = 0;
    std::vector<Fused> newest;
    std::vector<Predicted> predicted;
  };
  struct Use {
    TrueTime at{};
    std::uint32_t image = 0;
    bool fresh = true;
    std::vector<PlaneEstimate> objects;
    std::vector<recording::records::ImageObject> images;  // the same
  };
  const Image* image_of(std::uint32_t sequence) const;
  void judge(const Use& use);

  double gate_;
  std::map<SensorId, Fused> newest_fused_;
  std::vector<Predicted> predicted_;  // for the next image
  std::deque<Image> images_;          // the last few, in the order of writing
  std::optional<Use> pending_;
  std::vector<recording::records::TruthState> truth_;  // at one instant
};

}  // namespace ttf::evaluation::accuracy
