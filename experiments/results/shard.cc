#include "experiments/results/shard.h"

#include <algorithm>
#include <thread>

namespace ttf::experiments::results {

unsigned workers_here() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace ttf::experiments::results
