// A build without DDS (TTF_WITH_DDS) has no topics: NodeSet::topics is false there.
#include <stdexcept>

#include "cli/node_set/live_topics.h"

namespace ttf::cli::node_set {
namespace {

[[noreturn]] void refuse() { throw std::logic_error("topics need DDS, which this build leaves out"); }

}  // namespace

void check_topics(const NodeSet&) { refuse(); }
void try_topics(const NodeSet&) { refuse(); }
std::unique_ptr<LiveTopics> make_topics(const NodeSet&, NodeId, const nodes::runner::DriveClock&,
                                        const sim::drives::Surroundings&) {
  refuse();
}

}  // namespace ttf::cli::node_set
