// Any bytes as an OSI trace. Laws: a refusal is one sentence. Instants ascend from zero. Each object has lives in their
// order, a size, and finite states; the host vehicle is in every message. As a scene, the trace has finite states at
// any instant, and at most as many as objects.
#include <cmath>
#include <memory>
#include <vector>

#include "core/check.h"
#include "recording/osi/truth_trace.h"
#include "sensors/traced.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using recording::osi::TracedObject;
using recording::osi::TracedState;

constexpr char kFile[] = "trace.osi";

void check_object(const TracedObject& object, std::size_t messages) {
  TTF_CHECK(object.length > 0.0 && object.width > 0.0, "object {}: {} m x {} m", object.id, object.length,
            object.width);
  TTF_CHECK(!object.lives.empty(), "object {} has no life", object.id);
  std::size_t free = 0;
  for (const TracedObject::Life& life : object.lives) {
    TTF_CHECK(life.first >= free && !life.states.empty(), "a life from {} on, after {}", life.first, free);
    free = life.first + life.states.size() + 1;
    for (const TracedState& s : life.states)
      TTF_CHECK(std::isfinite(s.x + s.y + s.heading + s.vx + s.vy + s.ax + s.ay + s.yaw_rate), "object {}", object.id);
  }
  TTF_CHECK(free <= messages + 1, "object {} in {} messages of {}", object.id, free, messages);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes = fuzz::text_of(data, size);
  auto trace = std::make_shared<recording::osi::TruthTrace>();
  if (!fuzz::accepted(kFile, [&] { *trace = recording::osi::parse_truth_trace(bytes, kFile); })) return 0;
  TTF_CHECK(!trace->instants.empty() && trace->instants.front() == Duration{} && !trace->objects.empty(),
            "an empty trace");
  for (std::size_t m = 1; m < trace->instants.size(); ++m)
    TTF_CHECK(trace->instants[m - 1] < trace->instants[m], "message {}", m);
  for (const TracedObject& object : trace->objects) check_object(object, trace->instants.size());
  if (trace->host) {
    check_object(trace->host->vehicle, trace->instants.size());
    TTF_CHECK(trace->host->vehicle.lives[0].states.size() == trace->instants.size(), "a host that is not always there");
  }
  const sensors::TracedScene scene(trace, TrueTime{});
  std::vector<sim::world::ObjectState> states;
  for (const Duration at : {Duration{-1}, Duration{}, Duration{trace->length().ns / 3}, trace->length() - Duration{1},
                            trace->length(), trace->length() + Duration{1}}) {
    scene.states_at(TrueTime{} + at, states);
    TTF_CHECK(states.size() <= scene.objects(), "{} states of {} objects", states.size(), scene.objects());
    for (const sim::world::ObjectState& s : states)
      TTF_CHECK(std::isfinite(s.x + s.y + s.heading + s.speed + s.acceleration + s.yaw_rate), "at {} ns", at.ns);
    const sim::world::EgoState ego = scene.ego_at(TrueTime{} + at);
    TTF_CHECK(std::isfinite(ego.x + ego.y + ego.heading + ego.vx + ego.vy + ego.acceleration), "at {} ns", at.ns);
  }
  return 0;
}
