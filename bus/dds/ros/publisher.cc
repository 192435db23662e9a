#include "bus/dds/ros/publisher.h"

#include <dds/dds.h>
#include <semaphore.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/ros/messages.h"
#include "bus/dds/ros/options.h"
#include "bus/dds/ros/outbox.h"
#include "core/check.h"

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

const RosOptions& valid(const RosOptions& options) {
  validate(options);
  return options;
}

}  // namespace

// One topic and its writer.
class Writer {
 public:
  struct Counts {
    std::uint64_t written = 0;
    std::uint64_t refused = 0;           // by DDS, because its memory is full or for another reason
    std::uint64_t deadlines_missed = 0;  // a sample came later than its deadline, or never
  };
  Writer(const common::Participant& participant, const void* type, const std::string& topic, Duration period,
         bool kept_for_late_listeners, const RosOptions& options) {
    const Qos qos = qualities(period, kept_for_late_listeners, options);
    const common::Handle made =
        common::checked(dds_create_topic(participant.handle(), static_cast<const dds_topic_descriptor_t*>(type),
                                         topic.c_str(), nullptr, nullptr),
                        "cannot make topic " + topic);
    writer_ = common::checked(dds_create_writer(participant.handle(), made, qos.get(), nullptr),
                              "cannot make a writer of " + topic);
  }
  void write(const void* sample) {  // never waits
    if (dds_write(writer_, sample) == DDS_RETCODE_OK)
      ++counts_.written;
    else
      ++counts_.refused;
  }
  Counts counts() const {
    Counts counts = counts_;
    dds_offered_deadline_missed_status_t missed{};
    if (dds_get_offered_deadline_missed_status(writer_, &missed) == DDS_RETCODE_OK)
      counts.deadlines_missed = missed.total_count;
    return counts;
  }

 private:
  common::Handle writer_ = 0;
  Counts counts_;
};

// The topics: names, types and qualities as ROS 2 expects them (docs/media/dds.md has the table).
class Writers {
 public:
  // Throws std::runtime_error if DDS refuses.
  explicit Writers(const RosOptions& options)
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

  void write(const WaitingImage& image) {
    if (!images_) return;
    images_->write(&messages_.image(image));
    boxes_->write(&messages_.boxes(image));
  }
  void write(const WaitingStep& step) {
    if (tracks_) tracks_->write(&messages_.tracks(step));
  }
  void write(const WaitingTruth& truth) { truths_[index_of(truth.state.object)].write(&messages_.truth(truth)); }
  void write(const WaitingHealth& health) { healths_.write(&messages_.health(health)); }

  // Without a writer, nothing is counted.
  Writer::Counts images() const { return images_ ? images_->counts() : Writer::Counts{}; }
  Writer::Counts boxes() const { return boxes_ ? boxes_->counts() : Writer::Counts{}; }
  Writer::Counts tracks() const { return tracks_ ? tracks_->counts() : Writer::Counts{}; }
  Writer::Counts truths() const {  // for all objects
    Writer::Counts all;
    for (const Writer& writer : truths_) {
      const Writer::Counts counts = writer.counts();
      all.written += counts.written;
      all.refused += counts.refused;
      all.deadlines_missed += counts.deadlines_missed;
    }
    return all;
  }
  Writer::Counts healths() const { return healths_.counts(); }

 private:
  common::Participant participant_;
  Messages messages_;
  std::optional<Writer> images_, boxes_, tracks_;
  Writer healths_;
  std::vector<Writer> truths_;  // by object
};

// A bell wakes a thread that sleeps until the next call. Calling never waits; calls during the thread's work are kept.
class Bell {
 public:
  Bell() { TTF_CHECK(sem_init(&semaphore_, 0, 0) == 0); }
  ~Bell() { sem_destroy(&semaphore_); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;
  void ring() { sem_post(&semaphore_); }  // fails only beyond INT_MAX calls, when no thread sleeps
  void wait() {
    while (sem_wait(&semaphore_) != 0) continue;  // interrupted by a process signal
  }

 private:
  sem_t semaphore_;
};

class RosPublisher::Impl {
 public:
  explicit Impl(const RosOptions& options) : outbox_(valid(options)), writers_(options), thread_([this] { run(); }) {}
  ~Impl() {
    ending_.store(true, std::memory_order_release);
    bell_.ring();
    thread_.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  template <class What> void put(const What& what) {
    if (outbox_.put(what)) bell_.ring();
  }

  RosCounts counts() const {
    const auto counts_of = [](const Writer::Counts& written, std::uint64_t dropped) {
      return TopicCounts{written.written, dropped, written.refused, written.deadlines_missed};
    };
    const Outbox::Dropped dropped = outbox_.dropped();
    const std::scoped_lock lock(mutex_);
    return {counts_of(written_.images, dropped.images),   counts_of(written_.boxes, 0),
            counts_of(written_.tracks, dropped.steps),    counts_of(written_.truths, dropped.truths),
            counts_of(written_.healths, dropped.healths), dropped.cut};
  }

 private:
  void run() {
    for (bool ending = false; !ending;) {
      bell_.wait();
      ending = ending_.load(std::memory_order_acquire);
      while (write_all(outbox_.images) || write_all(outbox_.steps) || write_all(outbox_.truths) ||
             write_all(outbox_.healths))
        continue;
      const std::scoped_lock lock(mutex_);
      written_ = {writers_.images(), writers_.boxes(), writers_.tracks(), writers_.truths(), writers_.healths()};
    }
  }

  // Returns whether any item waited.
  template <class Slot> bool write_all(Ring<Slot>& ring) {
    if (ring.first() == nullptr) return false;
    for (const Slot* slot; (slot = ring.first()) != nullptr; ring.pop()) writers_.write(*slot);
    return true;
  }

  struct Written {
    Writer::Counts images, boxes, tracks, truths, healths;
  };

  Outbox outbox_;
  Writers writers_;  // used by the thread only
  Bell bell_;
  std::atomic<bool> ending_{false};
  mutable std::mutex mutex_;  // between the thread and callers of counts()
  Written written_;           // guarded by mutex_
  std::thread thread_;        // last, because it uses all of the above
};

RosPublisher::RosPublisher(const RosOptions& options) : impl_(std::make_unique<Impl>(options)) {}
RosPublisher::~RosPublisher() = default;

void RosPublisher::on(const recording::records::ImageWritten& image) { impl_->put(image); }
void RosPublisher::on(const recording::records::TrackState& track) { impl_->put(track); }
void RosPublisher::on(const recording::records::FusionStep& step) { impl_->put(step); }
void RosPublisher::on(const recording::records::TruthState& truth) { impl_->put(truth); }
void RosPublisher::health(const Health& health) { impl_->put(health); }
RosCounts RosPublisher::counts() const { return impl_->counts(); }

}  // namespace ttf::bus::dds::ros
