#include "bus/dds/exchange/channel.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bus/dds/common/qos.h"
#include "bus/dds/exchange/exchange_sample.h"

namespace ttf::bus::dds::exchange {
namespace {

constexpr std::size_t kBatch = 64;      // samples taken at a time
constexpr std::int32_t kHistory = 256;  // kept for returning readers
constexpr std::uint32_t kConnections = DDS_SUBSCRIPTION_MATCHED_STATUS | DDS_LIVELINESS_CHANGED_STATUS;

common::Qos qualities() {
  common::Qos qos = common::new_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_resource_limits(qos.get(), DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, kHistory, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

common::Said said_in(const ttf_ExchangeSample& sample) {
  if (sample.kind >= common::kKinds || sample.inner >= common::kKinds)
    throw std::runtime_error(fmt::format("exchange: node {} sent a sample of unknown kind {}; its version may differ",
                                         sample.sender, sample.kind));
  return {.sender = NodeId{sample.sender},
          .kind = common::Kind{sample.kind},
          .about = NodeId{sample.about},
          .holder = NodeId{sample.holder},
          .inner = common::Kind{sample.inner},
          .round = sample.round,
          .number = sample.number,
          .first = sample.first,
          .end = sample.end,
          .bytes = std::as_bytes(std::span(sample.bytes._buffer, sample.bytes._length))};
}

}  // namespace

Channel::Channel(const common::Participant& participant, const std::string& topic, const std::string& session) {
  const common::Handle parent = participant.handle();
  const common::Qos qos = qualities();
  const common::Qos within = common::partition(session);
  topic_ = common::checked(dds_create_topic(parent, &ttf_ExchangeSample_desc, topic.c_str(), nullptr, nullptr),
                           "cannot make topic " + topic);
  const common::Handle publisher =
      common::checked(dds_create_publisher(parent, within.get(), nullptr), "cannot make a publisher");
  const common::Handle subscriber =
      common::checked(dds_create_subscriber(parent, within.get(), nullptr), "cannot make a subscriber");
  reader_ =
      common::checked(dds_create_reader(subscriber, topic_, qos.get(), nullptr), "cannot make a reader of " + topic);
  common::checked(dds_set_status_mask(reader_, kConnections), "cannot watch the reader of " + topic);
  reading_ = common::checked(dds_create_readcondition(reader_, DDS_ANY_STATE), "cannot watch the reader of " + topic);
  writer_ =
      common::checked(dds_create_writer(publisher, topic_, qos.get(), nullptr), "cannot make a writer of " + topic);
}

Channel::~Channel() = default;  // the participant ends it all

void Channel::say(common::Said said) {
  ttf_ExchangeSample sample{};
  sample.sender = static_cast<std::uint8_t>(said.sender);
  sample.kind = static_cast<std::uint8_t>(said.kind);
  sample.about = static_cast<std::uint8_t>(said.about);
  sample.holder = static_cast<std::uint8_t>(said.holder);
  sample.inner = static_cast<std::uint8_t>(said.inner);
  sample.round = said.round;
  sample.number = next_number_;
  sample.first = said.first;
  sample.end = said.end;
  sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(said.bytes.size());
  // The buffer is only read; C cannot declare that here.
  sample.bytes._buffer = reinterpret_cast<std::uint8_t*>(const_cast<std::byte*>(said.bytes.data()));
  common::checked(dds_write(writer_, &sample), "cannot write");
  ++next_number_;
}

bool Channel::take(const std::function<void(const ttf::bus::dds::common::Said&)>& visit) {
  std::array<void*, kBatch> samples{};
  std::array<dds_sample_info_t, kBatch> infos;
  const auto count = common::checked(dds_take(reader_, samples.data(), infos.data(), kBatch, kBatch), "cannot read");
  if (count == 0) return false;
  const auto give_back = [this, count](void** loan) { dds_return_loan(reader_, loan, count); };
  const std::unique_ptr<void*, decltype(give_back)> loan(samples.data(), give_back);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    if (!infos[i].valid_data) continue;  // a writer has come or gone
    const common::Said said = said_in(*static_cast<const ttf_ExchangeSample*>(samples[i]));
    auto& writer = writers_[index_of(said.sender)];
    if (writer != infos[i].publication_handle) changed_ = true;
    writer = infos[i].publication_handle;
    visit(said);
  }
  return true;
}

bool Channel::acknowledged_within(std::chrono::nanoseconds patience) const {
  return dds_wait_for_acks(writer_, patience.count()) == DDS_RETCODE_OK;
}

bool Channel::connections_changed() {
  std::uint32_t status = 0;
  common::checked(dds_take_status(reader_, &status, kConnections), "cannot list the writers");
  return std::exchange(changed_, false) || status != 0;
}

bool Channel::lost(NodeId sender) const {
  const std::uint64_t writer = writers_[index_of(sender)];
  if (writer == 0) return false;
  std::vector<dds_instance_handle_t> matched(256);
  const auto count =
      common::checked(dds_get_matched_publications(reader_, matched.data(), matched.size()), "cannot list the writers");
  matched.resize(std::min<std::size_t>(matched.size(), static_cast<std::size_t>(count)));
  return std::find(matched.begin(), matched.end(), writer) == matched.end();
}

}  // namespace ttf::bus::dds::exchange
