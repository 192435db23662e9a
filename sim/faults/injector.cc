#include "sim/faults/injector.h"

#include <algorithm>

#include "core/check.h"
#include "nodes/believed_schedule.h"
#include "sim/faults/families.h"

namespace ttf::sim {

Injector::Injector(nodes::FaultPlan plan, const schedules::Cluster& cluster, Plant& plant, std::uint64_t seed,
                   std::uint32_t replication, records::Sink& sink, TrueTime origin)
    : plan_(std::move(plan)), cluster_(cluster), plant_(plant), sink_(sink), activations_(plan_.faults.size()) {
  for (std::size_t i = 0; i < plan_.faults.size(); ++i) {
    const nodes::Fault& fault = plan_.faults[i];
    TTF_CHECK(!nodes::has_node(fault.kind) || fault.node != kNoNode, "{} of a node that was not looked up: {}",
              nodes::name_of(fault.kind), fault.node_name);
    const bool always = nodes::changes_schedule(fault);   // what a node believes in, it always does
    const TrueTime from = always ? origin : origin + fault.from;
    const TrueTime until = always || fault.duration == nodes::Fault::kToTheEnd ? kNever : from + fault.duration;
    entries_.push_back({make_active_fault({fault, static_cast<std::uint32_t>(i), cluster_, plant_, *this, from, until,
                                           seed, replication}),
                        from, until});
  }
  plan_next();
}

Injector::~Injector() = default;

bool Injector::leaving(Leaving& signal) {
  bool leaves = true;
  for (std::size_t i = 0; leaves && i < entries_.size(); ++i) leaves = entries_[i].fault->leaving(signal);
  plan_next();
  return leaves;
}

bool Injector::arriving(Arriving& signal) {
  for (Entry& entry : entries_)
    if (!entry.fault->arriving(signal)) return false;
  return true;
}

void Injector::act(TrueTime now) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.begins <= now) begin(i, now);
    if (entry.fault->next() <= now) entry.fault->act(now);
    if (entry.ends <= now) {
      entry.ends = kNever;
      report(i, records::kFaultEnds, now, "it ends");
    }
  }
  plan_next();
}

void Injector::begin(std::size_t fault, TrueTime at) {
  entries_[fault].begins = kNever;
  report(fault, records::kFaultBegins, at, "it begins");
}

void Injector::acted(std::uint32_t fault, TrueTime at, std::string_view text) {
  // What a transient will destroy may have left before it.
  if (entries_[fault].begins != kNever) begin(fault, at);
  Activation& activation = activations_[fault];
  if (activation.times++ == 0) activation.first = at;
  activation.last = at;
  report(fault, records::kFaultActs, at, text);
}

void Injector::emit(const Leaving& signal, std::optional<NodeId> source) { plant_.emit(signal, source); }

void Injector::report(std::size_t fault, std::uint8_t what, TrueTime at, std::string_view text) {
  const nodes::Fault& one = plan_.faults[fault];
  sink_.on(records::FaultActivity{at, static_cast<std::uint32_t>(fault), what, one.node, nodes::name_of(one.kind),
                                  text});
}

void Injector::plan_next() {
  next_ = kNever;
  for (const Entry& entry : entries_) next_ = std::min({next_, entry.begins, entry.ends, entry.fault->next()});
}

}  // namespace ttf::sim
