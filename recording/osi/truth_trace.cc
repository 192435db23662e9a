#include "recording/osi/truth_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/decimal.h"
#include "core/errors.h"
#include "core/hash.h"
#include "recording/osi/messages.h"
#include "recording/osi/osi.pb.h"

namespace ttf::recording::osi {
namespace {

constexpr std::int64_t kLatest_s = 4'000'000'000;  // the year 2096, for clocks that count from 1970
// No road user exceeds these; positions may be map coordinates.
constexpr double kFarthest_m = 1e8, kFastest_mps = 1e3, kHardest_mps2 = 1e4, kFastestTurn_radps = 1e3,
                 kLongest_m = 500.0;
constexpr double kSameSize_m = 1e-3;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// Where in the file a mistake is.
struct Place {
  const std::string* name;
  std::size_t message;  // from 1
  std::int64_t stamp_ns;

  [[noreturn]] void refuse(std::string why) const {
    throw InputError(
        {*name, 0, fmt::format("message {} ({} s)", message, scaled_text(stamp_ns, kNsPerSecond)), "", std::move(why)});
  }
};

std::int64_t stamp_of(const osi3::GroundTruth& truth, const std::string& name, std::size_t message) {
  const osi3::Timestamp& stamp = truth.timestamp();
  const auto refuse = [&](std::string why) {
    throw InputError({name, 0, fmt::format("message {}", message), "", std::move(why)});
  };
  if (!stamp.has_seconds() && !stamp.has_nanos()) refuse("must have a timestamp");
  if (stamp.seconds() < -kLatest_s || stamp.seconds() > kLatest_s)
    refuse(fmt::format("must have a timestamp within {} s, and has {} s", kLatest_s, stamp.seconds()));
  return stamp.seconds() * kNsPerSecond + stamp.nanos();
}

double within(double value, double most, const char* what, const char* unit, std::uint64_t id, const Place& place) {
  if (!(std::abs(value) <= most))
    place.refuse(fmt::format("object {} must have a {} of at most {:g} {}, and has {:g}", id, what, most, unit, value));
  return value;
}

// Velocity, acceleration and yaw rate are not numbers where the message lacks them.
TracedState state_of(const osi3::BaseMoving& base, std::uint64_t id, const Place& place) {
  if (!base.position().has_x() || !base.position().has_y() || !base.orientation().has_yaw())
    place.refuse(fmt::format("object {} must have a position and an orientation", id));
  TracedState state;
  state.x = within(base.position().x(), kFarthest_m, "position", "m", id, place);
  state.y = within(base.position().y(), kFarthest_m, "position", "m", id, place);
  state.heading = within(base.orientation().yaw(), 1e3, "yaw angle", "rad", id, place);
  state.vx = state.vy = state.ax = state.ay = state.yaw_rate = kNone;
  if (base.has_velocity()) {
    state.vx = within(base.velocity().x(), kFastest_mps, "velocity", "m/s", id, place);
    state.vy = within(base.velocity().y(), kFastest_mps, "velocity", "m/s", id, place);
  }
  if (base.has_acceleration()) {
    state.ax = within(base.acceleration().x(), kHardest_mps2, "acceleration", "m/s^2", id, place);
    state.ay = within(base.acceleration().y(), kHardest_mps2, "acceleration", "m/s^2", id, place);
  }
  if (base.has_orientation_rate())
    state.yaw_rate = within(base.orientation_rate().yaw(), kFastestTurn_radps, "yaw rate", "rad/s", id, place);
  return state;
}

TracedKind kind_of(const osi3::MovingObject& object) {
  using Vehicle = osi3::MovingObject::VehicleClassification;
  if (object.type() == osi3::MovingObject::TYPE_PEDESTRIAN) return TracedKind::kPedestrian;
  if (object.type() != osi3::MovingObject::TYPE_VEHICLE) return TracedKind::kOther;
  const Vehicle::Type type = object.vehicle_classification().type();
  return type == Vehicle::TYPE_MOTORBIKE || type == Vehicle::TYPE_BICYCLE ? TracedKind::kTwoWheeler
                                                                          : TracedKind::kVehicle;
}

// Gathers the messages into objects.
class Gathering {
 public:
  explicit Gathering(const std::string& name) : name_(name) { trace_.name = name; }

  void add(const osi3::GroundTruth& truth, std::optional<std::uint64_t> host) {
    const std::size_t instant = trace_.instants.size();
    const std::int64_t stamp = stamp_of(truth, name_, instant + 1);
    if (instant == 0) first_ = stamp;
    const Place place{&name_, instant + 1, stamp};
    if (instant > 0 && stamp <= last_)
      place.refuse(
          fmt::format("must be later than the message before it, which is of {} s", scaled_text(last_, kNsPerSecond)));
    last_ = stamp;
    if (instant == 0) host_ = host;
    if (host && host != host_) place.refuse("must name the same host vehicle as the first message");
    trace_.instants.push_back({stamp - first_});
    std::vector<const osi3::MovingObject*> objects;
    for (const osi3::MovingObject& object : truth.moving_object()) {
      if (!object.id().has_value()) place.refuse("must give each moving object an id");
      objects.push_back(&object);
    }
    std::ranges::sort(objects, {}, [](const osi3::MovingObject* object) { return object->id().value(); });
    for (std::size_t o = 0; o < objects.size(); ++o) {
      if (o > 0 && objects[o]->id().value() == objects[o - 1]->id().value())
        place.refuse(fmt::format("has two objects with the id {}", objects[o]->id().value()));
      add(*objects[o], instant, place);
    }
    if (host_ && (trace_.host->vehicle.lives.size() != 1 || trace_.host->vehicle.lives[0].states.size() != instant + 1))
      place.refuse(fmt::format("must have the host vehicle, {}", *host_));
  }

  TruthTrace finished() && {
    if (trace_.objects.empty())
      throw InputError({name_, 0, "", "",
                        host_ ? "must have a moving object beside the host vehicle" : "must have a moving object"});
    for (TracedObject& object : trace_.objects) derive(object);
    if (trace_.host) derive(trace_.host->vehicle);
    return std::move(trace_);
  }

 private:
  TracedObject& object_of(std::uint64_t id, const Place& place) {
    if (id == host_) {
      if (!trace_.host) trace_.host.emplace();
      return trace_.host->vehicle;
    }
    const auto [index, added] = index_.try_emplace(id, trace_.objects.size());
    if (added && trace_.objects.size() == kMostTracedObjects)
      place.refuse(fmt::format("must not bring more than {} objects", kMostTracedObjects));
    return added ? trace_.objects.emplace_back() : trace_.objects[index->second];
  }

  void add(const osi3::MovingObject& object, std::size_t instant, const Place& place) {
    const std::uint64_t id = object.id().value();
    TracedObject& traced = object_of(id, place);
    const osi3::BaseMoving& base = object.base();
    const double length = within(base.dimension().length(), kLongest_m, "length", "m", id, place);
    const double width = within(base.dimension().width(), kLongest_m, "width", "m", id, place);
    if (!(length > 0.0) || !(width > 0.0)) place.refuse(fmt::format("object {} must have a length and a width", id));
    if (traced.lives.empty()) {
      traced.id = id;
      traced.kind = kind_of(object);
      traced.length = length;
      traced.width = width;
      if (id == host_) add_host(object, id, place);
    } else if (std::abs(length - traced.length) > kSameSize_m || std::abs(width - traced.width) > kSameSize_m) {
      place.refuse(fmt::format("object {} must keep its size of {:g} m x {:g} m, and has {:g} m x {:g} m", id,
                               traced.length, traced.width, length, width));
    }
    if (traced.lives.empty() || traced.lives.back().first + traced.lives.back().states.size() != instant)
      traced.lives.push_back({instant, {}});
    traced.lives.back().states.push_back(state_of(base, id, place));
  }

  void add_host(const osi3::MovingObject& object, std::uint64_t id, const Place& place) {
    TracedHost& host = *trace_.host;
    host.has_rear = object.vehicle_attributes().has_bbcenter_to_rear();
    host.rear_x =
        within(object.vehicle_attributes().bbcenter_to_rear().x(), kLongest_m, "bbcenter_to_rear", "m", id, place);
    host.rear_y =
        within(object.vehicle_attributes().bbcenter_to_rear().y(), kLongest_m, "bbcenter_to_rear", "m", id, place);
  }

  // Fills in values that the messages lack. Differences go over the neighbours on both sides where there are two.
  void derive(TracedObject& object) {
    for (TracedObject::Life& life : object.lives) {
      const auto differences = [&](auto&& lacks, auto&& set) {
        for (std::size_t k = 0; k < life.states.size(); ++k) {
          if (!lacks(life.states[k])) continue;
          const std::size_t from = k == 0 ? 0 : k - 1, to = std::min(k + 1, life.states.size() - 1);
          const double dt = (trace_.instants[life.first + to] - trace_.instants[life.first + from]).seconds();
          set(life.states[k], life.states[from], life.states[to], dt > 0.0 ? 1.0 / dt : 0.0);
        }
      };
      differences([](const TracedState& s) { return std::isnan(s.vx); },
                  [](TracedState& s, const TracedState& a, const TracedState& b, double per_s) {
                    s.vx = (b.x - a.x) * per_s;
                    s.vy = (b.y - a.y) * per_s;
                  });
      differences([](const TracedState& s) { return std::isnan(s.ax); },
                  [](TracedState& s, const TracedState& a, const TracedState& b, double per_s) {
                    s.ax = (b.vx - a.vx) * per_s;
                    s.ay = (b.vy - a.vy) * per_s;
                  });
      differences([](const TracedState& s) { return std::isnan(s.yaw_rate); },
                  [](TracedState& s, const TracedState& a, const TracedState& b, double per_s) {
                    s.yaw_rate = std::remainder(b.heading - a.heading, 2.0 * std::numbers::pi) * per_s;
                  });
    }
  }

  const std::string& name_;
  TruthTrace trace_;
  std::map<std::uint64_t, std::size_t> index_;  // by id
  std::optional<std::uint64_t> host_;
  std::int64_t first_ = 0, last_ = 0;
};

std::optional<std::uint64_t> id_in(bool has, const osi3::Identifier& id) {
  return has ? std::optional(id.value()) : std::nullopt;
}

}  // namespace

std::string_view name_of(TracedKind kind) {
  switch (kind) {
    case TracedKind::kVehicle: return "vehicle";
    case TracedKind::kTwoWheeler: return "two-wheeler";
    case TracedKind::kPedestrian: return "pedestrian";
    case TracedKind::kOther: return "other";
  }
  return "other";
}

TruthTrace parse_truth_trace(std::string_view bytes, const std::string& name) {
  const TraceMessages trace = trace_messages(bytes, name);
  Gathering gathering(name);
  osi3::GroundTruth truth;
  osi3::SensorView view;
  for (std::size_t m = 0; m < trace.messages.size(); ++m) {
    const std::string_view message = trace.messages[m];
    const bool in_view = trace.type == MessageType::kSensorView;
    google::protobuf::Message& into = in_view ? static_cast<google::protobuf::Message&>(view) : truth;
    if (message.size() > INT32_MAX || !into.ParsePartialFromArray(message.data(), static_cast<int>(message.size())))
      throw InputError({name, 0, fmt::format("message {}", m + 1), "",
                        fmt::format("must be a {}, and cannot be decoded as one", into.GetDescriptor()->name())});
    if (!in_view) {
      gathering.add(truth, id_in(truth.has_host_vehicle_id(), truth.host_vehicle_id()));
      continue;
    }
    osi3::GroundTruth& inside = *view.mutable_global_ground_truth();
    if (!inside.has_timestamp()) *inside.mutable_timestamp() = view.timestamp();
    const auto host = id_in(inside.has_host_vehicle_id(), inside.host_vehicle_id());
    gathering.add(inside, host ? host : id_in(view.has_host_vehicle_id(), view.host_vehicle_id()));
  }
  TruthTrace read = std::move(gathering).finished();
  read.type = trace.type == MessageType::kSensorView ? "SensorView" : "GroundTruth";
  read.guessed = trace.guessed;
  read.hash = hex_hash(bytes);
  return read;
}

}  // namespace ttf::recording::osi
