#include "sim/world/size.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace ttf::sim::world {
namespace {

constexpr Range<double> kLength{0.1, 30.0}, kWidth{0.1, 5.0};  // [m]

bool holds(const SizeLimits& limits, const Size& size) {
  return size.length >= limits.shortest && size.length <= limits.longest && size.width >= limits.narrowest &&
         size.width <= limits.widest;
}

// At least 0.46 of the draws lie within a standard deviation in both values, however they are correlated (Sidak: "On
// multivariate normal probabilities of rectangles", 1968). So a thousand draws outside do not happen.
Size normal_size(const SizeConfig& config, RandomStream& stream) {
  constexpr int kMostDraws = 1000;
  const double rest = std::sqrt(1.0 - config.correlation * config.correlation);
  for (int draw = 0; draw < kMostDraws; ++draw) {
    const double a = stream.normal(), b = stream.normal();
    const Size size{config.mean.length + config.sigma.length * a,
                    config.mean.width + config.sigma.width * (config.correlation * a + rest * b)};
    if (holds(config.normal, size)) return size;
  }
  return config.mean;
}

SizeLimits load_limits(YamlMap& map, const SizeLimits& otherwise) {
  SizeLimits limits;
  limits.shortest = map.number_or("shortest", otherwise.shortest, kLength, "m");
  limits.longest = map.number_or("longest", otherwise.longest, kLength, "m");
  limits.narrowest = map.number_or("narrowest", otherwise.narrowest, kWidth, "m");
  limits.widest = map.number_or("widest", otherwise.widest, kWidth, "m");
  if (limits.shortest > limits.longest) map.fail("shortest", "must be at most `longest`");
  if (limits.narrowest > limits.widest) map.fail("narrowest", "must be at most `widest`");
  return limits;
}

}  // namespace

SizeConfig load_size(YamlMap& yaml) {
  SizeConfig c;
  c.draw = yaml.choice_or(
      "draw", SizeDraw::kNominal,
      Choices<SizeDraw>{
          {"nominal", SizeDraw::kNominal}, {"normal", SizeDraw::kNormal}, {"uniform", SizeDraw::kUniform}});
  if (auto normal = yaml.map_if("normal")) {
    c.mean.length = normal->number_or("length", c.mean.length, kLength, "m");
    c.sigma.length = normal->number_or("length_sigma", c.sigma.length, {0.0, 5.0}, "m");
    c.mean.width = normal->number_or("width", c.mean.width, kWidth, "m");
    c.sigma.width = normal->number_or("width_sigma", c.sigma.width, {0.0, 1.0}, "m");
    c.correlation = normal->number_or("correlation", c.correlation, {-1.0, 1.0});
    c.normal = load_limits(*normal, c.normal);
    const auto leave = [&](double low, double high, double mean, double sigma) {
      return low <= mean - sigma && mean + sigma <= high;
    };
    if (!leave(c.normal.shortest, c.normal.longest, c.mean.length, c.sigma.length))
      normal->fail("length", "must lie `length_sigma` or more within `shortest` and `longest`");
    if (!leave(c.normal.narrowest, c.normal.widest, c.mean.width, c.sigma.width))
      normal->fail("width", "must lie `width_sigma` or more within `narrowest` and `widest`");
    normal->finish();
  }
  if (auto uniform = yaml.map_if("uniform")) {
    c.uniform = load_limits(*uniform, c.uniform);
    uniform->finish();
  }
  yaml.finish();
  return c;
}

Size drawn_size(const SizeConfig& config, const Size& nominal, const ObjectKey& key) {
  if (config.draw == SizeDraw::kNominal) return nominal;
  RandomStream stream(
      {key.seed, key.replication, Purpose::kObjectSize, static_cast<std::uint16_t>(index_of(key.object)), 0});
  if (config.draw == SizeDraw::kNormal) return normal_size(config, stream);
  const SizeLimits& limits = config.uniform;
  const double length = stream.uniform(limits.shortest, limits.longest);
  return {length, stream.uniform(limits.narrowest, limits.widest)};
}

}  // namespace ttf::sim::world
