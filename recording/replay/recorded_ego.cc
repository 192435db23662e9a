#include "recording/replay/recorded_ego.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/decimal.h"
#include "core/errors.h"
#include "fusion/motion/angles.h"

namespace ttf::recording::replay {
namespace {

using fusion::ego::EgoState;
using fusion::linear::Vector;

// Returns the middle step between rows, for the noise of odometry.
Duration period_of(const std::vector<recording::rows::EgoRow>& rows) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < rows.size(); ++i) steps.push_back(rows[i].time_ns - rows[i - 1].time_ns);
  if (steps.empty()) return fusion::ego::OdometryErrors{}.period;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return {steps[steps.size() / 2]};
}

std::string seconds_of(GlobalTime time) { return scaled_text(time.ns, 1'000'000'000); }

}  // namespace

RecordedEgo::RecordedEgo(const recording::rows::EgoRows& rows, const fusion::ego::OdometryErrors& errors)
    : errors_(errors), first_{rows.rows.front().time_ns}, last_{rows.rows.back().time_ns} {
  if (!rows.poses) path_.emplace(errors, rows.rows.size());
  for (const recording::rows::EgoRow& row : rows.rows) {
    const GlobalTime at{row.time_ns};
    if (path_)
      path_->accept({at, row.value[0], row.value[1], errors.speed_sigma, errors.yaw_rate_sigma});
    else
      poses_.push_back({at, {row.value[0], row.value[1]}, row.value[2]});
  }
}

std::optional<EgoState> RecordedEgo::at(GlobalTime time) const {
  if (path_) return path_->at(time);
  if (time < first_) return std::nullopt;
  EgoState ego;
  if (poses_.size() == 1) {
    ego.vehicle.position = poses_.front().position;
    ego.vehicle.yaw = fusion::motion::to_half_turn(poses_.front().heading);
    return ego;
  }
  auto next =
      std::upper_bound(poses_.begin(), poses_.end(), time, [](GlobalTime t, const Pose& p) { return t < p.at; });
  if (next == poses_.end()) --next;
  const Pose &a = *std::prev(next), &b = *next;
  const double whole = (b.at - a.at).seconds(), since = (time - a.at).seconds();
  ego.vehicle.velocity = (b.position - a.position) / whole;
  ego.vehicle.yaw_rate = fusion::motion::to_half_turn(b.heading - a.heading) / whole;
  ego.vehicle.position = a.position + since * ego.vehicle.velocity;
  ego.vehicle.yaw = fusion::motion::to_half_turn(a.heading + since * ego.vehicle.yaw_rate);
  return ego;
}

RecordedEgo recorded_ego_of(const recording::rows::EgoRows& rows, const std::string& file, ReplayConfig& config) {
  if (rows.poses) {
    if (config.tracker.odometry)
      throw InputError({config.file, config.tracker.odometry_line, "tracker.odometry", "",
                        "must be absent: " + file + " has poses"});
    fusion::ego::OdometryErrors exact;
    exact.speed_scale_sigma = exact.yaw_rate_bias_sigma = 0.0;
    return {rows, exact};
  }
  if (config.tracker.cross_noise)
    throw InputError({config.file, config.tracker.cross_noise_line, "tracker.cross_noise",
                      fmt::format("{:g}", *config.tracker.cross_noise),
                      "must be absent with the odometry of " + file + ": the vehicle's axes turn"});
  if (!config.tracker.odometry) config.tracker.odometry.emplace();
  config.tracker.odometry->period = period_of(rows.rows);
  return {rows, *config.tracker.odometry};
}

void carry(RecordedLists& recorded, std::vector<recording::rows::ObservationRow>& rows, const RecordedEgo& ego,
           const std::string& name) {
  Findings findings;
  const auto check = [&](GlobalTime time, int line) {
    if (time >= ego.first() && time <= ego.last()) return;
    findings.add({name, line, "time", seconds_of(time),
                  fmt::format("must be in {}..{} s: the vehicle's motion is known there", seconds_of(ego.first()),
                              seconds_of(ego.last()))});
  };
  for (const recording::rows::ObservationRow& row : rows) check(GlobalTime{row.time_ns}, row.line);
  if (findings.empty())  // else the rows have stated it
    for (const RecordedList& list : recorded.lists) check(list.measured, 0);
  findings.throw_if_any();
  for (recording::rows::ObservationRow& row : rows) {
    if (!row.truth) continue;
    const fusion::sensors::Mounting vehicle = ego.at(GlobalTime{row.time_ns})->vehicle;
    const Vector<2> at = vehicle.position + fusion::sensors::turned({row.truth->x, row.truth->y}, vehicle.yaw);
    row.truth->x = at.x();
    row.truth->y = at.y();
    if (!row.truth->velocity) continue;
    const Vector<2> velocity =
        fusion::sensors::turned({(*row.truth->velocity)[0], (*row.truth->velocity)[1]}, vehicle.yaw);
    row.truth->velocity = {velocity.x(), velocity.y()};
  }
  for (RecordedList& list : recorded.lists) {
    const EgoState state = *ego.at(list.measured);
    list.vehicle = state.vehicle;
    for (fusion::sensors::Observation& observation : list.observations) {
      observation.sensor = list.id.sensor;
      fusion::ego::carry(observation, state);
    }
  }
}

}  // namespace ttf::recording::replay
