// A member's reactions to the samples that it receives.
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "bus/dds/exchange/member.h"

namespace ttf::bus::dds::exchange {
namespace {

// The bytes received between two kReceived, which let the others forget them.
constexpr std::size_t kReportEvery = 256 << 10;
// The approximate memory of a kept sample beside its bytes.
constexpr std::size_t kSampleBytes = 96;

common::Bytes copy(std::span<const std::byte> bytes) {
  return std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
}

}  // namespace

bool Exchange::Member::take() {
  const bool data = data_.take([this](const common::Said& said) { on_data(said); });
  const bool control = control_.take([this](const common::Said& said) { on_control(said); });
  return data || control;
}

// Before the end of a member is agreed on, all its samples that DDS has brought count as received.
void Exchange::Member::drain_data() {
  while (data_.take([this](const common::Said& said) { on_data(said); })) {
  }
}

Exchange::Member::Other& Exchange::Member::other(NodeId node) {
  const auto found = others_.find(node);
  if (found == others_.end())
    throw std::runtime_error(fmt::format("session {} on DDS domain {}: node {} {}", session_.name, session_.domain,
                                         index_of(node), node == self_ ? "is there twice" : "is not a member"));
  return found->second;
}

void Exchange::Member::on_data(const common::Said& said) {
  Other& sender = other(said.sender);
  sender.stream.accept({said.number, said.kind, copy(said.bytes)}, entries_);
  deliver(said.sender);
  received_bytes_ += kSampleBytes + said.bytes.size();
  if (session_.supervised && received_bytes_ >= kReportEvery) report_received();
}

void Exchange::Member::report_received() {
  ReceivedCounts received;
  for (const auto& [id, state] : others_) received[id] = state.stream.received();
  const std::vector<std::byte> bytes = encode(received);
  control_.say({.sender = self_, .kind = common::Kind::kReceived, .bytes = bytes});
  received_bytes_ = 0;
}

void Exchange::Member::deliver(NodeId from) {
  for (common::Entry& entry : entries_) {
    if (entry.kind == common::Kind::kHello) data_hello_.insert(from);
    if (entry.kind == common::Kind::kMessage) coming_.push_back({from, std::move(entry.bytes)});
    if (entry.kind == common::Kind::kBye) {
      coming_.push_back({from, nullptr});
      gone_.insert(from);
      received_table_.without(from);
    }
  }
  entries_.clear();
  confirm(from, other(from));
}

void Exchange::Member::on_control(const common::Said& said) {
  if (said.sender != common::kSupervisor) other(said.sender);
  if (!control_numbers_.is_new(said.sender, said.number)) return;
  switch (said.kind) {
    case common::Kind::kHello: control_hello_.insert(said.sender); return;
    case common::Kind::kReady: ready_.insert(said.sender); return;
    case common::Kind::kBye:
      if (said.sender == common::kSupervisor) supervisor_left_ = true;
      return;
    case common::Kind::kFence: on_fence(said); return;
    case common::Kind::kClose: on_close(said); return;
    case common::Kind::kAgain: on_again(said); return;
    case common::Kind::kAllAgain:
      if (const Other& about = other(said.about); about.round == said.round && about.stream.wanting())
        throw std::runtime_error(about.stream.missing());
      return;
    case common::Kind::kReceived:
      received_table_.note(said.sender, decode(said.bytes));
      for (auto& [id, state] : others_) state.stream.settle(received_table_.by_all(id));
      return;
    case common::Kind::kReport:
    case common::Kind::kClosed: return;  // for the supervisor
    case common::Kind::kMessage: throw std::runtime_error("exchange: a control sample carries a message");
  }
}

void Exchange::Member::on_fence(const common::Said& said) {
  if (said.about == self_) {
    cut_off_ = true;
    return;
  }
  Other& about = other(said.about);
  drain_data();
  last_death_ = Clock::now();
  received_table_.without(said.about);
  const std::uint64_t end = about.stream.fence();
  control_.say({.sender = self_, .kind = common::Kind::kReport, .about = said.about, .round = said.round, .end = end});
}

void Exchange::Member::on_close(const common::Said& said) {
  if (said.about == self_) return;
  Other& about = other(said.about);
  about.round = said.round;
  about.confirmed = false;
  about.stream.close(said.end, entries_);
  deliver(said.about);
  if (said.holder != self_) return;
  for (const common::Entry& entry : about.stream.again(said.first))
    control_.say({.sender = self_,
                  .kind = common::Kind::kAgain,
                  .about = said.about,
                  .inner = entry.kind,
                  .round = said.round,
                  .first = entry.number,
                  .bytes = *entry.bytes});
  control_.say({.sender = self_, .kind = common::Kind::kAllAgain, .about = said.about, .round = said.round});
}

void Exchange::Member::on_again(const common::Said& said) {
  if (said.about == self_) return;
  other(said.about).stream.accept({said.first, said.inner, copy(said.bytes)}, entries_);
  deliver(said.about);
}

void Exchange::Member::confirm(NodeId of, Other& other) {
  if (other.round == 0 || other.confirmed || !other.stream.closed()) return;
  other.confirmed = true;
  control_.say({.sender = self_, .kind = common::Kind::kClosed, .about = of, .round = other.round});
}

}  // namespace ttf::bus::dds::exchange
