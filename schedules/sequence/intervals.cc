#include "schedules/sequence/intervals.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ttf::schedules::sequence {
namespace {

// The sums of one order. Buffers are kept, since many orders are tried.
class Sums {
 public:
  Sums(int sensors, Duration frame) : frame_(frame), of_(static_cast<std::size_t>(sensors)) {}

  // Returns the mean over the sensors of their intervals' variances.
  double mean_variance(const Sequence& sequence, const DetectionTimes& times) {
    for (OfSensor& sensor : of_) sensor = {};
    Duration now{};
    for (const Detection& detection : sequence) {
      OfSensor& sensor = of_[static_cast<std::size_t>(detection.sensor)];
      if (sensor.count++ == 0)
        sensor.first = now;
      else
        sensor.add(now - sensor.last);
      sensor.last = now;
      now += times.of(detection);
    }
    double sum = 0.0;
    for (OfSensor& sensor : of_) {
      TTF_CHECK(sensor.count > 0, "a sensor has no detection");
      sensor.add(sensor.first + frame_ - sensor.last);
      sum += sensor.variance(frame_);
    }
    return sum / static_cast<double>(of_.size());
  }

  Intervals of(std::size_t sensor) const {
    return {of_[sensor].count, frame_.seconds() / of_[sensor].count, of_[sensor].variance(frame_)};
  }

 private:
  struct OfSensor {
    int count = 0;
    Duration first{}, last{};
    double squares = 0.0;  // [s^2]

    void add(Duration interval) { squares += interval.seconds() * interval.seconds(); }
    double variance(Duration frame) const {
      const double mean = frame.seconds() / count;
      const double difference = squares / count - mean * mean;
      // Equal intervals have no variance, but a rounding error.
      return difference > 1e-12 * mean * mean ? difference : 0.0;
    }
  };

  Duration frame_;
  std::vector<OfSensor> of_;
};

int sensors_of(const DetectionTimes& times) { return static_cast<int>(times.primary.size()); }

}  // namespace

double Intervals::deviation_s() const { return std::sqrt(variance); }

std::vector<Intervals> intervals(const Sequence& sequence, const DetectionTimes& times) {
  Sums sums(sensors_of(times), frame_time(sequence, times));
  sums.mean_variance(sequence, times);
  std::vector<Intervals> result;
  for (std::size_t sensor = 0; sensor < times.primary.size(); ++sensor) result.push_back(sums.of(sensor));
  return result;
}

double mean_variance(const Sequence& sequence, const DetectionTimes& times) {
  return Sums(sensors_of(times), frame_time(sequence, times)).mean_variance(sequence, times);
}

std::uint64_t orders(const Sequence& sequence, std::uint64_t limit) {
  // A multinomial coefficient, one kind of detection after the other: choose(places so far, how many of this kind).
  Sequence rest(sequence.begin() + (sequence.empty() ? 0 : 1), sequence.end());
  std::sort(rest.begin(), rest.end());
  std::uint64_t count = 1, same = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    same = i > 0 && rest[i] == rest[i - 1] ? same + 1 : 1;
    // The quotient is whole at every step: it is the number of orders of the detections so far.
    count = count * (i + 1) / same;
    if (count > limit) return limit + 1;
  }
  return count;
}

std::optional<Sequence> best_order(const Sequence& sequence, const DetectionTimes& times, std::uint64_t most_orders) {
  if (sequence.empty() || orders(sequence, most_orders) > most_orders) return std::nullopt;
  Sums sums(sensors_of(times), frame_time(sequence, times));
  Sequence best = sequence, tried = sequence;
  double least = sums.mean_variance(sequence, times);
  std::sort(tried.begin() + 1, tried.end());
  do {
    const double variance = sums.mean_variance(tried, times);
    if (variance < least - 1e-9 * least) {
      least = variance;
      best = tried;
    }
  } while (least > 0.0 && std::next_permutation(tried.begin() + 1, tried.end()));
  return best;
}

}  // namespace ttf::schedules::sequence
