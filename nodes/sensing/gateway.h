// The gateway between two buses: lists go on as they came.
#pragma once

#include "nodes/host/step.h"

namespace ttf::nodes::sensing {

// Ports: `in` -> `out`, the list unchanged: fragments of the CAN are fragments of the FlexRay.
class Gateway final : public host::Step {
 public:
  void run(host::StepContext& context) override;
};

}  // namespace ttf::nodes::sensing
