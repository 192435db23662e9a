// The uses of images in a drive, put together from its records: each with the age of what its image was made from, and
// with how wrong every object of it was, against the truth at that very time. DriveMeasures sums them up, and DriveRows
// lists them one by one.
//
// Records of a use do not come at once: an image's predictions are told before it, the truth of an instant before or
// behind the use. A use is judged when the next one comes, when the truth of its instant is complete, or at the end.
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
#include "evaluation/accuracy/closest_pairs.h"
#include "recording/records/records.h"

namespace ttf::evaluation::accuracy {

// The newest measurement of a sensor in an image, when that is used.
struct SensorAge {
  SensorId sensor{};
  Duration age{};
};

// What the filter believed of an object, predicted to the use with its full state and covariance, which the image
// rounds and shortens: standard deviations of x, y, vx, vy, and the normalised estimation error squared.
struct Belief {
  std::array<double, 4> sigma{};
  double nees = 0.0;
};
// An object of a used image that is one of the truth, too.
struct UsedObject {
  ObjectId object{};
  std::array<double, 4> error{};  // x, y [m], vx, vy [m/s]: estimate less truth
  std::optional<Belief> belief;   // none where the image was used before: it says nothing about now
};
struct JudgedUse {
  TrueTime at{};
  std::size_t missed = 0;    // true objects without an image within the gate
  std::size_t spurious = 0;  // image objects without a true object within the gate
  std::vector<UsedObject> objects;
};

class ImageUses : public recording::records::Sink {
 public:
  // Image and truth further apart than `gate_m` do not belong together.
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
  // An image is used, or refused as stale: then nothing has an age. False: it is not to be judged.
  virtual bool used(const recording::records::FeatureUsed& use, std::span<const PlaneEstimate> objects,
                    std::span<const SensorAge> ages) = 0;
  virtual void judged(const JudgedUse& use) = 0;

  // Judges the use that waits for its truth. To be called at the end.
  void finish_use();

 private:
  // x, y, vx, vy.
  struct Predicted {
    std::array<double, 4> state;
    std::array<double, 16> covariance;
  };
  // A measurement of a sensor, known by its number as long as the sensor does not count anew.
  struct Fused {
    MeasurementId id;
    TrueTime measured{};
  };
  // What an image shows and was made from; its objects and predictions are in the same order.
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
  };
  const Image* image_of(std::uint32_t sequence) const;
  void judge(const Use& use);

  double gate_;
  std::map<SensorId, Fused> newest_fused_;
  std::vector<Predicted> predicted_;  // for the image that is being written
  std::deque<Image> images_;          // as they were written, the last few
  std::optional<Use> pending_;
  std::vector<recording::records::TruthState> truth_;  // of one instant
};

}  // namespace ttf::evaluation::accuracy
