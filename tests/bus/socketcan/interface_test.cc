#include "bus/socketcan/interface.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>
#include <vector>

#include "bus/socketcan/socket.h"
#include "core/errors.h"
#include "tests/bus/socketcan/vcan.h"

namespace ttf::bus::socketcan {
namespace {

constexpr InterfaceState kFine{.refused = 0, .there = true, .can = true, .up = true, .mtu = 72};

InterfaceState but(void (*change)(ttf::bus::socketcan::InterfaceState&)) {
  InterfaceState state = kFine;
  change(state);
  return state;
}

TEST(InterfaceProblem, IsNoneWhereAllHolds) {
  EXPECT_EQ(interface_problem("vcan0", kFine, true), "");
  EXPECT_EQ(interface_problem("can0", but([](auto& s) { s.mtu = 16; }), false), "");
}

TEST(InterfaceProblem, NamesWhatTheKernelLacks) {
  EXPECT_EQ(interface_problem("vcan0", but([](auto& s) { s.refused = EAFNOSUPPORT; }), true),
            "the kernel has no CAN sockets (AF_CAN; a container uses its host's kernel): "
            "modprobe can_raw && modprobe vcan");
  EXPECT_EQ(interface_problem("vcan0", but([](auto& s) { s.refused = EPROTONOSUPPORT; }), true),
            "the kernel has no raw CAN sockets (CAN_RAW; a container uses its host's kernel): "
            "modprobe can_raw");
  EXPECT_EQ(interface_problem("vcan0", but([](auto& s) { s.refused = EACCES; }), true),
            "the kernel gives no CAN socket: Permission denied");
}

// Each side is judged separately: the needed commands are known before the kernel has its modules.
TEST(InterfaceProblem, OfTheLinkIsKnownWithoutCanSockets) {
  const auto nothing = but([](auto& s) { s.refused = EAFNOSUPPORT, s.there = false; });
  EXPECT_TRUE(kernel_problem(nothing));
  const Problem link = link_problem("vcan0", nothing, true);
  EXPECT_EQ(link.what, "is not there");
  EXPECT_EQ(link.commands,
            (std::vector<std::string>{"ip link add dev vcan0 type vcan", "ip link set vcan0 mtu 72 up"}));
  EXPECT_FALSE(kernel_problem(kFine));
  EXPECT_FALSE(link_problem("vcan0", but([](auto& s) { s.refused = EAFNOSUPPORT; }), true));
}

// lo is on every machine, and no CAN.
TEST(InterfaceState, IsFoundForAnyInterface) {
  const InterfaceState state = interface_state("lo");
  EXPECT_TRUE(state.there);
  EXPECT_FALSE(state.can);
  EXPECT_GT(state.mtu, 72);
  EXPECT_FALSE(interface_state("ttf_absent").there);
}

TEST(InterfaceProblem, ComesWithTheCommandThatHelps) {
  const auto absent = but([](auto& s) { s.there = false; });
  EXPECT_EQ(interface_problem("vcan0", absent, true),
            "is not there: ip link add dev vcan0 type vcan && ip link set vcan0 mtu 72 up");
  EXPECT_EQ(interface_problem("vxcan1", absent, false),
            "is not there: ip link add dev vxcan1 type vxcan && ip link set vxcan1 mtu 16 up");
  EXPECT_EQ(interface_problem("can0", absent, true),
            "is not there; `ip -details link show type can` lists the CAN interfaces");
  EXPECT_EQ(interface_problem("a_name_of_20_bytes__", absent, true),
            "is not an interface name: a name has 1..15 bytes");
  EXPECT_EQ(interface_problem("lo", but([](auto& s) { s.can = false; }), true),
            "is not a CAN interface; `ip -details link show type can` lists the CAN interfaces");
  EXPECT_EQ(interface_problem("vcan0", but([](auto& s) { s.up = false; }), true),
            "is down: ip link set vcan0 mtu 72 up");
  EXPECT_EQ(interface_problem("can0", but([](auto& s) { s.up = false; }), true),
            "is down: ip link set can0 up type can bitrate 1000000 dbitrate 5000000 fd on");
  EXPECT_EQ(interface_problem("can0", but([](auto& s) { s.up = false; }), false),
            "is down: ip link set can0 up type can bitrate 500000");
  EXPECT_EQ(interface_problem("vcan0", but([](auto& s) { s.mtu = 16; }), true),
            "carries no CAN FD frames (MTU 16, needs 72): ip link set vcan0 down && ip link set vcan0 mtu 72 up");
  EXPECT_EQ(interface_problem("can1", but([](auto& s) { s.mtu = 16, s.up = false; }), true),
            "carries no CAN FD frames (MTU 16, needs 72): "
            "ip link set can1 up type can bitrate 1000000 dbitrate 5000000 fd on");
}

// On any machine: an unusable interface is refused with that sentence, preceded by its name.
TEST(InterfaceProblem, EndsSetUp) {
  for (const char* name : {"vcan98", "lo", "", "a_name_of_20_bytes__"}) {
    const std::string problem = interface_problem(name, interface_state(name), true);
    ASSERT_NE(problem, "") << name;
    try {
      const Socket socket({.interface = name, .filters = {}});
      FAIL() << name;
    } catch (const InputError& error) {
      ASSERT_EQ(error.findings().size(), 1u);
      EXPECT_EQ(error.findings()[0].expected, problem);
      EXPECT_EQ(error.findings()[0].file, name);
    }
  }
}

// The commands are run as the sentence gives them, until no problem remains.
TEST_F(OwnVcan, IsMendedByTheCommands) {
  run(std::string("ip link del dev ") + kName);
  const auto problem = [] { return interface_problem(kName, interface_state(kName), true); };
  EXPECT_EQ(problem().rfind("is not there", 0), 0u);
  ASSERT_TRUE(run(command_in(problem()))) << problem();
  EXPECT_EQ(problem(), "");
  ip("down");
  EXPECT_EQ(problem().rfind("is down", 0), 0u);
  ASSERT_TRUE(run(command_in(problem()))) << problem();
  EXPECT_EQ(problem(), "");
  ip("down");
  ip("mtu 16");
  EXPECT_EQ(problem().rfind("carries no CAN FD frames", 0), 0u);
  ip("up");
  EXPECT_EQ(problem().rfind("carries no CAN FD frames", 0), 0u);
  EXPECT_EQ(interface_problem(kName, interface_state(kName), false), "");
  ASSERT_TRUE(run(command_in(problem()))) << problem();
  EXPECT_EQ(problem(), "");
}

}  // namespace
}  // namespace ttf::bus::socketcan
