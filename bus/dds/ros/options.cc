#include "bus/dds/ros/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "bus/dds/common/configuration.h"
#include "bus/dds/common/participant.h"
#include "core/decimal.h"
#include "core/errors.h"

namespace ttf::bus::dds::ros {
namespace {

constexpr std::size_t kMost = 1024;
constexpr std::size_t kMaxNameLength = 64;
constexpr std::int64_t kSmallestScale_ppm = 100'000, kLargestScale_ppm = 1'000'000'000;  // as --time-scale

// Returns whether the name is a token of ROS 2 names (design.ros2.org/articles/topic_and_service_names.html).
bool is_token(const std::string& name) {
  const auto valid = [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_'); };
  return !name.empty() && name.size() <= kMaxNameLength && std::isdigit(static_cast<unsigned char>(name[0])) == 0 &&
         name[0] != '_' && name.find("__") == std::string::npos && std::all_of(name.begin(), name.end(), valid);
}

}  // namespace

void validate(const RosOptions& options) {
  Findings findings;
  const auto demand = [&](bool holds, const char* key, const std::string& value, const std::string& range) {
    if (!holds) findings.add({"ROS", 0, key, value, range});
  };
  const auto demand_count = [&](const char* key, std::size_t value) {
    demand(value >= 1 && value <= kMost, key, std::to_string(value), fmt::format("must be 1..{}", kMost));
  };
  const auto demand_period = [&](const char* key, Duration value) {
    demand(value >= Duration{} && value <= Duration::milliseconds(3'600'000), key, std::to_string(value.ns),
           "must be 0..1 h");
  };
  demand(options.domain <= common::kMaxDomain, "domain", std::to_string(options.domain),
         fmt::format("must be 0..{}", common::kMaxDomain));
  demand(options.time_scale_ppm >= kSmallestScale_ppm && options.time_scale_ppm <= kLargestScale_ppm, "time_scale_ppm",
         std::to_string(options.time_scale_ppm), fmt::format("must be {}..{}", kSmallestScale_ppm, kLargestScale_ppm));
  for (const auto& [key, name] : {std::pair{"node_name", &options.node_name}, std::pair{"frame_id", &options.frame_id}})
    demand(is_token(*name), key, *name,
           fmt::format("must be a letter and up to {} letters, digits and single '_'", kMaxNameLength - 1));
  demand_period("image_period", options.image_period);
  demand_period("step_period", options.step_period);
  demand_period("truth_period", options.truth_period);
  demand_period("health_period", options.health_period);
  demand(options.deadline_slack >= 1 && options.deadline_slack <= 1000, "deadline_slack",
         std::to_string(options.deadline_slack), "must be 1..1000");
  demand(
      options.liveliness_lease >= std::chrono::milliseconds{100} && options.liveliness_lease <= std::chrono::hours{1},
      "liveliness_lease", std::to_string(options.liveliness_lease.count()), "must be 100..3600000 ms");
  demand(options.truth_objects <= kMost, "truth_objects", std::to_string(options.truth_objects),
         fmt::format("must be 0..{}", kMost));
  demand_count("most_objects", options.most_objects);
  demand_count("most_tracks", options.most_tracks);
  demand_count("queue", options.queue);
  findings.throw_if_any();
}

std::uint32_t domain_of_environment() {
  const char* const text = std::getenv("ROS_DOMAIN_ID");
  if (text == nullptr || *text == '\0') return 0;
  const auto domain = parse_scaled(text, 1);
  if (!domain || *domain < 0 || *domain > common::kMaxDomain)
    throw InputError(
        {"environment", 0, "ROS_DOMAIN_ID", text, fmt::format("must be a whole number 0..{}", common::kMaxDomain)});
  return static_cast<std::uint32_t>(*domain);
}

void try_domain(const RosOptions& options) { const common::Participant there(options.domain, lease_of(options)); }

}  // namespace ttf::bus::dds::ros
