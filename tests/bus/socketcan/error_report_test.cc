// The drivers' error frames, as linux/can/error.h has them.
#include "bus/socketcan/error_report.h"

#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <initializer_list>
#include <utility>

#include "recording/records/records.h"

namespace ttf::bus::socketcan {
namespace {

using namespace recording::records;

canfd_frame error_frame(canid_t classes, std::initializer_list<std::pair<std::size_t, unsigned>> bytes = {}) {
  canfd_frame can{};
  can.can_id = CAN_ERR_FLAG | classes;
  can.len = CAN_ERR_DLC;
  for (const auto& [at, value] : bytes) can.data[at] = static_cast<__u8>(value);
  return can;
}

TEST(ErrorReport, ErrorsHaveTheirKind) {
  const auto error = [](unsigned kind, unsigned location = 0) {
    return error_report_of(error_frame(CAN_ERR_PROT | CAN_ERR_BUSERROR, {{2, kind}, {3, location}})).value().error;
  };
  EXPECT_EQ(error(CAN_ERR_PROT_BIT), CanError::kBit);
  EXPECT_EQ(error(CAN_ERR_PROT_BIT0), CanError::kBit);
  EXPECT_EQ(error(CAN_ERR_PROT_BIT1), CanError::kBit);
  EXPECT_EQ(error(CAN_ERR_PROT_STUFF), CanError::kStuff);
  EXPECT_EQ(error(CAN_ERR_PROT_FORM), CanError::kForm);
  EXPECT_EQ(error(0, CAN_ERR_PROT_LOC_CRC_SEQ), CanError::kCrc);
  EXPECT_EQ(error(0, CAN_ERR_PROT_LOC_ACK), CanError::kAcknowledgement);
  const auto sent = error_report_of(error_frame(CAN_ERR_PROT, {{2, CAN_ERR_PROT_BIT | CAN_ERR_PROT_TX}}));
  EXPECT_TRUE(sent && sent->as_transmitter && !sent->state);
  const auto received = error_report_of(error_frame(CAN_ERR_PROT, {{2, CAN_ERR_PROT_BIT}}));
  EXPECT_TRUE(received && !received->as_transmitter);
  const auto alone = error_report_of(error_frame(CAN_ERR_ACK));
  EXPECT_TRUE(alone && alone->error == CanError::kAcknowledgement && alone->as_transmitter);
}

TEST(ErrorReport, StatesAreThoseOfErrorConfinement) {
  const auto state = [](canid_t classes, unsigned controller = 0) {
    const auto report = error_report_of(error_frame(classes, {{1, controller}}));
    return report ? report->state : std::nullopt;
  };
  EXPECT_EQ(state(CAN_ERR_BUSOFF), CanState::kBusOff);
  EXPECT_EQ(state(CAN_ERR_RESTARTED), CanState::kActive);
  EXPECT_EQ(state(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE), CanState::kPassive);
  EXPECT_EQ(state(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE), CanState::kPassive);
  EXPECT_EQ(state(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING), CanState::kActive);
  EXPECT_EQ(state(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE), CanState::kActive);
}

TEST(ErrorReport, CountersAreThereIfTheFrameSaysSo) {
  const auto with =
      error_report_of(error_frame(CAN_ERR_CRTL | 0x200U, {{1, CAN_ERR_CRTL_TX_PASSIVE}, {6, 136}, {7, 3}}));
  ASSERT_TRUE(with);
  EXPECT_EQ(with->transmit_errors, 136);
  EXPECT_EQ(with->receive_errors, 3);
  const auto without = error_report_of(error_frame(CAN_ERR_CRTL, {{1, CAN_ERR_CRTL_TX_PASSIVE}, {6, 136}}));
  EXPECT_EQ(without.value().transmit_errors, 0);
}

TEST(ErrorReport, OtherReportsAndFramesAreNone) {
  EXPECT_FALSE(error_report_of(error_frame(CAN_ERR_LOSTARB)));
  EXPECT_FALSE(error_report_of(error_frame(CAN_ERR_TRX)));
  EXPECT_FALSE(error_report_of(error_frame(CAN_ERR_TX_TIMEOUT)));
  EXPECT_FALSE(error_report_of(error_frame(CAN_ERR_CRTL, {{1, CAN_ERR_CRTL_RX_OVERFLOW}})));
  EXPECT_FALSE(error_report_of(error_frame(CAN_ERR_PROT, {{2, CAN_ERR_PROT_OVERLOAD}})));
  canfd_frame data{};
  data.can_id = 0x123;
  EXPECT_FALSE(error_report_of(data));
}

}  // namespace
}  // namespace ttf::bus::socketcan
