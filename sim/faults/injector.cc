#include "sim/faults/injector.h"

#include <algorithm>

#include "core/check.h"
#include "faults/believed_schedule.h"
#include "sim/faults/families.h"

namespace ttf::sim::faults {

Injector::Injector(ttf::faults::FaultPlan plan, const schedules::model::Cluster& cluster, engine::Plant& plant,
                   std::uint64_t seed, std::uint32_t replication, recording::records::Sink& sink, TrueTime origin)
    : plan_(std::move(plan)), cluster_(cluster), plant_(plant), sink_(sink), activations_(plan_.faults.size()) {
  foreseen_.reserve(kForeseen);
  for (std::size_t i = 0; i < plan_.faults.size(); ++i) {
    const ttf::faults::Fault& fault = plan_.faults[i];
    TTF_CHECK(!ttf::faults::has_node(fault.kind) || fault.node != kNoNode, "{} of a node that was not looked up: {}",
              ttf::faults::name_of(fault.kind), fault.node_name);
    const bool always = ttf::faults::changes_schedule(fault);  // a node always acts by its belief
    const TrueTime from = always ? origin : origin + fault.from;
    const TrueTime until =
        always || fault.duration == ttf::faults::Fault::kToTheEnd ? kNever<TrueTime> : from + fault.duration;
    entries_.push_back({make_active_fault({fault, static_cast<std::uint32_t>(i), cluster_, plant_, *this, from, until,
                                           seed, replication}),
                        from, until});
  }
  plan_next();
}

Injector::~Injector() = default;

bool Injector::touches(NodeId sender, schedules::model::Channel channel) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.fault->touches(sender, channel); });
}

bool Injector::leaving(medium::Leaving& signal) {
  bool leaves = true;
  for (std::size_t i = 0; leaves && i < entries_.size(); ++i) leaves = entries_[i].fault->leaving(signal);
  plan_next();
  return leaves;
}

bool Injector::arriving(medium::Arriving& signal) {
  for (Entry& entry : entries_)
    if (!entry.fault->arriving(signal)) return false;
  return true;
}

bool Injector::touches_can(std::size_t bus, TrueTime until) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry& entry) { return entry.fault->touches_can(bus, until); });
}

bool Injector::queues_on_can(std::size_t bus, NodeId sender) {
  return std::all_of(entries_.begin(), entries_.end(),
                     [&](Entry& entry) { return entry.fault->queues_on_can(bus, sender); });
}

void Injector::begins_on_can(medium::CanBeginning& frame) {
  for (Entry& entry : entries_) entry.fault->begins_on_can(frame);
}

bool Injector::arrives_from_can(std::size_t bus, NodeId receiver) {
  return std::all_of(entries_.begin(), entries_.end(),
                     [&](Entry& entry) { return entry.fault->arrives_from_can(bus, receiver); });
}

bool Injector::acknowledges_on_can(std::size_t bus, NodeId node) {
  return std::all_of(entries_.begin(), entries_.end(),
                     [&](Entry& entry) { return entry.fault->acknowledges_on_can(bus, node); });
}

TrueTime Injector::holds_can(std::size_t bus) const {
  TrueTime until{};
  for (const Entry& entry : entries_) until = std::max(until, entry.fault->holds_can(bus));
  return until;
}

void Injector::act(TrueTime now) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (entry.begins <= now) begin(i, now);
    if (entry.fault->next() <= now) entry.fault->act(now);
    if (entry.ends <= now) {
      entry.ends = kNever<TrueTime>;
      report(i, recording::records::FaultAct::kEnds, now, "it ends");
    }
  }
  plan_next();
}

void Injector::begin(std::size_t fault, TrueTime at) {
  entries_[fault].begins = kNever<TrueTime>;
  report(fault, recording::records::FaultAct::kBegins, at, "it begins");
  for (const Foreseen& one : foreseen_)
    if (one.fault == fault) acted(one.fault, at, {one.text.data(), one.size});
  std::erase_if(foreseen_, [&](const Foreseen& one) { return one.fault == fault; });
}

void Injector::acted(std::uint32_t fault, TrueTime at, std::string_view text) {
  const TrueTime begins = entries_[fault].begins;
  if (begins != kNever<TrueTime> && at < begins) {
    // An effect on a signal that is still under way at the fault's begin is known when the signal leaves. It is
    // recorded at the begin.
    Foreseen& foreseen = foreseen_.emplace_back();
    foreseen.fault = fault;
    foreseen.size = std::min(text.size(), foreseen.text.size());
    std::copy_n(text.begin(), foreseen.size, foreseen.text.begin());
    return;
  }
  if (begins != kNever<TrueTime>) begin(fault, at);  // a signal leaves at that very instant, before the faults act
  Activation& activation = activations_[fault];
  if (activation.times++ == 0) activation.first = at;
  activation.last = at;
  report(fault, recording::records::FaultAct::kActs, at, text);
}

void Injector::emit(const medium::Leaving& signal, std::optional<NodeId> source) { plant_.emit(signal, source); }

void Injector::report(std::size_t fault, recording::records::FaultAct what, TrueTime at, std::string_view text) {
  const ttf::faults::Fault& one = plan_.faults[fault];
  sink_.on(recording::records::FaultActivity{at, static_cast<std::uint32_t>(fault), what, one.node,
                                             ttf::faults::name_of(one.kind), text});
}

void Injector::plan_next() {
  next_ = kNever<TrueTime>;
  for (const Entry& entry : entries_) next_ = std::min({next_, entry.begins, entry.ends, entry.fault->next()});
}

}  // namespace ttf::sim::faults
