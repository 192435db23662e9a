// Any bytes in the messages of sensors and nodes, all the way. CAN frames and fragments reach the buffers,
// preprocessing, gateway, fusion and feature service, each of which passes its output on. Laws: no bytes make
// a step stop the process. Every number in a record is finite unless it may be infinite.
//
// Input: cluster and strategy (a byte each), then acts (a byte each): 0 a CAN frame with these bytes, 1 a
// whole list with a sound header, 2 and 3 a task runs.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "bus/cni/can_controller.h"
#include "bus/cni/list_buffer.h"
#include "bus/wire/pdu_codec.h"
#include "core/check.h"
#include "schedules/file/loader.h"
#include "sim/drives/step_catalog.h"
#include "tests/fuzz/harness.h"
#include "tests/fuzz/nothing_there.h"

namespace {

using namespace ttf;
using schedules::model::PduLayout;

struct Mute final : bus::ports::CanPort {
  void send(const bus::ports::CanFrame&) override {}
};

struct Finite final : recording::records::Sink {
  using recording::records::Sink::on;
  void on(const recording::records::ObservationSeen& r) override {
    for (const double v : {r.x, r.y, r.sxx, r.sxy, r.syy}) check(v, "observation");
    TTF_CHECK(r.sxx > 0 && r.syy > 0, "covariance {} {} {}", r.sxx, r.sxy, r.syy);
  }
  void on(const recording::records::TrackState& r) override {
    for (const double v : r.state) check(v, "state");
    for (const double v : r.covariance) check(v, "covariance");
    for (std::size_t i = 0; i < 4; ++i) TTF_CHECK(r.covariance[7 * i] > 0, "variance {}", r.covariance[7 * i]);
  }
  void on(const recording::records::ImageWritten& r) override {
    for (const auto& object : r.objects) check_object(object);
  }
  void on(const recording::records::FeatureUsed& r) override {
    for (const auto& object : r.objects) {
      check_object(object.image);
      TTF_CHECK(!std::isnan(object.time_gap_s) && !std::isnan(object.time_to_collision_s), "gap {} collision {}",
                object.time_gap_s, object.time_to_collision_s);
    }
  }
  static void check(double value, const char* what) { TTF_CHECK(std::isfinite(value), "{} {}", what, value); }
  static void check_object(const recording::records::ImageObject& o) {
    for (const double v : {o.x, o.y, o.heading, o.speed, o.acceleration, o.length, o.width, o.sigma_x, o.sigma_y,
                           o.correlation_xy, o.sigma_heading, o.sigma_speed})
      check(v, "image");
  }
};

// A node's buffers and tasks, without its clock: the input decides when a task runs.
class Host {
 public:
  Host(const sim::drives::NodeSetConfig& config, NodeId id)
      : cluster_(*config.cluster), id_(id), strobes_(cluster_.sensors.size()) {
    for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b)
      cans_.push_back(std::make_unique<bus::cni::CanController>(cluster_, id, b, mute_));
    for (const PduLayout& layout : cluster_.pdus) slots_.emplace_back(layout);
    const auto steps = sim::drives::make_steps(config, id);
    const auto& described = cluster_.node(id).tasks;
    for (std::size_t t = 0; t < described.size(); ++t) {
      Task& task = tasks_.emplace_back(Task{&described[t], steps[t], {}, {}, 0});
      for (const auto& read : described[t].reads)
        task.inputs.push_back({read.port, read.pdu, &cluster_.pdu(read.pdu), std::nullopt, false});
      for (const auto& write : described[t].writes)
        task.outputs.emplace_back(write.port, write.pdu, cluster_.pdu(write.pdu));
    }
  }

  void can_frame(std::size_t can_bus, const bus::ports::CanFrame& frame) { cans_[can_bus]->receive(frame); }
  void slot(PduId pdu, std::span<const std::byte> payload) { slots_[index_of(pdu)].arrive(payload); }

  // Runs a task and hands each list it wrote to `deliver` (binding, list).
  template <class Deliver>
  void run(std::size_t which, bool strobed, GlobalTime now, GlobalTime measured, Deliver&& deliver) {
    if (tasks_.empty()) return;
    Task& task = tasks_[which % tasks_.size()];
    if (task.described->activation.kind == schedules::model::ActivationKind::kSensor)
      return;  // a device, not a receiver
    for (std::size_t i = 0; i < task.inputs.size(); ++i) {
      const auto& binding = task.described->reads[i];
      bus::cni::IncomingList& list = binding.medium.is_can() ? cans_[binding.medium.can_index()]->incoming(binding.pdu)
                                                             : slots_[index_of(binding.pdu)];
      const auto latest = list.latest();
      task.inputs[i].fresh = latest && (!task.inputs[i].list || task.inputs[i].list->sequence != latest->sequence);
      task.inputs[i].list = latest;
      const SensorId sensor = cluster_.pdu(binding.pdu).sensor;
      if (strobed && task.inputs[i].list && sensor != kNoSensor)
        strobes_[index_of(sensor)].strobe(task.inputs[i].list->sequence, measured);
    }
    nodes::host::StepContext context;
    context.stamp = {TrueTime{now.ns}, LocalTime{now.ns}, now, id_};
    context.activation = task.activations++;
    context.inputs = task.inputs;
    context.outputs = task.outputs;
    context.strobes = strobes_;
    context.sink = &sink_;
    task.step->run(context);
    for (std::size_t o = 0; o < task.outputs.size(); ++o) {
      task.outputs[o].take_saturated();
      if (task.outputs[o].written()) deliver(task.described->writes[o], task.outputs[o].view());
      task.outputs[o].clear();
    }
  }

 private:
  struct Task {
    const schedules::model::Task* described;
    std::shared_ptr<nodes::host::Step> step;
    std::vector<nodes::host::Input> inputs;
    std::vector<nodes::host::Output> outputs;
    std::uint32_t activations;
  };
  const schedules::model::Cluster& cluster_;
  NodeId id_;
  Mute mute_;
  Finite sink_;
  std::vector<std::unique_ptr<bus::cni::CanController>> cans_;
  std::vector<bus::cni::IncomingList> slots_;  // by PDU
  std::vector<nodes::host::StrobeLatch> strobes_;
  std::vector<Task> tasks_;
};

class Cluster {
 public:
  explicit Cluster(const sim::drives::NodeSetConfig& config) : cluster_(*config.cluster) {
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      hosts_.push_back(std::make_unique<Host>(config, static_cast<NodeId>(n)));
  }

  void can_frame(fuzz::Source& source) {
    const std::size_t can_bus = source.below(cluster_.can_buses.size());
    const auto& messages = cluster_.can_buses[can_bus].messages;
    const auto which = source.take<std::uint8_t>();
    const std::uint32_t identifier =
        which < 0x80 ? messages[which % messages.size()].identifier : source.take<std::uint16_t>() & 0x7ffu;
    const bus::ports::CanFrame frame{identifier, cluster_.can_buses[can_bus].flexible_data_rate,
                                     source.bytes(source.below(65))};
    for (auto& host : hosts_) host->can_frame(can_bus, frame);
  }

  void list(fuzz::Source& source) {
    const auto pdu = static_cast<PduId>(source.below(cluster_.pdus.size()));
    const PduLayout& layout = cluster_.pdu(pdu);
    const auto sequence = source.take<std::uint8_t>();
    const auto count = static_cast<int>(source.below(static_cast<std::size_t>(layout.max_elements) + 1));
    nodes::host::Output list("fuzz", pdu, layout);
    list.begin(sequence, count, now_ - Duration::microseconds(source.take<std::uint32_t>() % 500'000));
    for (int i = 0; i < count && !source.empty(); ++i)
      for (std::size_t s = 0; s < layout.element.size(); ++s)
        list.set(i, s,
                 bus::wire::to_physical(layout.element[s], source.take<std::uint32_t>() &
                                                               ((std::uint64_t{1} << layout.element[s].bits) - 1)));
    for (std::size_t b = 0; b < cluster_.can_buses.size(); ++b)
      for (const auto& message : cluster_.can_buses[b].messages)
        if (message.pdu == pdu) send_can(b, message, list.view());
    send_slots(pdu, list.view());
  }

  void run(fuzz::Source& source) {
    const auto which = source.take<std::uint8_t>();
    now_ += Duration::microseconds(source.take<std::uint16_t>());
    const GlobalTime measured = now_ - Duration::microseconds(source.take<std::uint16_t>());
    hosts_[which % hosts_.size()]->run(
        which / hosts_.size(), (which & 0x80) == 0, now_, measured,
        [&](const schedules::model::PortBinding& binding, const bus::cni::ListView& list) {
          if (binding.medium.is_flexray()) return send_slots(binding.pdu, list);
          for (const auto& message : cluster_.can(binding.medium).messages)
            if (message.pdu == binding.pdu) send_can(binding.medium.can_index(), message, list);
        });
  }

 private:
  std::span<const std::byte> fragment(PduId pdu, const bus::cni::ListView& list, int f) const {
    const auto bytes = static_cast<std::size_t>(cluster_.pdu(pdu).fragment_bytes);
    return list.bytes.subspan(static_cast<std::size_t>(f) * bytes, bytes);
  }
  void send_can(std::size_t can_bus, const schedules::model::CanMessage& message, const bus::cni::ListView& list) {
    for (int f = 0; f < list.fragments; ++f)
      for (auto& host : hosts_)
        host->can_frame(can_bus, {message.identifier, cluster_.can_buses[can_bus].flexible_data_rate,
                                  fragment(message.pdu, list, f)});
  }
  void send_slots(PduId pdu, const bus::cni::ListView& list) {
    for (int f = 0; f < list.fragments; ++f)
      for (auto& host : hosts_) host->slot(pdu, fragment(pdu, list, f));
  }

  const schedules::model::Cluster& cluster_;
  std::vector<std::unique_ptr<Host>> hosts_;
  GlobalTime now_{1'000'000'000};
};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const schedules::model::Cluster kClusters[] = {
      schedules::file::parse_cluster(fuzz::shipped_cluster("paper_synchronised"), "paper"),
      schedules::file::parse_cluster(fuzz::shipped_cluster("laser_radar_synchronised"), "recorded")};
  static const sim::drives::Scenario kScenario = [] {
    sim::drives::Scenario scenario;
    scenario.duration = Duration::milliseconds(1'000);
    return scenario;
  }();
  static const auto kRows = std::make_shared<const recording::rows::RecordedInput>(recording::rows::parse_laser_radar(
      "L\t10\t0\t1000\t10\t0\t1\t0\t0\t0\nR\t10\t0\t1\t51000\t10\t0\t1\t0\t0\t0\n", "rows.txt"));
  fuzz::Source source(data, size);
  const schedules::model::Cluster& described = kClusters[source.take<std::uint8_t>() % 2];
  const auto strategy =
      fusion::strategies::kAllStrategies[source.take<std::uint8_t>() % fusion::strategies::kStrategyCount];
  Cluster cluster({&kScenario, &described, strategy, 1, 0, fuzz::nothing_there(), kRows});
  while (!source.empty()) {
    switch (source.take<std::uint8_t>() % 4) {
      case 0: cluster.can_frame(source); break;
      case 1: cluster.list(source); break;
      default: cluster.run(source); break;
    }
  }
  return 0;
}
