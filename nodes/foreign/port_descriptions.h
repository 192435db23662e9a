// The ports of a task in the words of ttfusion_step.h. Names stay the cluster's, which must outlive them.
#pragma once

#include <vector>

#include "nodes/foreign/ttfusion_step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::foreign {

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

}  // namespace ttf::nodes::foreign
