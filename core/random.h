// Counter-based random streams: a draw is a pure function of its entity, its purpose and its position.
//
// Generator: Philox4x32-10 (Salmon, Moraes, Dror, Shaw: "Parallel random numbers: as easy as 1, 2, 3", SC 2011).
// The 64-bit key is the drive's seed; the 128-bit counter is
//   word 0  block within the stream        word 2  entity (16 bits) and purpose (16 bits)
//   word 1  index (which measurement, ...) word 3  replication
// Streams therefore never overlap, and the draws of one entity do not depend on those of another. Paradigms
// compared on the same seed see the same noise.
#pragma once

#include <array>
#include <cstdint>

namespace ttf {

// The purpose of a stream. The values are part of every golden drive: append only.
enum class Purpose : std::uint16_t {
  kTrajectory = 1,
  kSensorNoise = 2,
  kSensorMisses = 3,
  kClutter = 4,
  kReferenceNoise = 5,
  kClockDrift = 6,
  kClockPhase = 7,
  kSensorPhase = 8,
  kExecutionTime = 9,
  kTest = 10,
  kFault = 11,
  kPowerOn = 12,
  kCampaign = 13,
  kArrival = 14,
  kSensorBias = 15,
  kSweep = 16,
  kOtherTraffic = 17,
  kObjectSize = 18,
  kSpeedAtStart = 19,
  kDetectionTime = 20,
  kSynthesis = 21,
  kPacking = 32,
};

struct StreamKey {
  std::uint64_t seed = 0;
  std::uint32_t replication = 0;
  Purpose purpose = Purpose::kTest;
  std::uint16_t entity = 0;  // node, sensor or object
  std::uint32_t index = 0;   // measurement, activation, ... ; 0 for a stream read sequentially
};

std::array<std::uint32_t, 4> philox4x32_10(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

// Reads one stream from its beginning. It is a value: a copy continues from the same position independently.
class RandomStream {
 public:
  // The 32-bit words that draws take from the stream, which consists of blocks of four. A pair serves two calls
  // of normal(): the second draws no words. A call of integer() takes kWordsOfUniform, and rarely more.
  static constexpr std::uint32_t kWordsOfABlock = 4, kWordsOfUniform = 2, kWordsOfANormalPair = 4;

  // Starts at block `first`. A stream with parts of known length can be cut into blocks, and each part read
  // alone.
  explicit RandomStream(StreamKey key, std::uint32_t first = 0) : key_(key), block_(first) {}

  std::uint64_t bits();
  double uniform();                                           // in [0, 1), 53 random bits
  double uniform(double low, double high);                    // in [low, high)
  std::int64_t integer(std::int64_t low, std::int64_t high);  // in [low, high], unbiased
  double normal();                                            // mean 0, variance 1 (Box-Muller, both values used)

 private:
  std::uint32_t word();

  StreamKey key_;
  std::uint32_t block_;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 4;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace ttf
