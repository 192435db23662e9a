// The printed tables of faults, from findings made by hand.
#include "cli/drive/fault_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "recording/records/enumerations.h"

namespace ttf::cli::drive {
namespace {

using evaluation::faults::CanSeen;
using evaluation::faults::FaultFindings;
using evaluation::faults::FaultSeen;
using recording::records::CanError;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

// Two nodes with names of 6 and 25 characters on one CAN. No node is on FlexRay.
schedules::model::Cluster cluster() {
  schedules::model::Cluster made;
  made.nodes.resize(2);
  made.nodes[0].name = "camera";
  made.nodes[1].name = "camera_of_the_left_mirror";
  made.can_buses.resize(1);
  made.can_buses[0].name = "can_of_cameras";
  return made;
}

// A bit error as the camera's 32nd, with which it is bus off, and errors of two kinds at the other node.
FaultFindings off_the_bus() {
  FaultFindings findings;
  FaultSeen fault;
  fault.kind = "can_bus_off";
  fault.node = NodeId{0};
  fault.begins = TrueTime{1'000'000'000};
  findings.faults.push_back(fault);
  CanSeen camera, mirror;
  camera.node = NodeId{0};
  camera.errors[index_of(CanError::kBit)] = 1;
  camera.bus_off = 1;
  camera.first = TrueTime{1'500'000'000};
  mirror.node = NodeId{1};
  mirror.errors[index_of(CanError::kStuff)] = 12;
  mirror.errors[index_of(CanError::kCrc)] = 1;
  mirror.passive = 1;
  mirror.first = TrueTime{1'600'000'000};
  findings.cans = {camera, mirror};
  return findings;
}

TEST(FaultTables, ErrorsOnACanAreCountedInWordsAndColumnsStandInLine) {
  EXPECT_THAT(
      faults_text("tt", off_the_bus(), {}, cluster()),
      HasSubstr("CAN             node                       first [s]  error frames begun  error passive  bus off\n"
                "    errors\n"
                "--------------  -------------------------  ---------  ------------------  -------------  -------\n"
                "can_of_cameras  camera                      1.500000                   1              0        1\n"
                "    1 bit error\n"
                "can_of_cameras  camera_of_the_left_mirror   1.600000                  13              1        0\n"
                "    12 stuff errors, 1 CRC error\n"));
}

// A node that goes bus off changes its state, though not that on FlexRay.
TEST(FaultTables, NoStateOnFlexRayIsSaidOfFlexRayAlone) {
  const std::string text = faults_text("tt", off_the_bus(), {}, cluster());
  EXPECT_THAT(text, HasSubstr("No check on FlexRay found a fault.\n\nNo node changed its state on FlexRay.\n"));
  EXPECT_THAT(text, Not(HasSubstr("changed its state.\n")));
  EXPECT_THAT(text, EndsWith("No node was fault-free to the end.\n"));
}

}  // namespace
}  // namespace ttf::cli::drive
