#include "experiments/campaign/can/draw.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/check.h"
#include "experiments/campaign/drawing.h"
#include "schedules/analysis/can_load.h"

namespace ttf::experiments::campaign::can {
namespace {

using faults::Fault;
using faults::FaultParameter;

constexpr std::uint32_t kMostIdentifier = 2047;
constexpr double kBurstRatio = 1'000.0;  // from 10 us to 10 ms apart
constexpr Duration kShortest = Duration::milliseconds(1);

class CanDrawing final : public Drawing {
 public:
  CanDrawing(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::size_t bus,
             std::uint32_t index)
      : Drawing(campaign, index), cluster_(cluster), bus_(cluster.can_buses[bus]) {
    for (std::size_t n = 0; n < cluster.nodes.size(); ++n)
      if (is_on_can(cluster.nodes[n], bus)) members_.push_back(static_cast<NodeId>(n));
    fault_.can = bus;
  }

  DrawnFault fault() {
    fault_.kind = kind();
    fault_.node = one_of(faults::takes(fault_.kind, FaultParameter::kCanBit) ? senders() : members_);
    when();
    for (const FaultParameter parameter : faults::row_of(fault_.kind).parameters) draw(parameter);
    return {fault_, false};
  }

 private:
  // Only a sender's frames can be corrupted.
  std::vector<NodeId> senders() const {
    std::vector<NodeId> senders;
    for (const NodeId node : members_)
      if (std::any_of(bus_.messages.begin(), bus_.messages.end(),
                      [&](const schedules::model::CanMessage& message) { return message.sender == node; }))
        senders.push_back(node);
    return senders;
  }
  // It begins in the second fifth of the trial. One fault in three lasts to the end, the others from 1 ms to two fifths
  // of the trial, evenly in the logarithm.
  void when() {
    fault_.from = between(campaign().duration * 1, campaign().duration * 2);
    fault_.from.ns /= 5;
    if (uniform() >= 2.0 / 3.0) return;
    const auto shortest = static_cast<double>(kShortest.ns);
    const double ratio = static_cast<double>(campaign().duration.ns) * 0.4 / shortest;
    fault_.duration = {static_cast<std::int64_t>(shortest * std::pow(ratio, uniform()))};
  }
  void draw(FaultParameter parameter) {
    switch (parameter) {
      case FaultParameter::kDirection: fault_.direction = direction(); return;
      case FaultParameter::kOccasions: return occasions(fault_);
      case FaultParameter::kBursts: return bursts(fault_, kBurstRatio);
      case FaultParameter::kReceivers: return receivers(fault_, members_);
      case FaultParameter::kCanBit: return bit();
      case FaultParameter::kIdentifier: return identifier();
      default: return;  // kind, node, CAN and window are drawn before; no kind on a CAN has others
    }
  }
  // Half of all faults always invert the same bit; the others another one in every frame.
  void bit() {
    if (uniform() < 0.5) return;
    std::int64_t most = 0;
    for (const schedules::model::CanMessage& message : bus_.messages) {
      const schedules::analysis::CanBits bits =
          schedules::analysis::can_unstuffed_bits(bus_, cluster_.pdu(message.pdu).fragment_bytes);
      most = std::max(most, bits.nominal + bits.data);
    }
    fault_.bit = number(1, static_cast<int>(most) - 1);
  }
  // Identifiers are drawn by their place among those of the messages: before the first, between two, or behind the last,
  // all alike.
  void identifier() {
    std::vector<std::uint32_t> taken;
    for (const schedules::model::CanMessage& message : bus_.messages) taken.push_back(message.identifier);
    std::sort(taken.begin(), taken.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> gaps;
    std::uint32_t low = 0;
    for (const std::uint32_t identifier : taken) {
      if (low < identifier) gaps.emplace_back(low, identifier - 1);
      low = identifier + 1;
    }
    if (low <= kMostIdentifier) gaps.emplace_back(low, kMostIdentifier);
    TTF_CHECK(!gaps.empty(), "no identifier is left on {}", bus_.name);
    const auto [first, last] = one_of(gaps);
    fault_.identifier = static_cast<std::uint32_t>(number(static_cast<int>(first), static_cast<int>(last)));
  }

  const schedules::model::Cluster& cluster_;
  const schedules::model::CanBus& bus_;
  std::vector<NodeId> members_;
  Fault fault_;
};

}  // namespace

DrawnFault draw_fault(const CampaignFile& campaign, const schedules::model::Cluster& cluster, std::size_t bus,
                      std::uint32_t index) {
  return CanDrawing(campaign, cluster, bus, index).fault();
}

}  // namespace ttf::experiments::campaign::can
