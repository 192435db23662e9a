// A supervisor's messages at the end of a node's run in real time.
#include "cli/node/node_ending.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace ttf::cli::node {
namespace {

using Json = nlohmann::json;

class NodeEndingTest : public testing::Test {
 protected:
  NodeEndingTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()), 0);
    supervisors_ = supervision::Descriptor(ends[0]);
    nodes_.emplace(supervision::Descriptor(ends[1]));
  }
  std::vector<Json> received() const {
    std::vector<Json> messages;
    std::string message(supervision::kLongestMessage, '\0');
    for (ssize_t got; (got = recv(supervisors_.get(), message.data(), message.size(), MSG_DONTWAIT)) > 0;)
      messages.push_back(Json::parse(message.substr(0, static_cast<std::size_t>(got))));
    return messages;
  }

  supervision::Descriptor supervisors_;
  std::optional<supervision::ControlLine> nodes_;
};

TEST_F(NodeEndingTest, IsReportedAsDone) {
  report_ending({{{"overruns", 3}}, {{"drops", 4}}, ""}, nodes_, false);
  EXPECT_THAT(received(),
              testing::ElementsAre(Json{{"health", {{"drops", 4}}}},
                                   Json{{"done", {{"counts", {{"overruns", 3}}}, {"real_time", {{"drops", 4}}}}}}));
}

TEST_F(NodeEndingTest, AFailedRunIsNotDone) {
  try {
    report_ending({{{"overruns", 3}}, {{"drops", 4}}, "vcan0: went down"}, nodes_, false);
    FAIL() << "the failure is not passed on";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "vcan0: went down");
  }
  EXPECT_THAT(received(), testing::ElementsAre(Json{{"health", {{"drops", 4}}}}));
}

TEST(NodeEnding, WithoutASupervisorItIsPrinted) {
  std::optional<supervision::ControlLine> nobody;
  testing::internal::CaptureStdout();
  report_ending({{{"overruns", 3}}, {{"drops", 4}}, ""}, nobody, true);
  EXPECT_EQ(Json::parse(testing::internal::GetCapturedStdout()),
            (Json{{"counts", {{"overruns", 3}}}, {"real_time", {{"drops", 4}}}}));
  testing::internal::CaptureStdout();
  EXPECT_THROW(report_ending({{}, {}, "why"}, nobody, false), std::runtime_error);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace ttf::cli::node
