#include "bus/dds/ros/writers.h"

#include <dds/dds.h>

#include <cmath>

namespace ttf::bus::dds::ros {
namespace {

constexpr std::int32_t kDepth = 10;  // the default depth of ROS' readers

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

// A reliable, volatile writer suits every reader of ROS 2, except those that want earlier samples. It keeps
// only the last samples, so that a stopped reader holds up no writer.
Qos qualities(Duration period, bool kept_for_late_listeners, const RosOptions& options) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
  const std::int32_t depth = kept_for_late_listeners ? 1 : kDepth;
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  if (kept_for_late_listeners) {
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED);
  } else {
    dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  }
  if (period > Duration{})
    dds_qset_deadline(qos.get(), std::llround(static_cast<double>(period.ns) * options.deadline_slack));
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, std::chrono::nanoseconds(options.liveliness_lease).count());
  dds_data_representation_id_t plain = DDS_DATA_REPRESENTATION_XCDR1;  // the only one of ROS 2
  dds_qset_data_representation(qos.get(), 1, &plain);
  return qos;
}

// ROS 2 puts "rt/" before the names of topics.
std::string topic_of(const RosOptions& options, const std::string& name) {
  return "rt/" + options.node_name + "/" + name;
}

}  // namespace

Writer::Writer(const common::Participant& participant, const void* type, const std::string& topic, Duration period,
               bool kept_for_late_listeners, const RosOptions& options) {
  const Qos qos = qualities(period, kept_for_late_listeners, options);
  const common::Handle made =
      common::checked(dds_create_topic(participant.handle(), static_cast<const dds_topic_descriptor_t*>(type),
                                       topic.c_str(), nullptr, nullptr),
                      "cannot make topic " + topic);
  writer_ = common::checked(dds_create_writer(participant.handle(), made, qos.get(), nullptr),
                            "cannot make a writer of " + topic);
}

void Writer::write(const void* sample) {
  if (dds_write(writer_, sample) == DDS_RETCODE_OK)
    ++counts_.written;
  else
    ++counts_.refused;
}

Writer::Counts Writer::counts() const {
  Counts counts = counts_;
  dds_offered_deadline_missed_status_t missed{};
  if (dds_get_offered_deadline_missed_status(writer_, &missed) == DDS_RETCODE_OK)
    counts.deadlines_missed = missed.total_count;
  return counts;
}

Writers::Writers(const RosOptions& options)
    : participant_(options.domain, lease_of(options)), messages_(options),
      // All of ROS looks for diagnostics here, from any publisher.
      healths_(participant_, &diagnostic_msgs_msg_dds__DiagnosticArray__desc, "rt/diagnostics", options.health_period,
               true, options) {
  if (options.images) {
    images_.emplace(participant_, &ttfusion_msgs_msg_dds__RealTimeImage__desc, topic_of(options, "image"),
                    options.image_period, false, options);
    boxes_.emplace(participant_, &vision_msgs_msg_dds__Detection3DArray__desc, topic_of(options, "image/boxes"),
                   options.image_period, false, options);
  }
  if (options.tracks)
    tracks_.emplace(participant_, &ttfusion_msgs_msg_dds__TrackArray__desc, topic_of(options, "tracks"),
                    options.step_period, false, options);
  truths_.reserve(options.truth_objects);
  for (std::uint16_t object = 0; object < options.truth_objects; ++object)
    truths_.emplace_back(participant_, &nav_msgs_msg_dds__Odometry__desc,
                         topic_of(options, "truth/" + object_name(ObjectId{object})), options.truth_period, false,
                         options);
}

void Writers::write(const WaitingImage& image) {
  if (!images_) return;
  images_->write(&messages_.image(image));
  boxes_->write(&messages_.boxes(image));
}

void Writers::write(const WaitingStep& step) {
  if (tracks_) tracks_->write(&messages_.tracks(step));
}

void Writers::write(const WaitingTruth& truth) { truths_[index_of(truth.state.object)].write(&messages_.truth(truth)); }

void Writers::write(const WaitingHealth& health) { healths_.write(&messages_.health(health)); }

Writer::Counts Writers::truths() const {
  Writer::Counts all;
  for (const Writer& writer : truths_) {
    const Writer::Counts counts = writer.counts();
    all.written += counts.written;
    all.refused += counts.refused;
    all.deadlines_missed += counts.deadlines_missed;
  }
  return all;
}

}  // namespace ttf::bus::dds::ros
