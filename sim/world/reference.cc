#include "sim/world/reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace ttf::sim::world {
namespace {

// Streams of one fix, of the excursion that may begin at it, and of the alignment before the drive.
constexpr std::uint16_t kFixEntity = 0, kExcursionEntity = 1, kAlignmentEntity = 2;

}  // namespace

ReferenceConfig load_reference(YamlMap& yaml) {
  ReferenceConfig c;
  c.period = yaml.duration_or("period", c.period, {Duration::milliseconds(1), Duration::milliseconds(10'000)});
  c.latency = yaml.duration_or("latency", c.latency, {Duration{}, Duration::milliseconds(10'000)});
  c.sigma_m = yaml.number_or("sigma", c.sigma_m, {0.0, 20.0}, "m");
  c.velocity_sigma_mps = yaml.number_or("velocity_sigma", c.velocity_sigma_mps, {0.0, 5.0}, "m/s");
  c.excursion_probability = yaml.number_or("excursion_probability", c.excursion_probability, {0.0, 1.0});
  c.excursion_m = yaml.number_or("excursion", c.excursion_m, {0.0, 50.0}, "m");
  c.excursion_fixes = static_cast<int>(yaml.integer_or("excursion_fixes", c.excursion_fixes, {1, 100}));
  c.alignment_baseline_m = yaml.number_or("alignment_baseline", c.alignment_baseline_m, {1.0, 10'000.0}, "m");
  return c;
}

Reference::Reference(const ReferenceConfig& config, const WorldConfig& world, std::uint64_t seed,
                     std::uint32_t replication)
    : config_(config), seed_(seed), replication_(replication) {
  for (std::size_t o = 0; o < world.objects.size(); ++o)
    if (world.objects[o].reference) {
      object_ = static_cast<ObjectId>(o);
      break;
    }
  RandomStream alignment({seed, replication, Purpose::kReferenceNoise, kAlignmentEntity, 0});
  const double first = config.sigma_m * alignment.normal(), second = config.sigma_m * alignment.normal();
  alignment_ = std::atan2(second - first, config.alignment_baseline_m);
}

Fix Reference::fix(std::uint32_t index, const World& world) const {
  Fix fix;
  fix.measured = TrueTime{} + config_.period * index;
  fix.available = fix.measured + config_.latency;
  fix.object = object_;
  const ObjectState truth = world.state_of(object_, fix.measured);
  RandomStream noise({seed_, replication_, Purpose::kReferenceNoise, kFixEntity, index});
  double x = truth.x + config_.sigma_m * noise.normal(), y = truth.y + config_.sigma_m * noise.normal();
  const double vx = truth.speed * std::cos(truth.heading) + config_.velocity_sigma_mps * noise.normal(),
               vy = truth.speed * std::sin(truth.heading) + config_.velocity_sigma_mps * noise.normal();
  const std::uint32_t length = static_cast<std::uint32_t>(config_.excursion_fixes);
  for (std::uint32_t back = 0; back < std::min(length, index + 1); ++back) {
    RandomStream excursion({seed_, replication_, Purpose::kReferenceNoise, kExcursionEntity, index - back});
    if (excursion.uniform() >= config_.excursion_probability) continue;
    const double direction = excursion.uniform(-std::numbers::pi, std::numbers::pi);
    x += config_.excursion_m * std::cos(direction);
    y += config_.excursion_m * std::sin(direction);
    break;
  }
  const double c = std::cos(alignment_), s = std::sin(alignment_);
  fix.x = c * x - s * y;
  fix.y = s * x + c * y;
  fix.vx = c * vx - s * vy;
  fix.vy = s * vx + c * vy;
  return fix;
}

}  // namespace ttf::sim::world
