#include "bus/dds/live/reception.h"

#include <dds/dds.h>

#include <algorithm>
#include <utility>

#include "bus/dds/common/host_identity.h"
#include "bus/dds/common/qos.h"
#include "bus/dds/live/endpoints.h"
#include "bus/dds/live/live_sample.h"
#include "bus/dds/live/sample_check.h"
#include "bus/wire/flexray_frame.h"

namespace ttf::bus::dds::live {
namespace {

constexpr std::size_t kBoxes = 16;  // samples taken at a time

bool is_can(ports::Line line) { return line >= ports::line_of_can(0); }

}  // namespace

// Preallocated. DDS fills sequences in our memory up to their maximum, and no further.
struct Reception::Boxes {
  // One byte beyond the longest, so that longer samples show.
  std::array<std::array<std::uint8_t, wire::kMaxFrameBytes + 1>, kBoxes> bytes{};
  std::array<ttf_LiveSample, kBoxes> in{};
  std::array<void*, kBoxes> pointers{};
  std::array<dds_sample_info_t, kBoxes> infos{};

  Boxes() {
    for (std::size_t i = 0; i < kBoxes; ++i) {
      pointers[i] = &in[i];
      in[i].bytes._buffer = bytes[i].data();
      in[i].bytes._maximum = static_cast<std::uint32_t>(bytes[i].size());
    }
  }
};

Reception::Reception(const common::Participant& participant, const std::string& session, const std::string& topic,
                     Setting setting, Delivery delivery)
    : topic_(topic), setting_(std::move(setting)), host_(common::host_identity()), boxes_(std::make_unique<Boxes>()),
      from_afar_(setting_.nodes.size()) {
  for (const NodeId node : setting_.nodes) is_on_[index_of(node)] = node != setting_.self;
  const common::Handle parent = participant.handle();
  const common::Qos within = common::partition(session), qos = live_qualities(delivery, setting_.self);
  const common::Handle made = common::checked(
      dds_create_topic(parent, &ttf_LiveSample_desc, topic_.c_str(), nullptr, nullptr), "cannot make topic " + topic_);
  const common::Handle subscriber =
      common::checked(dds_create_subscriber(parent, within.get(), nullptr), "cannot make a subscriber");
  const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> listener(dds_create_listener(this),
                                                                                 dds_delete_listener);
  dds_lset_data_available(listener.get(), &Reception::on_data);
  reader_ = common::checked(dds_create_reader(subscriber, made, qos.get(), listener.get()),
                            "cannot make a reader of " + topic_);
}

// After the reader is deleted no calls come; the participant ends the rest.
Reception::~Reception() { dds_delete(reader_); }

void Reception::on_data(common::Handle reader, void* self) { static_cast<Reception*>(self)->take(reader); }

// DDS calls this for one reader from one thread at a time, so the boxes and the filling end of the queue are
// its own. The first call may come before the constructor has the reader.
void Reception::take(common::Handle reader) {
  for (bool more = true; more;) {
    const auto count = dds_take(reader, boxes_->pointers.data(), boxes_->infos.data(), kBoxes, kBoxes);
    if (count < 0) return take_error_.store(count);
    const ports::MachineTime now = ports::host_now();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (boxes_->infos[i].valid_data) accept(i, now);  // otherwise a writer has come or gone
    more = static_cast<std::size_t>(count) == kBoxes;
  }
}

void Reception::accept(std::size_t box, ports::MachineTime now) {
  const ttf_LiveSample& sample = boxes_->in[box];
  const NodeId sender{sample.sender};
  if (!is_on_[sample.sender]) {
    ++foreign_;
    return refuse(box, now);
  }
  if (!well_formed(sample, setting_.line) || !of_a_clock(sample)) {
    ++malformed_;
    return refuse(box, now);
  }
  const auto missing = numbering_.missing_before(sender, sample.incarnation, sample.number);
  if (!missing) return refuse(box, now);
  lost_ += *missing;
  const bool is_symbol = !is_can(setting_.line) && sample.kind != static_cast<int>(ports::Signal::kFrame);
  if (setting_.only && is_symbol) return;
  LiveItem* const item = room_for(box);
  if (item == nullptr) return;
  ports::LiveArrival& arrival = item->arrival;
  arrival.received = now;
  if (host_ == 0 || sample.host == 0) {
    arrival.at = now;  // the sender's clock is unknown
  } else if (sample.host == host_) {
    arrival.at = std::min(ports::MachineTime{sample.sent}, now);
    arrival.left = arrival.at;
  } else {
    arrival.at = from_afar_.of(sender, sample.host, sample.sent, now);
  }
  if (!is_can(setting_.line)) {
    arrival.signal.signal = static_cast<ports::Signal>(sample.kind);
    arrival.signal.duration = Duration::nanoseconds(sample.duration);
    arrival.signal.states_late = sample.tells_late == 1;
    if (arrival.signal.states_late) arrival.late = Duration::nanoseconds(sample.late);
  }
  item->size = sample.bytes._length;
  std::copy_n(reinterpret_cast<const std::byte*>(sample.bytes._buffer), item->size, item->bytes.begin());
  queue_.push();
}

// Nodes never use such a sample; a listener reports it.
void Reception::refuse(std::size_t box, ports::MachineTime now) {
  LiveItem* const item = setting_.only ? room_for(box) : nullptr;
  if (item == nullptr) return;
  item->malformed = true;
  item->arrival.at = item->arrival.received = now;
  queue_.push();
}

// Returns a place with the sample's identifier; null for one that is not received, or without room.
LiveItem* Reception::room_for(std::size_t box) {
  const ttf_LiveSample& sample = boxes_->in[box];
  const std::uint32_t identifier = is_can(setting_.line) ? sample.identifier : sample.slot;
  if (setting_.only && (identifier >= setting_.only->size() || !setting_.only->test(identifier))) return nullptr;
  LiveItem* const item = queue_.room();
  if (item == nullptr) {
    ++lost_;
    return nullptr;
  }
  ports::LiveArrival& arrival = item->arrival = {};
  item->malformed = false;
  item->size = 0;
  if (is_can(setting_.line)) {
    arrival.kind = ports::LiveArrival::Kind::kCan;
    arrival.can_bus = setting_.line - ports::line_of_can(0);
    arrival.can.identifier = sample.identifier;
    arrival.can.flexible_data_rate = sample.kind == kFastCan;
  } else {
    arrival.signal.channel = static_cast<schedules::model::Channel>(setting_.line);
    arrival.signal.slot = sample.slot;
  }
  return item;
}

std::vector<NodeId> Reception::senders() const {
  std::vector<dds_instance_handle_t> matched(kMostEndpoints);
  const auto count = common::checked(dds_get_matched_publications(reader_, matched.data(), matched.size()),
                                     "cannot list the nodes on " + topic_);
  matched.resize(std::min(matched.size(), static_cast<std::size_t>(count)));
  return owners(reader_, matched, dds_get_matched_publication_data);
}

}  // namespace ttf::bus::dds::live
