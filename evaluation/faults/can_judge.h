// Judges whether a single fault on a CAN harmed fault-free nodes, and which checks noticed it (can_checks.h). It uses
// what hosts queue and receive, and the controllers' records. No record of a drive has a received frame, so its account
// counts the controllers' errors alone (CanSeen in fault_account.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/can_checks.h"
#include "evaluation/faults/judgement.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::evaluation::faults {

using CanJudgeBase = JudgeOf<CanCheck, kAllCanChecks.size(), CanHarm, kAllCanHarms.size()>;
using CanJudgement = CanJudgeBase::Judgement;

struct CanJudgeSettings {
  std::size_t bus = 0;
  NodeId faulty = kNoNode;  // named by the fault
  TrueTime from{};          // beginning of the fault: nothing counts before
  TrueTime until{};         // its end
};

class CanJudge : private CanJudgeBase {
 public:
  // Precondition: each message has a bounded response.
  CanJudge(const schedules::model::Cluster& cluster, const CanJudgeSettings& settings);

  // Events, in the order of time.
  void queued(NodeId sender, std::uint32_t identifier, std::span<const std::byte> data, TrueTime at);
  // `torn`: the receiver found that a list lacks frames. `foreign`: the frame is in no schedule.
  void received(NodeId receiver, std::uint32_t identifier, std::span<const std::byte> data, bool torn, bool foreign,
                TrueTime at);
  void begun(const recording::records::CanFrameSent& frame);
  void sent(NodeId sender);
  void error_frame(const recording::records::CanErrorFrame& error);
  void state_changed(const recording::records::CanStateChanged& change);
  // Returns the judgement if no further event comes until `at`.
  const CanJudgement& finish(TrueTime at);

 private:
  static constexpr int kMostErrors = 32;  // before a transmitter is confined
  struct Owed {
    TrueTime queued{};
    std::size_t errors_before = 0;  // error frames
    std::vector<std::byte> data;
  };
  // A message of a fault-free node.
  struct Message {
    std::uint32_t identifier = 0;
    NodeId sender{};
    Duration response{};
    std::vector<Owed> frames;       // in the order of their queueing
    std::vector<std::size_t> next;  // by receiver: the first frame that it has not received
  };
  Message* message_of(std::uint32_t identifier);
  bool is_late(const Message& message, const Owed& frame, TrueTime at) const;
  void lose(const Message& message, std::size_t first, std::size_t end, NodeId receiver, TrueTime at);
  void fails(recording::records::CanError error, TrueTime at);

  const CanJudgeSettings settings_;
  std::vector<NodeId> receivers_;  // fault-free nodes
  std::vector<Message> messages_;
  Duration cost_of_error_{};
  std::size_t errors_ = 0;                            // error frames
  std::vector<recording::records::CanState> states_;  // by NodeId
  TrueTime frame_began_{};
  std::optional<std::uint32_t> lowest_;  // among frames that began together; none behind an error frame
  NodeId winner_ = kNoNode;
  std::uint32_t fails_ = 0;  // the faulty node's failures in a row
};

}  // namespace ttf::evaluation::faults
