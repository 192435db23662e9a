// The step of a library (ttfusion_step.h): hands it physical values, and packs its lists.
#pragma once

#include <string>
#include <vector>

#include "core/time.h"
#include "nodes/foreign/call.h"
#include "nodes/foreign/libraries.h"
#include "nodes/foreign/ttfusion_step.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::foreign {

// The ports of a task in the words of ttfusion_step.h. Names stay the cluster's, which must outlive them.
class PortDescriptions {
 public:
  PortDescriptions(const schedules::model::Cluster& cluster,
                   const std::vector<schedules::model::PortBinding>& bindings);
  PortDescriptions(const PortDescriptions&) = delete;
  PortDescriptions& operator=(const PortDescriptions&) = delete;

  const ttf_step_port* const* ports() const { return pointers_.data(); }

 private:
  struct Described {
    ttf_step_port port{};
    std::vector<ttf_step_signal> signals;
    std::vector<const ttf_step_signal*> pointers;
  };
  std::vector<Described> described_;
  std::vector<const ttf_step_port*> pointers_;
};

class ForeignStep final : public host::Step {
 public:
  // Loads the library from the folder and makes the step. Throws InputError if there is no folder, if the library does not
  // fit, or if it refuses the task.
  ForeignStep(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
              const schedules::model::Task& task, const StepFolder* folder);
  ~ForeignStep() override;
  ForeignStep(const ForeignStep&) = delete;
  ForeignStep& operator=(const ForeignStep&) = delete;

  // Throws std::runtime_error if the step fails, or gives a list that its port cannot hold. Only steps of libraries throw.
  void run(host::StepContext& context) override;

 private:
  struct In {
    ttf_step_input list{};
    std::vector<double> values;
  };
  struct Out {
    ttf_step_output list{};
    std::vector<double> values;
  };
  void take(const host::Input& input, const host::StepContext& context, In& in) const;
  void give(const Out& out, host::Output& output) const;
  [[noreturn]] void fail(const std::string& words) const;

  const Finding place_;
  const CallTerms terms_;
  const Duration round_;
  const PortDescriptions reads_, writes_;
  std::vector<In> ins_;
  std::vector<Out> outs_;
  std::vector<const ttf_step_input*> in_pointers_;
  std::vector<ttf_step_output*> out_pointers_;
  Library library_;
  void* self_ = nullptr;
};

}  // namespace ttf::nodes::foreign
