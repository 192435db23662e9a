// A service of the cluster driven_surround_synchronised whose lists come by hand.
#pragma once

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "nodes/host/step.h"
#include "recording/records/records.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::driving {

inline constexpr std::int64_t kStep_ms = 40;

inline const schedules::model::Cluster& surround() {
  static const schedules::model::Cluster kCluster =
      schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/driven_surround_synchronised.yaml");
  return kCluster;
}
inline const schedules::model::Task& task_there(const char* node, const char* step) {
  for (const schedules::model::Task& task : surround().node(*surround().find_node(node)).tasks)
    if (task.step == step) return task;
  throw std::runtime_error(step);
}

// A task by hand: lists at its ports, an execution every 40 ms.
class ServiceByHand : public recording::records::Sink {
 public:
  explicit ServiceByHand(const schedules::model::Task& task) {
    for (const auto& port : task.reads) {
      lists_.emplace_back(port.port, port.pdu, surround().pdu(port.pdu));
      inputs_.push_back({port.port, port.pdu, &surround().pdu(port.pdu), std::nullopt, false});
    }
    for (const auto& port : task.writes) outputs_.emplace_back(port.port, port.pdu, surround().pdu(port.pdu));
  }
  using recording::records::Sink::on;
  void on(const recording::records::Warning& r) override { warnings.push_back(r); }
  void on(const recording::records::CommandIssued& r) override { issued = r; }
  void on(const recording::records::CommandTaken& r) override { taken.push_back(r); }

  using Element = std::map<std::string, double>;
  void receive(const std::string& port, const std::vector<Element>& elements) {
    for (std::size_t i = 0; i < lists_.size(); ++i) {
      if (lists_[i].port() != port) continue;
      lists_[i].begin(++sequence_, static_cast<int>(elements.size()), now());
      for (std::size_t e = 0; e < elements.size(); ++e)
        for (const auto& [name, value] : elements[e])
          lists_[i].set(static_cast<int>(e), *schedules::model::find_signal(lists_[i].layout().element, name), value);
      inputs_[i].list = lists_[i].view();
      inputs_[i].fresh = true;
    }
  }
  std::optional<host::Actuation> run(host::Step& step) {
    host::StepContext context;
    context.stamp.global = now();
    context.stamp.local = LocalTime{now().ns};
    context.inputs = inputs_;
    context.outputs = outputs_;
    context.sink = this;
    taken.clear();
    step.run(context);
    for (host::Input& input : inputs_) input.fresh = false;
    ms_ += kStep_ms;
    return context.actuation;
  }

  std::vector<recording::records::Warning> warnings;
  std::vector<recording::records::CommandTaken> taken;
  std::optional<recording::records::CommandIssued> issued;

 private:
  GlobalTime now() const { return GlobalTime{} + Duration::milliseconds(ms_); }
  std::int64_t ms_ = 1'000;
  std::uint32_t sequence_ = 0;
  std::vector<host::Output> lists_, outputs_;
  std::vector<host::Input> inputs_;
};

}  // namespace ttf::nodes::driving
