// The real-time medium on SocketCAN keeps the laws of the port.
#include "tests/bus/socketcan/live_bench.h"
#include "tests/laws/live_medium_laws.h"

namespace ttf::laws {

using VcanBenches = testing::Types<bus::socketcan::VcanBench<2>, bus::socketcan::VcanBench<5>>;
INSTANTIATE_TYPED_TEST_SUITE_P(SocketCan, LiveMediumLaws, VcanBenches);

}  // namespace ttf::laws
