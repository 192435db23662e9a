#include "faults/believed_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/check.h"

namespace ttf::faults {
namespace {

using schedules::model::Cluster;
using schedules::model::FrameSlot;
using schedules::model::GlobalParameters;
using schedules::model::NodeParameters;

constexpr int kMaxPayloadWords = 127;
constexpr int kMinNit = 2;  // [MT]

// Users of the frames expect them in this order.
void sort(std::vector<FrameSlot>& frames) {
  std::stable_sort(frames.begin(), frames.end(), [](const FrameSlot& a, const FrameSlot& b) {
    return a.slot != b.slot ? a.slot < b.slot : a.base_cycle < b.base_cycle;
  });
}

std::string shift_slots(const Fault& fault, Cluster& believed) {
  const int slots = believed.flexray.gNumberOfStaticSlots;
  const auto shifted = [&](int slot) { return slot > slots ? slot : (slot - 1 + fault.by) % slots + 1; };
  for (FrameSlot& frame : believed.frames)
    if (frame.sender == fault.node) frame.slot = shifted(frame.slot);
  NodeParameters& p = *believed.nodes[index_of(fault.node)].flexray;
  p.pKeySlotId = shifted(p.pKeySlotId);
  sort(believed.frames);
  return {};
}

std::string take_key_slot(NodeId node, int slot, Cluster& believed) {
  NodeParameters& p = *believed.nodes[index_of(node)].flexray;
  for (FrameSlot& frame : believed.frames)
    if (frame.sender == node && frame.slot == p.pKeySlotId) frame.slot = slot;
  p.pKeySlotId = slot;
  sort(believed.frames);
  return {};
}

std::string lengthen_cycle(const Fault& fault, Cluster& believed) {
  GlobalParameters& g = believed.flexray;
  NodeParameters& p = *believed.nodes[index_of(fault.node)].flexray;
  g.gMacroPerCycle += fault.by;
  g.gdNIT += fault.by;
  g.gOffsetCorrectionStart += fault.by;
  g.gdCycle_ps = g.cycle_ps();
  p.pMicroPerCycle = static_cast<int>((g.cycle_ps() + p.pdMicrotick_ps / 2) / p.pdMicrotick_ps);
  return {};
}

std::string lengthen_slots(const Fault& fault, Cluster& believed) {
  GlobalParameters& g = believed.flexray;
  const int longer = fault.by * g.gNumberOfStaticSlots;
  const int before_correction = g.gOffsetCorrectionStart - (g.gMacroPerCycle - g.gdNIT);
  // The segments precede both the network idle time and the instant of correction in it.
  const int room = std::min(g.gdNIT - kMinNit, before_correction);
  if (longer > room)
    return fmt::format("must shorten the network idle time by at most {} macroticks: {} slots take {}", room,
                       g.gNumberOfStaticSlots, longer);
  g.gdStaticSlot += fault.by;
  g.gdNIT -= longer;
  return {};
}

std::string lengthen_payload(const Fault& fault, Cluster& believed) {
  int& words = believed.flexray.gPayloadLengthStatic;
  if (words + fault.by > kMaxPayloadWords)
    return fmt::format("must be at most {}: a static frame has {} words and room for {}", kMaxPayloadWords - words,
                       words, kMaxPayloadWords);
  words += fault.by;
  return {};
}

// Returns the key slot of another coldstart node, the first in file order; 0 if there is none.
int anothers_key_slot(NodeId node, const Cluster& cluster) {
  for (std::size_t n = 0; n < cluster.nodes.size(); ++n) {
    const auto& p = cluster.nodes[n].flexray;
    if (n != index_of(node) && p && p->pKeySlotUsedForStartup) return p->pKeySlotId;
  }
  return 0;
}

}  // namespace

bool changes_schedule(const Fault& fault) {
  return fault.kind == FaultKind::kWrongSchedule ||
         (fault.kind == FaultKind::kDuplicateColdstart && fault.duplicate == DuplicateMode::kSameKeySlot);
}

std::string believe(const Fault& fault, Cluster& believed) {
  TTF_CHECK(changes_schedule(fault), "a fault of kind {}", name_of(fault.kind));
  if (fault.kind == FaultKind::kDuplicateColdstart) {
    const int slot = fault.slot != 0 ? fault.slot : anothers_key_slot(fault.node, believed);
    if (slot == 0) return "must be given: there is no other coldstart node whose slot it could take";
    return take_key_slot(fault.node, slot, believed);
  }
  switch (fault.wrong) {
    case WrongSchedule::kShiftedSlots: return shift_slots(fault, believed);
    case WrongSchedule::kCycleLength: return lengthen_cycle(fault, believed);
    case WrongSchedule::kStaticSlot: return lengthen_slots(fault, believed);
    case WrongSchedule::kPayloadLength: return lengthen_payload(fault, believed);
    case WrongSchedule::kKeySlot: return take_key_slot(fault.node, fault.slot, believed);
  }
  TTF_CHECK(false, "wrong schedule {}", static_cast<int>(fault.wrong));
}

BelievedSchedules::BelievedSchedules(const FaultPlan& plan, const Cluster& cluster) : believed_(cluster.nodes.size()) {
  for (const Fault& fault : plan.faults) {
    if (!changes_schedule(fault)) continue;
    std::unique_ptr<Cluster>& believed = believed_[index_of(fault.node)];
    if (!believed) believed = std::make_unique<Cluster>(cluster);
    const std::string objection = believe(fault, *believed);
    TTF_CHECK(objection.empty(), "{}", objection);
  }
}

}  // namespace ttf::faults
