#include <fmt/format.h>

#include <cstdio>

#include "cli/node_command.h"

namespace ttf::cli {

int run_node_virtual(const NodeOptions& options) {
  fmt::print(stderr, "error: node {} cannot run: this build has no medium that carries virtual time between processes\n",
             options.set.cluster.node(options.node).name);
  return 2;
}

}  // namespace ttf::cli
