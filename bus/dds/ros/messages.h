// Converts records to ROS 2 messages: their fields, frames and clock. Only for sources that include DDS.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bus/dds/ros/options.h"
#include "bus/dds/ros/outbox.h"
#include "bus/dds/ros/standard_messages.h"
#include "bus/dds/ros/ttfusion_messages.h"

namespace ttf::bus::dds::ros {

// Returns ROS time from nanoseconds since 1970, limited to the range of int32 seconds.
builtin_interfaces_msg_dds__Time_ ros_time(std::int64_t realtime_ns);
// Returns CLOCK_REALTIME at an instant of a drive with that time scale: rounded down, and limited to the range
// of int64.
std::int64_t realtime_at(std::int64_t origin_ns, TrueTime drive, std::int64_t scale_ppm);

std::string object_name(ObjectId object);  // the object's frame, and part of its topic: "object_3"

// Each function makes a message of one waiting item. It is valid until the next call of any function, and as
// long as the item. The writer only reads it; C cannot declare that. Memory stops growing once the lists have
// had their longest.
class Messages {
 public:
  explicit Messages(const RosOptions& options);

  const ttfusion_msgs_msg_dds__RealTimeImage_& image(const WaitingImage& waiting);
  // The same image as boxes: position, heading and their deviations; one hypothesis each, "confirmed" or "tentative".
  const vision_msgs_msg_dds__Detection3DArray_& boxes(const WaitingImage& waiting);
  const ttfusion_msgs_msg_dds__TrackArray_& tracks(const WaitingStep& waiting);
  // The twist is in the object's own frame: speed along x, yaw rate about z. All covariances are zero.
  const nav_msgs_msg_dds__Odometry_& truth(const WaitingTruth& waiting);
  const diagnostic_msgs_msg_dds__DiagnosticArray_& health(const WaitingHealth& waiting);

 private:
  builtin_interfaces_msg_dds__Time_ time_of(TrueTime at) const;
  std_msgs_msg_dds__Header_ header(TrueTime at);

  std::int64_t origin_, scale_ppm_;
  std::string frame_, hardware_, child_frame_;
  std::vector<ttfusion_msgs_msg_dds__ImageObject_> objects_;
  std::vector<vision_msgs_msg_dds__Detection3D_> detections_;
  std::vector<vision_msgs_msg_dds__ObjectHypothesisWithPose_> hypotheses_;
  std::vector<std::array<char, 8>> ids_;
  std::vector<ttfusion_msgs_msg_dds__Track_> tracks_;
  std::vector<diagnostic_msgs_msg_dds__KeyValue_> values_;
  ttfusion_msgs_msg_dds__RealTimeImage_ image_{};
  vision_msgs_msg_dds__Detection3DArray_ boxes_{};
  ttfusion_msgs_msg_dds__TrackArray_ track_array_{};
  nav_msgs_msg_dds__Odometry_ odometry_{};
  diagnostic_msgs_msg_dds__DiagnosticStatus_ status_{};
  diagnostic_msgs_msg_dds__DiagnosticArray_ diagnostics_{};
};

}  // namespace ttf::bus::dds::ros
