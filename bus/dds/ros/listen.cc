// An example: listens to a RosPublisher, as any program can that has DDS and the types. It uses Cyclone DDS'
// C API and idlc's output for the two files *.idl in this folder, and nothing else of this project.
//
//   CYCLONEDDS_URI=file:///path/to/bus/dds/loopback.xml ttf_ros_listen [DOMAIN]
//
// It prints one JSON object per line, until SIGINT or SIGTERM. An object is a publication of a known type, as
// DDS announces it, a sample, or a publisher that misses its deadline, comes to life or goes. Readers request
// the quality of service (QoS) that the first publisher of their topic offers.
#include <dds/dds.h>

#include <array>
#include <cinttypes>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include "bus/dds/ros/standard_messages.h"
#include "bus/dds/ros/ttfusion_messages.h"

namespace {

volatile std::sig_atomic_t stop = 0;
void on_signal(int) { stop = 1; }

[[noreturn]] void fail(const char* what, std::int32_t why) {
  std::fprintf(stderr, "ttf_ros_listen: %s: %s\n", what, dds_strretcode(-why));
  std::exit(1);
}

std::int32_t checked(std::int32_t result, const char* what) {
  if (result < 0) fail(what, result);
  return result;
}

// Returns a JSON text; other programs may publish any characters.
std::string quoted(const char* text) {
  std::string out = "\"";
  for (const char* c = text; *c != '\0'; ++c) {
    const auto byte = static_cast<unsigned char>(*c);
    if (byte < 0x20 || byte == '"' || byte == '\\') {
      std::array<char, 8> escape{};
      std::snprintf(escape.data(), escape.size(), "\\u%04x", byte);
      out += escape.data();
    } else {
      out += *c;
    }
  }
  return out + "\"";
}

// JSON has neither infinities nor NaN.
void print_value(double value) {
  if (std::isfinite(value))
    std::printf("%.17g", value);
  else
    std::printf("null");
}

void print_number(const char* key, double value) {
  std::printf(", \"%s\": ", key);
  print_value(value);
}

template <class Numbers> void print_numbers(const char* key, const Numbers& values) {
  std::printf(", \"%s\": [", key);
  const char* between = "";
  for (const double value : values) {
    std::printf("%s", between);
    print_value(value);
    between = ", ";
  }
  std::printf("]");
}

void print_time(const char* key, const builtin_interfaces_msg_dds__Time_& time) {
  std::printf(", \"%s_ns\": %" PRId64, key, std::int64_t{time.sec} * 1'000'000'000 + time.nanosec);
}

void print_header(const std_msgs_msg_dds__Header_& header) {
  print_time("stamp", header.stamp);
  std::printf(", \"frame_id\": %s", quoted(header.frame_id).c_str());
}

void print_image(const void* sample) {
  const auto& image = *static_cast<const ttfusion_msgs_msg_dds__RealTimeImage_*>(sample);
  print_header(image.header);
  std::printf(", \"sequence_number\": %" PRIu32, image.sequence_number);
  print_time("written", image.written);
  print_time("newest_measurement", image.newest_measurement);
  std::printf(", \"objects\": [");
  for (std::uint32_t i = 0; i < image.objects._length; ++i) {
    const auto& object = image.objects._buffer[i];
    std::printf("%s{\"track_id\": %u, \"status\": %u", i == 0 ? "" : ", ", unsigned{object.track_id},
                unsigned{object.status});
    print_number("x", object.x);
    print_number("y", object.y);
    print_number("heading", object.heading);
    print_number("speed", object.speed);
    print_number("acceleration", object.acceleration);
    print_number("length", object.length);
    print_number("width", object.width);
    print_number("sigma_x", object.sigma_x);
    print_number("sigma_y", object.sigma_y);
    print_number("correlation_xy", object.correlation_xy);
    print_number("sigma_heading", object.sigma_heading);
    print_number("sigma_speed", object.sigma_speed);
    print_number("sigma_acceleration", object.sigma_acceleration);
    print_number("sigma_length", object.sigma_length);
    print_number("sigma_width", object.sigma_width);
    std::printf("}");
  }
  std::printf("]");
}

void print_pose(const geometry_msgs_msg_dds__Pose_& pose) {
  print_numbers("position", std::array{pose.position.x, pose.position.y, pose.position.z});
  const auto& turned = pose.orientation;
  print_numbers("orientation", std::array{turned.x, turned.y, turned.z, turned.w});
}

void print_boxes(const void* sample) {
  const auto& boxes = *static_cast<const vision_msgs_msg_dds__Detection3DArray_*>(sample);
  print_header(boxes.header);
  std::printf(", \"detections\": [");
  for (std::uint32_t i = 0; i < boxes.detections._length; ++i) {
    const auto& detection = boxes.detections._buffer[i];
    std::printf("%s{\"id\": %s", i == 0 ? "" : ", ", quoted(detection.id).c_str());
    print_header(detection.header);
    print_pose(detection.bbox.center);
    print_numbers("size", std::array{detection.bbox.size.x, detection.bbox.size.y, detection.bbox.size.z});
    std::printf(", \"results\": [");
    for (std::uint32_t j = 0; j < detection.results._length; ++j) {
      const auto& result = detection.results._buffer[j];
      std::printf("%s{\"class_id\": %s", j == 0 ? "" : ", ", quoted(result.hypothesis.class_id).c_str());
      print_number("score", result.hypothesis.score);
      print_pose(result.pose.pose);
      print_numbers("covariance", result.pose.covariance);
      std::printf("}");
    }
    std::printf("]}");
  }
  std::printf("]");
}

void print_tracks(const void* sample) {
  const auto& array = *static_cast<const ttfusion_msgs_msg_dds__TrackArray_*>(sample);
  print_header(array.header);
  std::printf(", \"step\": %" PRIu32 ", \"confirmed\": %u, \"tentative\": %u, \"tracks\": [", array.step,
              unsigned{array.confirmed}, unsigned{array.tentative});
  for (std::uint32_t i = 0; i < array.tracks._length; ++i) {
    const auto& track = array.tracks._buffer[i];
    std::printf("%s{\"track_id\": %u", i == 0 ? "" : ", ", unsigned{track.track_id});
    print_time("valid_at", track.valid_at);
    print_numbers("state", track.state);
    print_numbers("covariance", track.covariance);
    std::printf("}");
  }
  std::printf("]");
}

void print_truth(const void* sample) {
  const auto& odometry = *static_cast<const nav_msgs_msg_dds__Odometry_*>(sample);
  print_header(odometry.header);
  std::printf(", \"child_frame_id\": %s", quoted(odometry.child_frame_id).c_str());
  print_pose(odometry.pose.pose);
  const auto& twist = odometry.twist.twist;
  print_numbers("linear", std::array{twist.linear.x, twist.linear.y, twist.linear.z});
  print_numbers("angular", std::array{twist.angular.x, twist.angular.y, twist.angular.z});
}

void print_health(const void* sample) {
  const auto& diagnostics = *static_cast<const diagnostic_msgs_msg_dds__DiagnosticArray_*>(sample);
  print_header(diagnostics.header);
  std::printf(", \"status\": [");
  for (std::uint32_t i = 0; i < diagnostics.status._length; ++i) {
    const auto& status = diagnostics.status._buffer[i];
    std::printf("%s{\"level\": %u, \"name\": %s, \"message\": %s, \"hardware_id\": %s, \"values\": {",
                i == 0 ? "" : ", ", unsigned{status.level}, quoted(status.name).c_str(), quoted(status.message).c_str(),
                quoted(status.hardware_id).c_str());
    for (std::uint32_t j = 0; j < status.values._length; ++j)
      std::printf("%s%s: %s", j == 0 ? "" : ", ", quoted(status.values._buffer[j].key).c_str(),
                  quoted(status.values._buffer[j].value).c_str());
    std::printf("}}");
  }
  std::printf("]");
}

struct KnownType {
  const dds_topic_descriptor_t* type;
  void (*print)(const void* sample);
};
const std::array kKnownTypes{KnownType{&ttfusion_msgs_msg_dds__RealTimeImage__desc, print_image},
                             KnownType{&vision_msgs_msg_dds__Detection3DArray__desc, print_boxes},
                             KnownType{&ttfusion_msgs_msg_dds__TrackArray__desc, print_tracks},
                             KnownType{&nav_msgs_msg_dds__Odometry__desc, print_truth},
                             KnownType{&diagnostic_msgs_msg_dds__DiagnosticArray__desc, print_health}};

void print_event(const char* event, const std::string& topic) {
  std::printf("{\"event\": \"%s\", \"topic\": %s", event, quoted(topic.c_str()).c_str());
}

class Listener {
 public:
  explicit Listener(dds_domainid_t domain) {
    participant_ = checked(dds_create_participant(domain, nullptr, nullptr), "cannot join the domain");
    set_ = checked(dds_create_waitset(participant_), "cannot wait");
    publications_ = checked(dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
                            "cannot see publications");
    attach(publications_, DDS_DATA_AVAILABLE_STATUS);
  }
  ~Listener() { dds_delete(participant_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  // Waits a little, then prints new samples and events.
  void listen() {
    checked(dds_waitset_wait(set_, nullptr, 0, DDS_MSECS(100)), "cannot wait");
    take_publications();
    for (auto& [topic, subscription] : subscriptions_) {
      take_events(topic, subscription);
      take_samples(topic, subscription);
    }
    std::fflush(stdout);
  }

 private:
  struct Subscription {
    dds_entity_t reader = 0;
    void (*print)(const void* sample) = nullptr;
  };

  void attach(dds_entity_t reader, std::uint32_t statuses) {
    checked(dds_set_status_mask(reader, statuses), "cannot watch");
    checked(dds_waitset_attach(set_, reader, 0), "cannot watch");
  }

  void take_publications() {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (checked(dds_take(publications_, &sample, &info, 1, 1), "cannot see publications") == 1) {
      const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
      if (info.valid_data) {
        for (const KnownType& known : kKnownTypes)
          if (std::strcmp(known.type->m_typename, endpoint.type_name) == 0) follow(endpoint, known);
      }
      dds_return_loan(publications_, &sample, 1);
    }
  }

  void follow(const dds_builtintopic_endpoint_t& endpoint, const KnownType& known) {
    dds_duration_t deadline = DDS_INFINITY, lease = DDS_INFINITY;
    dds_liveliness_kind_t kind = DDS_LIVELINESS_AUTOMATIC;
    dds_qget_deadline(endpoint.qos, &deadline);
    dds_qget_liveliness(endpoint.qos, &kind, &lease);
    print_event("publication", endpoint.topic_name);
    std::printf(", \"type\": %s, \"deadline_ns\": %" PRId64 ", \"lease_ns\": %" PRId64 "}\n",
                quoted(endpoint.type_name).c_str(), deadline, lease);
    Subscription& subscription = subscriptions_[endpoint.topic_name];
    if (subscription.reader != 0) return;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1000);
    dds_qset_deadline(qos, deadline);
    dds_qset_liveliness(qos, kind, lease);
    const dds_entity_t topic = checked(
        dds_create_topic(participant_, known.type, endpoint.topic_name, nullptr, nullptr), "cannot make the topic");
    subscription.reader = checked(dds_create_reader(participant_, topic, qos, nullptr), "cannot read");
    subscription.print = known.print;
    dds_delete_qos(qos);
    attach(subscription.reader, DDS_DATA_AVAILABLE_STATUS | DDS_REQUESTED_DEADLINE_MISSED_STATUS |
                                    DDS_LIVELINESS_CHANGED_STATUS | DDS_REQUESTED_INCOMPATIBLE_QOS_STATUS);
  }

  void take_events(const std::string& topic, const Subscription& subscription) {
    dds_requested_deadline_missed_status_t missed{};
    checked(dds_get_requested_deadline_missed_status(subscription.reader, &missed), "cannot ask");
    if (missed.total_count_change != 0) {
      print_event("deadline_missed", topic);
      std::printf(", \"total\": %" PRIu32 "}\n", missed.total_count);
    }
    dds_liveliness_changed_status_t alive{};
    checked(dds_get_liveliness_changed_status(subscription.reader, &alive), "cannot ask");
    if (alive.alive_count_change != 0 || alive.not_alive_count_change != 0) {
      print_event("liveliness", topic);
      std::printf(", \"alive\": %" PRIu32 ", \"not_alive\": %" PRIu32 "}\n", alive.alive_count, alive.not_alive_count);
    }
    dds_requested_incompatible_qos_status_t other{};
    checked(dds_get_requested_incompatible_qos_status(subscription.reader, &other), "cannot ask");
    if (other.total_count_change != 0) {
      print_event("another_publisher_promises_less", topic);
      std::printf(", \"policy\": %" PRIu32 "}\n", other.last_policy_id);
    }
  }

  static void take_samples(const std::string& topic, const Subscription& subscription) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (checked(dds_take(subscription.reader, &sample, &info, 1, 1), "cannot read") == 1) {
      if (info.valid_data) {
        print_event("sample", topic);
        subscription.print(sample);
        std::printf("}\n");
      }
      dds_return_loan(subscription.reader, &sample, 1);
    }
  }

  dds_entity_t participant_ = 0;
  dds_entity_t set_ = 0;
  dds_entity_t publications_ = 0;
  std::map<std::string, Subscription> subscriptions_;  // by topic
};

}  // namespace

int main(int count, char** arguments) {
  char* end = nullptr;
  const unsigned long domain = count == 2 ? std::strtoul(arguments[1], &end, 10) : 0;
  if (count > 2 || (count == 2 && (end == arguments[1] || *end != '\0' || domain > 231))) {
    std::fprintf(stderr, "usage: ttf_ros_listen [DOMAIN]   DOMAIN: 0..231, as ROS_DOMAIN_ID; 0 by default\n");
    return 2;
  }
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  Listener listener(static_cast<dds_domainid_t>(domain));
  while (stop == 0) listener.listen();
}
