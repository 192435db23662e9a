#include "nodes/vision/frame_plan.h"

#include <algorithm>

namespace ttf::nodes::vision {

FramePlan::FramePlan(const FramePlanConfig& config, int cameras)
    : config_(config), cameras_(cameras), history_(cameras, config.first_guess, config.history) {
  const std::size_t most = static_cast<std::size_t>(cameras) + schedules::sequence::kMostSecondaries;
  sequence_.reserve(most);
  letters_.reserve(most);
  interest_.reserve(static_cast<std::size_t>(cameras));
}

void FramePlan::begin(std::span<const double> shares) {
  interest_.clear();
  double area = 0.0;
  for (std::size_t camera = 0; camera < shares.size(); ++camera) {
    if (shares[camera] <= 0.0) continue;
    interest_.push_back(static_cast<int>(camera));
    area += shares[camera];
  }
  schedules::sequence::FrameRequest request;
  request.sensors = cameras_;
  request.interest = interest_;
  request.primaries = history_.primaries();
  if (!interest_.empty())
    request.secondary = std::max(history_.secondary(area / static_cast<double>(interest_.size())), config_.shortest);
  request.bound = config_.bound;
  request.slots = config_.slots;
  request.order = config_.order;
  schedules::sequence::generate(request, sequence_);
  letters_.clear();
  length_ = {};
  for (const schedules::sequence::Detection& one : sequence_) {
    letters_ += static_cast<char>((one.secondary ? 'a' : 'A') + one.sensor);
    length_ += one.secondary ? request.secondary : history_.primary(one.sensor);
  }
  place_ = 0;
  ++frames_;
}

}  // namespace ttf::nodes::vision
