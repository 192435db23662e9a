#include "bus/dds/live/medium.h"

#include <algorithm>
#include <span>
#include <thread>

#include "core/check.h"

namespace ttf::bus::dds::live {
namespace {

constexpr auto kLookAgain = std::chrono::milliseconds(5);

void merge(std::vector<NodeId>& into, const std::vector<NodeId>& more) {
  into.insert(into.end(), more.begin(), more.end());
  std::sort(into.begin(), into.end());
  into.erase(std::unique(into.begin(), into.end()), into.end());
}

}  // namespace

DdsMedium::DdsMedium(const common::Session& session, NodeId self, const std::vector<LiveLinePlan>& lines,
                     Delivery delivery)
    : session_(validate(session)), participant_(session.domain, session.lease) {
  for (const LiveLinePlan& plan : lines) {
    if (plan.line >= lines_.size()) lines_.resize(plan.line + 1);
    TTF_CHECK(lines_[plan.line] == nullptr, "line {} twice", plan.line);
    lines_[plan.line] = std::make_unique<LiveLine>(participant_, session.name, self, plan, delivery);
  }
}

DdsMedium::~DdsMedium() = default;

void DdsMedium::wait_ready(std::chrono::milliseconds patience) const {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (;;) {
    std::vector<NodeId> absent, deaf;
    for (const auto& line : lines_) {
      if (line == nullptr) continue;
      merge(absent, line->missing_senders());
      merge(deaf, line->deaf());
    }
    if (absent.empty() && deaf.empty()) return;
    if (std::chrono::steady_clock::now() > deadline) throw common::NotReady(session_, patience, absent, deaf);
    std::this_thread::sleep_for(kLookAgain);
  }
}

ports::LiveStatus DdsMedium::send(const ports::LiveSignal& signal, ports::MachineTime due) {
  LiveLine* const line = find(ports::line_of(signal.channel));
  TTF_CHECK(line != nullptr, "not on channel {}", static_cast<int>(signal.channel));
  return counted(line->send(signal, due));
}

ports::LiveStatus DdsMedium::send_can(std::size_t can_bus, const ports::CanFrame& frame) {
  LiveLine* const line = find(ports::line_of_can(can_bus));
  TTF_CHECK(line != nullptr, "not on CAN {}", can_bus);
  return counted(line->send(frame));
}

std::optional<ports::LiveArrival> DdsMedium::receive() {
  for (const auto& line : lines_) {
    if (line == nullptr || !line->queue().pop(last_)) continue;
    ++received_;
    ports::LiveArrival arrival = last_.arrival;
    const auto bytes = std::span<const std::byte>(last_.bytes).first(last_.size);
    if (arrival.kind == ports::LiveArrival::Kind::kCan)
      arrival.can.data = bytes;
    else
      arrival.signal.bytes = bytes;
    return arrival;
  }
  return {};
}

int DdsMedium::descriptor(ports::Line line) const {
  const LiveLine* const found = find(line);
  return found == nullptr ? -1 : found->queue().descriptor();
}

void DdsMedium::watch(ports::Line line, bool on) {
  if (LiveLine* const found = find(line)) found->queue().watch(on);
}

ports::LiveCounts DdsMedium::counts() const {
  ports::LiveCounts counts{.sent = sent_, .received = received_, .not_sent = not_sent_};
  for (const auto& line : lines_) {
    if (line == nullptr) continue;
    counts.lost += line->lost();
    counts.foreign += line->foreign();
    counts.malformed += line->malformed();
  }
  return counts;
}

const std::string& DdsMedium::failure() const {
  for (const auto& line : lines_)
    if (failure_.empty() && line != nullptr) failure_ = line->failure();
  return failure_;
}

LiveLine* DdsMedium::find(ports::Line line) const { return line < lines_.size() ? lines_[line].get() : nullptr; }

ports::LiveStatus DdsMedium::counted(ports::LiveStatus status) {
  if (status == ports::LiveStatus::kDone) ++sent_;
  if (status == ports::LiveStatus::kNoRoom) ++not_sent_;
  return status;
}

}  // namespace ttf::bus::dds::live
