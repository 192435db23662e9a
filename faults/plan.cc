#include "faults/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/check.h"
#include "faults/believed_schedule.h"

namespace ttf::faults {
namespace {

using schedules::model::Cluster;

// Resolves faults and collects the mistakes of the plan in this cluster.
class Resolver {
 public:
  Resolver(const Cluster& cluster, const std::string& file, Findings& findings)
      : cluster_(cluster), file_(file), findings_(findings) {}

  void resolve(Fault& fault, std::size_t index) {
    fault_ = &fault;
    index_ = index;
    if (is_on_can(fault.kind)) find_can(fault);
    if (has_node(fault.kind) && fault.node == kNoNode) fault.node = find("node", fault.node_name);
    if (fault.receivers.empty())
      for (const std::string& name : fault.receiver_names) fault.receivers.push_back(find("receivers", name));
    check_receivers();
    check_slot();
    check_bits();
    check_demand();
    check_identifier();
    check_belief();
  }

 private:
  void find_can(Fault& fault) {
    for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b)
      if (cluster_.can_buses[b].name == fault.can_name) fault.can = b;
    if (fault.can != Fault::kNoCan) return;
    std::string names;
    for (const schedules::model::CanBus& bus : cluster_.can_buses) names += (names.empty() ? ": " : ", ") + bus.name;
    fail("can", fault.can_name, "must be a CAN", names);
  }
  // Returns whether the node is where the fault is; while its CAN is unknown, every node is.
  bool is_there(NodeId node) const {
    if (!is_on_can(fault_->kind)) return cluster_.node(node).flexray.has_value();
    return fault_->can == Fault::kNoCan || schedules::model::is_on_can(cluster_.node(node), fault_->can);
  }
  // Receivers would take its frames for the schedule's.
  void check_identifier() {
    if (!takes(fault_->kind, FaultParameter::kIdentifier) || fault_->can == Fault::kNoCan) return;
    const schedules::model::CanBus& bus = cluster_.can_buses[fault_->can];
    for (const schedules::model::CanMessage& message : bus.messages)
      if (message.identifier == fault_->identifier)
        fail("identifier", fmt::to_string(fault_->identifier), "must be of no message",
             fmt::format(": {} has it on {}", cluster_.pdu(message.pdu).name, bus.name));
  }
  NodeId find(std::string_view key, const std::string& name) {
    const auto node = cluster_.find_node(name);
    if (!node)
      fail(key, name, "must be a node", ": " + names_there());
    else if (!is_there(*node))
      fail(key, name, is_on_can(fault_->kind) ? fmt::format("must be on {}", fault_->can_name) : "must be on FlexRay");
    return node.value_or(kNoNode);
  }
  void check_receivers() {
    for (const NodeId receiver : fault_->receivers)
      if (receiver != kNoNode && receiver == fault_->node)
        fail("receivers", cluster_.node(receiver).name, "must be another node");
  }
  void check_slot() {
    const int slots = cluster_.flexray.gNumberOfStaticSlots;
    if (fault_->slot > slots) fail_number("slot", fault_->slot, fmt::format("must be 1..{}", slots));
    if (takes(fault_->kind, FaultParameter::kMasquerade))
      for (const schedules::model::FrameSlot& frame : cluster_.frames)
        if (frame.slot == fault_->slot && frame.sender == fault_->node)
          return fail_number("slot", fault_->slot, "must be another's slot");
    if (takes(fault_->kind, FaultParameter::kWrongSchedule) && fault_->wrong == WrongSchedule::kShiftedSlots &&
        fault_->by >= slots)
      fail_number("by", fault_->by, fmt::format("must be 1..{}", slots - 1));
  }
  void check_bits() {
    if (!takes(fault_->kind, FaultParameter::kPayloadBits)) return;
    const int bits = 16 * cluster_.flexray.gPayloadLengthStatic;
    for (const int bit : fault_->bits)
      if (bit >= bits) fail_number("bits", bit, fmt::format("must be 0..{} in a static frame", bits - 1));
  }
  void check_demand() {
    if (fault_->node == kNoNode) return;
    const schedules::model::Node& node = cluster_.node(fault_->node);
    const NodeDemand demand = row_of(fault_->kind).demand;
    if (demand == NodeDemand::kColdstart && node.flexray && !node.flexray->pKeySlotUsedForStartup)
      fail("node", node.name, "must be a coldstart node");
    if (demand == NodeDemand::kBothChannels && node.flexray &&
        node.flexray->pChannels != schedules::model::Channels::kAB)
      fail("node", node.name, "must be on both channels");
  }
  void check_belief() {
    if (!changes_schedule(*fault_) || !findings_.empty()) return;
    const std::string objection = believe(*fault_, believed_.try_emplace(fault_->node, cluster_).first->second);
    if (objection.empty()) return;
    const bool by = fault_->by != 0;
    findings_.add({file_, fault_->line, fmt::format("faults[{}].{}", index_, by ? "by" : "slot"),
                   by ? fmt::to_string(fault_->by) : "", objection});
  }
  std::string names_there() const {
    std::string names;
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      if (is_there(static_cast<NodeId>(n))) names += (names.empty() ? "" : ", ") + cluster_.nodes[n].name;
    return names;
  }
  void fail(std::string_view key, std::string value, std::string_view expected, std::string_view more = {}) {
    findings_.add({file_, fault_->line, fmt::format("faults[{}].{}", index_, key), std::move(value),
                   fmt::format("{} of {}{}", expected, cluster_.name, more)});
  }
  void fail_number(std::string_view key, int value, std::string_view expected) {
    fail(key, fmt::to_string(value), expected);
  }

  const Cluster& cluster_;
  const std::string& file_;
  Findings& findings_;
  std::map<NodeId, Cluster> believed_;  // by faulty node
  const Fault* fault_ = nullptr;
  std::size_t index_ = 0;
};

}  // namespace

FaultPlan resolve(FaultPlan plan, const Cluster& cluster) {
  Findings findings;
  Resolver resolver(cluster, plan.file, findings);
  for (std::size_t i = 0; i < plan.faults.size(); ++i) resolver.resolve(plan.faults[i], i);
  findings.throw_if_any();
  return plan;
}

}  // namespace ttf::faults
