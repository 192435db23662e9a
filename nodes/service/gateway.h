// The gateway between two buses passes lists on unchanged.
#pragma once

#include "nodes/host/step.h"

namespace ttf::nodes::service {

// Ports: `in` -> `out`, the list unchanged. Fragments on the CAN are fragments on FlexRay.
class Gateway final : public host::Step {
 public:
  void run(host::StepContext& context) override;
};

}  // namespace ttf::nodes::service
