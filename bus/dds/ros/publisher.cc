#include "bus/dds/ros/publisher.h"

#include <atomic>
#include <mutex>
#include <thread>

#include "bus/dds/ros/bell.h"
#include "bus/dds/ros/outbox.h"
#include "bus/dds/ros/writers.h"

namespace ttf::bus::dds::ros {
namespace {

TopicCounts counts_of(const Writer::Counts& written, std::uint64_t dropped) {
  return {written.written, dropped, written.refused, written.deadlines_missed};
}

const RosOptions& valid(const RosOptions& options) {
  validate(options);
  return options;
}

}  // namespace

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
