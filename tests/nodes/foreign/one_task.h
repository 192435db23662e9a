// A task whose step is a library's, by itself: the paper's gateway, which has one port to read and one to write.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nodes/foreign/foreign_step.h"
#include "nodes/host/step.h"
#include "schedules/file/loader.h"

namespace ttf::nodes::foreign {

inline const StepFolder kSteps{TTF_TEST_STEPS, StepFolder::kUsualLimit};

class OneTask {
 public:
  explicit OneTask(const std::string& library, const StepFolder* folder = &kSteps)
      : cluster_(schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/paper_synchronised.yaml")),
        node_(cluster_.nodes[index_of(*cluster_.find_node("gateway"))]), task_(node_.tasks[0]) {
    task_.step = library;
    const schedules::model::PduLayout& layout = cluster_.pdu(task_.reads[0].pdu);
    source_ = std::make_unique<host::Output>("source", task_.reads[0].pdu, layout);
    inputs_.push_back({task_.reads[0].port, task_.reads[0].pdu, &layout, std::nullopt, false});
    outputs_.emplace_back(task_.writes[0].port, task_.writes[0].pdu, cluster_.pdu(task_.writes[0].pdu));
    context_.stamp.global = GlobalTime{50'000'000};
    step_ = std::make_unique<ForeignStep>(cluster_, node_, task_, folder);
  }

  // A list of `count` elements arrives; signal s of element e has the value that `value` says.
  template <class Value> void arrives(std::uint32_t sequence, int count, GlobalTime at, const Value& value) {
    source_->begin(sequence, count, at);
    for (int e = 0; e < count; ++e)
      for (std::size_t s = 0; s < layout().element.size(); ++s) source_->set(e, s, value(e, s));
    inputs_[0].list = source_->view();
    inputs_[0].fresh = true;
  }

  void run() {
    outputs_[0].clear();
    context_.inputs = inputs_;
    context_.outputs = outputs_;
    step_->run(context_);
    inputs_[0].fresh = false;
    ++context_.activation;
  }

  const schedules::model::PduLayout& layout() const { return cluster_.pdu(task_.reads[0].pdu); }
  const schedules::model::Cluster& cluster() const { return cluster_; }
  const host::Output& source() const { return *source_; }
  host::Output& output() { return outputs_[0]; }
  host::StepContext& context() { return context_; }

 private:
  schedules::model::Cluster cluster_;
  schedules::model::Node& node_;
  schedules::model::Task& task_;
  std::unique_ptr<host::Output> source_;
  std::vector<host::Input> inputs_;
  std::vector<host::Output> outputs_;
  host::StepContext context_;
  std::unique_ptr<ForeignStep> step_;
};

}  // namespace ttf::nodes::foreign
