#include "nodes/host/wiring.h"

#include <algorithm>
#include <utility>

#include "core/check.h"

namespace ttf::nodes::host {

Wiring::Wiring(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
               std::span<const std::shared_ptr<Step>> steps, std::vector<Connection> media, const NodeTime& time,
               NodeRecords& records)
    : media_(std::move(media)), time_(time), records_(records) {
  TTF_CHECK(steps.size() == node.tasks.size(), "{} steps for {} tasks", steps.size(), node.tasks.size());
  tasks_.reserve(node.tasks.size());
  for (std::size_t t = 0; t < steps.size(); ++t) connect(cluster, node.tasks[t], *steps[t]);
}

ListMedium* Wiring::find(schedules::model::MediumId medium) const {
  const auto found =
      std::find_if(media_.begin(), media_.end(), [&](const Connection& one) { return one.id == medium; });
  return found == media_.end() ? nullptr : found->lists.get();
}

Wiring::Route* Wiring::find_route(schedules::model::MediumId medium, PduId pdu) {
  const auto found = std::find_if(routes_.begin(), routes_.end(),
                                  [&](const Route& one) { return one.medium == medium && one.pdu == pdu; });
  return found == routes_.end() ? nullptr : &*found;
}

void Wiring::connect(const schedules::model::Cluster& cluster, const schedules::model::Task& task, const Step& step) {
  const std::size_t index = tasks_.size();
  TaskPorts& ports = tasks_.emplace_back();
  for (const schedules::model::PortBinding& port : task.reads) {
    ListMedium* const lists = find(port.medium);
    TTF_CHECK(lists != nullptr, "task {} reads from medium {}, which its node is not on", index, port.medium.number());
    Route* route = find_route(port.medium, port.pdu);
    if (route == nullptr) route = &routes_.emplace_back(Route{port.medium, port.pdu, {}, {}});
    route->readers.push_back({index, ports.inputs.size()});
    if (activates(task, port)) route->sets_off.push_back(index);
    ports.inputs.push_back({port.port, port.pdu, &cluster.pdu(port.pdu), std::nullopt, false});
    ports.sources.push_back({port.medium, lists->incoming(port.pdu), std::nullopt, step.reads_newest(port.port)});
  }
  for (const schedules::model::PortBinding& port : task.writes) {
    ListMedium* const lists = find(port.medium);
    TTF_CHECK(lists != nullptr, "task {} writes to medium {}, which its node is not on", index, port.medium.number());
    ports.outputs.emplace_back(port.port, port.pdu, cluster.pdu(port.pdu));
    ports.drains.push_back({port.medium, *lists});
  }
}

std::span<Input> Wiring::read(std::size_t task, const recording::records::Stamp& at) {
  TaskPorts& ports = tasks_[task];
  for (std::size_t i = 0; i < ports.inputs.size(); ++i) {
    Input& input = ports.inputs[i];
    Source& source = ports.sources[i];
    input.list = source.list.latest();
    input.fresh = source.unread.has_value();
    input.discarded = false;
    source.unread.reset();
    if (input.fresh) records_.hop(at, recording::records::Hop::kRead, input.pdu, input.list->sequence, source.medium);
  }
  return ports.inputs;
}

void Wiring::report_discarded(std::size_t task, const recording::records::Stamp& at) {
  const TaskPorts& ports = tasks_[task];
  for (std::size_t i = 0; i < ports.inputs.size(); ++i) {
    const Input& input = ports.inputs[i];
    if (!input.discarded) continue;
    ++records_.counts().discarded_lists;
    records_.hop(at, recording::records::Hop::kDiscarded, input.pdu, input.list->sequence, ports.sources[i].medium);
  }
}

void Wiring::write(std::size_t task, const recording::records::Stamp& at) {
  TaskPorts& ports = tasks_[task];
  for (std::size_t o = 0; o < ports.outputs.size(); ++o) {
    Output& output = ports.outputs[o];
    records_.counts().saturated_signals += static_cast<std::uint64_t>(output.take_saturated());
    if (!output.written()) continue;
    const Drain& drain = ports.drains[o];
    records_.hop(at, recording::records::Hop::kWritten, output.pdu(), output.view().sequence, drain.medium);
    drain.lists.send(output.pdu(), output.view());
    output.clear();
  }
}

std::span<const std::size_t> Wiring::arrived(const ListArrival& arrival, Microticks at) {
  using enum bus::cni::ArrivalEffect;
  if (arrival.effect == kStale || arrival.effect == kMalformed) ++records_.counts().refused_fragments;
  // One fragment may end two lists: the one it tears, and its own if it completes that.
  if (!arrival.torn && arrival.effect != kCompleted && arrival.effect != kStale) return {};
  // Lists that no task here reads are not recorded.
  const Route* const route = find_route(arrival.medium, arrival.pdu);
  if (route == nullptr) return {};

  const recording::records::Stamp stamp = time_.stamp(at);
  const auto report = [&](recording::records::Hop what, std::uint32_t sequence) {
    records_.hop(stamp, what, arrival.pdu, sequence, arrival.medium);
  };
  if (arrival.torn) {
    ++records_.counts().torn_lists;
    report(recording::records::Hop::kTorn, *arrival.torn);
  }
  if (arrival.effect == kStale) report(recording::records::Hop::kStale, arrival.sequence);
  if (arrival.effect != kCompleted) return {};
  report(recording::records::Hop::kReceived, arrival.sequence);
  for (const Route::Reader& reader : route->readers) {
    Source& source = tasks_[reader.task].sources[reader.input];
    if (source.unread && !source.newest_counts) {
      ++records_.counts().overwritten_lists;
      report(recording::records::Hop::kOverwritten, *source.unread);
    }
    source.unread = arrival.sequence;
  }
  return route->sets_off;
}

}  // namespace ttf::nodes::host
