#include "bus/dds/live/medium.h"

#include <algorithm>
#include <span>
#include <thread>

#include "core/check.h"

namespace ttf::dds {
namespace {

constexpr auto kLookAgain = std::chrono::milliseconds(5);

void merge(std::vector<NodeId>& into, const std::vector<NodeId>& more) {
  into.insert(into.end(), more.begin(), more.end());
  std::sort(into.begin(), into.end());
  into.erase(std::unique(into.begin(), into.end()), into.end());
}

}  // namespace

LiveMedium::LiveMedium(const Session& session, NodeId self, const std::vector<LiveLinePlan>& lines, Delivery delivery)
    : session_(validate(session)), participant_(session.domain, session.lease) {
  for (const LiveLinePlan& plan : lines) {
    if (plan.line >= lines_.size()) lines_.resize(plan.line + 1);
    TTF_CHECK(lines_[plan.line] == nullptr, "line {} twice", plan.line);
    lines_[plan.line] = std::make_unique<LiveLine>(participant_, session.name, self, plan, delivery);
  }
}

LiveMedium::~LiveMedium() = default;

void LiveMedium::wait_ready(std::chrono::milliseconds patience) const {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (;;) {
    std::vector<NodeId> absent, deaf;
    for (const auto& line : lines_) {
      if (line == nullptr) continue;
      merge(absent, line->unheard());
      merge(deaf, line->deaf());
    }
    if (absent.empty() && deaf.empty()) return;
    if (std::chrono::steady_clock::now() > deadline) throw NotReady(session_, patience, absent, deaf);
    std::this_thread::sleep_for(kLookAgain);
  }
}

bus::LiveStatus LiveMedium::send(const bus::LiveSignal& signal, bus::HostTime due) {
  LiveLine* const line = find(bus::line_of(signal.channel));
  TTF_CHECK(line != nullptr, "not on channel {}", static_cast<int>(signal.channel));
  return counted(line->send(signal, due));
}

bus::LiveStatus LiveMedium::send_can(std::size_t can_bus, const bus::CanFrame& frame) {
  LiveLine* const line = find(bus::line_of_can(can_bus));
  TTF_CHECK(line != nullptr, "not on CAN {}", can_bus);
  return counted(line->send(frame));
}

std::optional<bus::LiveArrival> LiveMedium::receive() {
  for (const auto& line : lines_) {
    if (line == nullptr || !line->queue().pop(last_)) continue;
    ++received_;
    bus::LiveArrival arrival = last_.arrival;
    const auto bytes = std::span<const std::byte>(last_.bytes).first(last_.size);
    if (arrival.kind == bus::LiveArrival::Kind::kCan)
      arrival.can.data = bytes;
    else
      arrival.signal.bytes = bytes;
    return arrival;
  }
  return {};
}

int LiveMedium::descriptor(bus::Line line) const {
  const LiveLine* const found = find(line);
  return found == nullptr ? -1 : found->queue().descriptor();
}

void LiveMedium::watch(bus::Line line, bool on) {
  if (LiveLine* const found = find(line)) found->queue().watch(on);
}

bus::LiveCounts LiveMedium::counts() const {
  bus::LiveCounts counts{.sent = sent_, .received = received_, .not_sent = not_sent_};
  for (const auto& line : lines_) {
    if (line == nullptr) continue;
    counts.lost += line->lost();
    counts.foreign += line->foreign();
    counts.malformed += line->malformed();
  }
  return counts;
}

const std::string& LiveMedium::failure() const {
  for (const auto& line : lines_)
    if (failure_.empty() && line != nullptr) failure_ = line->failure();
  return failure_;
}

LiveLine* LiveMedium::find(bus::Line line) const { return line < lines_.size() ? lines_[line].get() : nullptr; }

bus::LiveStatus LiveMedium::counted(bus::LiveStatus status) {
  if (status == bus::LiveStatus::kDone) ++sent_;
  if (status == bus::LiveStatus::kNoRoom) ++not_sent_;
  return status;
}

}  // namespace ttf::dds
