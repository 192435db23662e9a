#include "nodes/sensing/gateway.h"

namespace ttf::nodes::sensing {

void Gateway::run(host::StepContext& context) {
  if (context.inputs[0].fresh) context.outputs[0].copy(*context.inputs[0].list);
}

}  // namespace ttf::nodes::sensing
