// The real-time medium on SocketCAN keeps the laws of the port.
#include "tests/laws/live_medium_laws.h"
#include "tests/bus/socketcan/live_bench.h"

namespace ttf::laws {

using VcanBenches = testing::Types<socketcan::VcanBench<2>, socketcan::VcanBench<5>>;
INSTANTIATE_TYPED_TEST_SUITE_P(SocketCan, LiveMediumLaws, VcanBenches);

}  // namespace ttf::laws
