#include "nodes/service/gateway.h"

namespace ttf::nodes::service {

void Gateway::run(host::StepContext& context) {
  if (context.inputs[0].fresh) context.outputs[0].copy(*context.inputs[0].list);
}

}  // namespace ttf::nodes::service
