#include "bus/dds/live/line.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "bus/dds/common/host_identity.h"
#include "bus/dds/common/qos.h"
#include "bus/dds/live/live_sample.h"
#include "bus/wire/flexray_frame.h"
#include "core/check.h"

namespace ttf::bus::dds::live {
namespace {

constexpr std::size_t kBoxes = 16;           // samples taken at a time
constexpr std::size_t kMostEndpoints = 256;  // on one line

// Larger instants and durations (a century, eleven days) come from no clock.
constexpr std::int64_t kLatest = 4'000'000'000'000'000'000, kLongest = 1'000'000'000'000'000;

// LiveSample::kind: a ports::Signal, or one of these.
constexpr std::uint8_t kClassicCan = 4, kFastCan = 5;

common::Qos live_qualities(Delivery delivery, NodeId self) {
  common::Qos qos = common::new_qos();
  dds_qset_reliability(qos.get(),
                       delivery == Delivery::kReliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, LiveLine::kHistory);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  dds_qset_userdata(qos.get(), &self, sizeof self);  // names the node that is missing
  return qos;
}

bool is_can_length(std::size_t size, bool fast) {
  static constexpr std::array<std::size_t, 7> kFast{12, 16, 20, 24, 32, 48, 64};
  return size <= 8 || (fast && std::find(kFast.begin(), kFast.end(), size) != kFast.end());
}

// Returns whether the sample's fields are consistent for this line.
bool well_formed(const ttf_LiveSample& sample, ports::Line line) {
  const std::size_t size = sample.bytes._length;
  const bool is_frame = line < ports::line_of_can(0) && sample.kind == static_cast<int>(ports::Signal::kFrame);
  if (sample.tells_late > 1 || (sample.tells_late == 1 && !is_frame)) return false;
  if (line >= ports::line_of_can(0))
    return (sample.kind == kClassicCan || sample.kind == kFastCan) && sample.identifier <= 0x7FF &&
           is_can_length(size, sample.kind == kFastCan);
  if (is_frame)
    return sample.slot >= 1 && sample.slot <= 2047 && size >= wire::kHeaderBytes + wire::kTrailerBytes &&
           size <= wire::kMaxFrameBytes;
  return sample.kind <= static_cast<int>(ports::Signal::kUndecodable) && size == 0 && sample.duration > 0;
}

// Returns whether a clock may show the sample's instants.
bool of_a_clock(const ttf_LiveSample& sample) {
  return sample.sent >= 0 && sample.sent <= kLatest && sample.late >= -kLongest && sample.late <= kLongest &&
         sample.duration >= 0 && sample.duration <= kLongest;
}

// Returns the nodes named by matched readers or writers.
std::vector<NodeId> owners(common::Handle entity, const std::vector<dds_instance_handle_t>& matched,
                           dds_builtintopic_endpoint_t* (*data)(dds_entity_t, dds_instance_handle_t)) {
  std::vector<NodeId> nodes;
  for (const dds_instance_handle_t handle : matched) {
    dds_builtintopic_endpoint_t* const endpoint = data(entity, handle);
    if (endpoint == nullptr) continue;  // it has just gone
    void* said = nullptr;
    std::size_t size = 0;
    if (dds_qget_userdata(endpoint->qos, &said, &size) && size == sizeof(NodeId))
      nodes.push_back(*static_cast<const NodeId*>(said));
    dds_free(said);
    dds_builtintopic_free_endpoint(endpoint);
  }
  return nodes;
}

}  // namespace

// Preallocated. DDS fills sequences in our memory up to their maximum, and no further.
struct LiveLine::Boxes {
  // One byte beyond the longest, so that longer samples show.
  std::array<std::array<std::uint8_t, wire::kMaxFrameBytes + 1>, kBoxes> bytes{};
  std::array<ttf_LiveSample, kBoxes> in{};
  std::array<void*, kBoxes> pointers{};
  std::array<dds_sample_info_t, kBoxes> infos{};
  ttf_LiveSample out{};

  Boxes() {
    for (std::size_t i = 0; i < kBoxes; ++i) {
      pointers[i] = &in[i];
      in[i].bytes._buffer = bytes[i].data();
      in[i].bytes._maximum = static_cast<std::uint32_t>(bytes[i].size());
    }
  }
};

LiveLine::LiveLine(const common::Participant& participant, const std::string& session, NodeId self,
                   const LiveLinePlan& plan, Delivery delivery)
    : line_(plan.line), topic_(plan.topic), self_(self), host_(common::host_identity()), nodes_(plan.nodes),
      boxes_(std::make_unique<Boxes>()), from_afar_(plan.nodes.size()) {
  for (const NodeId node : nodes_) is_on_[index_of(node)] = true;
  boxes_->out.sender = static_cast<std::uint8_t>(self);
  boxes_->out.host = host_;
  boxes_->out.incarnation = static_cast<std::uint64_t>(ports::host_now().ns);
  const common::Handle parent = participant.handle();
  const common::Qos qos = live_qualities(delivery, self);
  const common::Qos within = common::partition(session);
  const common::Handle topic = common::checked(
      dds_create_topic(parent, &ttf_LiveSample_desc, topic_.c_str(), nullptr, nullptr), "cannot make topic " + topic_);
  const common::Handle publisher =
      common::checked(dds_create_publisher(parent, within.get(), nullptr), "cannot make a publisher");
  const common::Handle subscriber =
      common::checked(dds_create_subscriber(parent, within.get(), nullptr), "cannot make a subscriber");
  writer_ =
      common::checked(dds_create_writer(publisher, topic, qos.get(), nullptr), "cannot make a writer of " + topic_);
  const std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)> listener(dds_create_listener(this),
                                                                                 dds_delete_listener);
  dds_lset_data_available(listener.get(), &LiveLine::on_data);
  reader_ = common::checked(dds_create_reader(subscriber, topic, qos.get(), listener.get()),
                            "cannot make a reader of " + topic_);
}

// After the reader is deleted no calls come; the participant ends the rest.
LiveLine::~LiveLine() { dds_delete(reader_); }

void LiveLine::on_data(common::Handle reader, void* self) { static_cast<LiveLine*>(self)->take(reader); }

// DDS calls this for one reader from one thread at a time, so the boxes and the filling end of the queue are
// its own. The first call may come before the constructor knows the reader.
void LiveLine::take(common::Handle reader) {
  for (bool more = true; more;) {
    const auto count = dds_take(reader, boxes_->pointers.data(), boxes_->infos.data(), kBoxes, kBoxes);
    if (count < 0) return take_error_.store(count);
    const ports::MachineTime now = ports::host_now();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      if (boxes_->infos[i].valid_data) accept(i, now);  // otherwise a writer has come or gone
    more = static_cast<std::size_t>(count) == kBoxes;
  }
}

void LiveLine::accept(std::size_t box, ports::MachineTime now) {
  const ttf_LiveSample& sample = boxes_->in[box];
  const NodeId sender{sample.sender};
  if (!is_on_[sample.sender] || sender == self_) {
    ++foreign_;
    return;
  }
  if (!well_formed(sample, line_) || !of_a_clock(sample)) {
    ++malformed_;
    return;
  }
  const auto missing = numbering_.missing_before(sender, sample.incarnation, sample.number);
  if (!missing) return;
  lost_ += *missing;
  LiveItem* const item = queue_.room();
  if (item == nullptr) {
    ++lost_;
    return;
  }
  ports::LiveArrival& arrival = item->arrival = {};
  arrival.received = now;
  if (host_ == 0 || sample.host == 0) {
    arrival.at = now;  // the sender's clock is unknown
  } else if (sample.host == host_) {
    arrival.at = std::min(ports::MachineTime{sample.sent}, now);
    arrival.left = arrival.at;
  } else {
    arrival.at = from_afar_.of(sender, sample.host, sample.sent, now);
  }
  if (line_ >= ports::line_of_can(0)) {
    arrival.kind = ports::LiveArrival::Kind::kCan;
    arrival.can_bus = line_ - ports::line_of_can(0);
    arrival.can.identifier = sample.identifier;
    arrival.can.flexible_data_rate = sample.kind == kFastCan;
  } else {
    arrival.signal.channel = static_cast<schedules::model::Channel>(line_);
    arrival.signal.signal = static_cast<ports::Signal>(sample.kind);
    arrival.signal.slot = sample.slot;
    arrival.signal.duration = Duration::nanoseconds(sample.duration);
    arrival.signal.tells_late = sample.tells_late == 1;
    if (arrival.signal.tells_late) arrival.late = Duration::nanoseconds(sample.late);
  }
  item->size = sample.bytes._length;
  std::copy_n(reinterpret_cast<const std::byte*>(sample.bytes._buffer), item->size, item->bytes.begin());
  queue_.push();
}

ports::LiveStatus LiveLine::send(const ports::LiveSignal& signal, ports::MachineTime due) {
  ttf_LiveSample& sample = boxes_->out;
  sample.kind = static_cast<std::uint8_t>(signal.signal);
  sample.slot = static_cast<std::uint16_t>(signal.slot);
  sample.duration = signal.duration.ns;
  sample.tells_late = signal.tells_late ? 1 : 0;
  return write(signal.bytes, due);
}

ports::LiveStatus LiveLine::send(const ports::CanFrame& frame) {
  boxes_->out.kind = frame.flexible_data_rate ? kFastCan : kClassicCan;
  boxes_->out.identifier = frame.identifier;
  boxes_->out.tells_late = 0;
  return write(frame.data, {});
}

ports::LiveStatus LiveLine::write(std::span<const std::byte> bytes, ports::MachineTime due) {
  ttf_LiveSample& sample = boxes_->out;
  sample.number = next_number_;
  sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(bytes.size());
  // The buffer is only read; C cannot declare that here.
  sample.bytes._buffer = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(bytes.data()));
  TTF_CHECK(well_formed(sample, line_), "line {}: kind {}, slot {}, identifier {}, {} bytes, {} ns", line_, sample.kind,
            sample.slot, sample.identifier, bytes.size(), sample.duration);
  sample.sent = ports::host_now().ns;
  sample.late = sample.tells_late == 1 ? sample.sent - due.ns : 0;
  const auto result = dds_write(writer_, &sample);
  if (result == DDS_RETCODE_TIMEOUT || result == DDS_RETCODE_OUT_OF_RESOURCES) return ports::LiveStatus::kNoRoom;
  if (result < 0) {
    write_error_ = result;
    return ports::LiveStatus::kFailed;
  }
  ++next_number_;
  return ports::LiveStatus::kDone;
}

std::string LiveLine::failure() const {
  if (write_error_ != 0) return fmt::format("DDS: cannot write on {}: {}", topic_, dds_strretcode(-write_error_));
  const std::int32_t error = take_error_.load();
  return error == 0 ? std::string() : fmt::format("DDS: cannot read from {}: {}", topic_, dds_strretcode(-error));
}

std::vector<NodeId> LiveLine::unheard() const {
  std::vector<dds_instance_handle_t> matched(kMostEndpoints);
  const auto count = common::checked(dds_get_matched_publications(reader_, matched.data(), matched.size()),
                                     "cannot list the nodes on " + topic_);
  matched.resize(std::min(matched.size(), static_cast<std::size_t>(count)));
  return all_but(owners(reader_, matched, dds_get_matched_publication_data));
}

std::vector<NodeId> LiveLine::deaf() const {
  std::vector<dds_instance_handle_t> matched(kMostEndpoints);
  const auto count = common::checked(dds_get_matched_subscriptions(writer_, matched.data(), matched.size()),
                                     "cannot list the nodes on " + topic_);
  matched.resize(std::min(matched.size(), static_cast<std::size_t>(count)));
  return all_but(owners(writer_, matched, dds_get_matched_subscription_data));
}

std::vector<NodeId> LiveLine::all_but(const std::vector<NodeId>& found) const {
  std::vector<NodeId> missing;
  for (const NodeId node : nodes_)
    if (node != self_ && std::find(found.begin(), found.end(), node) == found.end()) missing.push_back(node);
  return missing;
}

std::string live_topic(schedules::model::Channel channel) {
  return channel == schedules::model::Channel::kA ? "ttf/flexray/A" : "ttf/flexray/B";
}

std::string live_can_topic(const std::string& name) {
  const auto is_hexadecimal = [&name](std::size_t at) {
    return at < name.size() && ((name[at] >= '0' && name[at] <= '9') || (name[at] >= 'A' && name[at] <= 'F'));
  };
  std::string topic = "ttf/can/";
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto letter = static_cast<unsigned char>(name[i]);
    const bool mistaken = letter == '_' && is_hexadecimal(i + 1) && is_hexadecimal(i + 2);
    if (letter < 128 && (std::isalnum(letter) != 0 || letter == '_') && !mistaken)
      topic += name[i];
    else
      topic += fmt::format("_{:02X}", letter);
  }
  return topic;
}

}  // namespace ttf::bus::dds::live
