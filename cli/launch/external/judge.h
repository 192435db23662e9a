// Judges the frames of real nodes by the schedule. Pure: arrivals in, counts out; the instants are the arrivals' own.
//
//   in window   the frame came within the arrival window around its instant, as the other nodes' runners judge it
//               (nodes/runner/arrival_window.h)
//   early, late it came before or behind that. A list on a private CAN is early if it comes sooner behind the last one than
//               the schedule allows, and never late: no instant is its own
//   malformed   a receiver cannot use it, whenever it came
//   missing     its cycle passed without it, behind that of the node's first frame of any kind, up to the last cycle of
//               the cluster. Lists and strobes on a private CAN have no cycle: they may be never received
// A frame on FlexRay counts on each channel. A frame before the cluster's first cycle counts as early.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "bus/ports/listener.h"
#include "bus/wire/flexray_frame.h"
#include "cli/launch/external/cycle_grid.h"
#include "core/ids.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch::external {

enum class Malformed : std::uint8_t {
  kForm,      // not in the medium's form: its length, padding, header CRC, or CAN FD instead of classic CAN
  kFrameCrc,  // of FlexRay
  kContent,   // not the slot's: its cycle, its payload length, sync or startup indicator
  kList,      // numbers or codes that no sender of the list writes
  kTorn,      // the next list began before this one was whole
  kRepeated,  // a second frame of its slot in a cycle, or a fragment of a list on a private CAN again
  kOldList,   // its number is behind the last list's, as a sender's that counts anew
};
inline constexpr std::size_t kMalformedKinds = 7;
// Returns "wrong frame CRC".
std::string_view text_of(Malformed kind);

struct Counts {
  std::uint64_t in_window = 0, early = 0, late = 0, missing = 0;
  std::array<std::uint64_t, kMalformedKinds> malformed{};  // by Malformed
  std::optional<bus::ports::MachineTime> first, last;      // arrivals of any frame

  std::uint64_t all_malformed() const;
};

class Judge {
 public:
  using MachineTime = bus::ports::MachineTime;

  // `nodes`: the real ones. `channels`: those that can be received. The cluster must be fit for real time
  // (schedules/check/real_time_rules.h).
  Judge(const schedules::model::Cluster& cluster, std::vector<NodeId> nodes, std::int64_t time_scale_ppm,
        schedules::model::Channels channels = schedules::model::Channels::kAB);

  // Returns the frames to be received: the real nodes', and the sync frames of the others.
  bus::ports::ReceivedIdentifiers identifiers() const;
  void begin(MachineTime cycle_0) { grid_.begin(cycle_0); }
  // The instants must be in order over all lines (in_order.h).
  void receive(const bus::ports::ReceivedFrame& received);

  // By the index in `nodes`.
  Counts counts(std::size_t node) const;
  // Returns the lists and lines on private CANs that never came from a node that was received: "camera_objects",
  // "camera strobe". Scheduled triggers count as missing instead.
  std::vector<std::string> never_received(std::size_t node) const;
  // Returns the longest time that the node may be silent: three of its longest periods, but half a second at least.
  Duration longest_silence(std::size_t node) const { return nodes_[node].longest_silence; }
  // Returns when the other nodes were last received.
  std::optional<MachineTime> cluster_received() const { return grid_.last_received(); }

 private:
  struct Node {
    NodeId id{};
    Counts counts;
    Duration longest_silence{};
    std::optional<std::int64_t> first_cycle = {};  // the first known one in which it sent
  };
  // A frame of a slot on a channel, or a scheduled trigger.
  struct Turn {
    std::size_t node = 0;
    const schedules::model::FrameSlot* frame = nullptr;
    schedules::model::Channel channel{};
    std::optional<std::int64_t> last;  // the last cycle that it was received in
  };
  struct CanFrames {
    std::size_t node = 0, can_bus = 0;
    std::uint32_t identifier = 0;
    bool flexible_data_rate = false;
    std::size_t length = 0;
    std::string name = {};
    bool received = false;
    const schedules::model::CanMessage* message = nullptr;  // a list's
    std::optional<schedules::model::CycleInstant> at = {};  // a scheduled trigger's
    std::unique_ptr<bus::cni::IncomingList> list = {};
    std::optional<std::uint32_t> sequence = {};  // the last list's
    MachineTime began{};                         // its first frame's arrival
    std::optional<std::int64_t> last = {};       // the cycle of the last trigger
  };

  void add_slots(std::size_t node);
  void add_cans(std::size_t node);
  void receive_frame(const bus::ports::ReceivedFrame& received);
  void receive_can(const bus::ports::ReceivedFrame& received);
  void receive_malformed(const bus::ports::ReceivedFrame& received);
  void judge_list(const bus::ports::ReceivedFrame& received, CanFrames& frames, Node& node);
  void judge_trigger(const bus::ports::ReceivedFrame& received, CanFrames& frames, Node& node);
  void judge_instant(Node& node, Duration behind) const;
  static void count(Node& node, Malformed kind);
  Node& received_from(std::size_t node, MachineTime at);

  bool is_sync_of_others(int slot) const;
  bool is_of(const schedules::model::FrameSlot& slot, const bus::wire::FrameHeader& header) const;
  std::optional<Malformed> fault_of(const schedules::model::FrameSlot& slot, const bus::wire::DecodedFrame& frame);
  static std::optional<Malformed> fault_of(bus::cni::ArrivalEffect effect);
  // `last`: no value for a frame that was not received yet.
  static std::uint64_t missed(const Node& node, int base_cycle, int repetition, std::optional<std::int64_t> last,
                              std::int64_t next);
  // Returns null for a slot that no real node has, in that cycle or in any.
  Turn* turn_of(int slot, schedules::model::Channel channel, std::optional<std::uint8_t> cycle_counter);
  CanFrames* frames_of(std::size_t can_bus, std::uint32_t identifier);

  const schedules::model::Cluster& cluster_;
  const std::int64_t time_scale_ppm_;
  const schedules::model::ArrivalWindow window_;
  const schedules::model::Channels channels_;
  CycleGrid grid_;
  std::vector<Node> nodes_;
  std::vector<Turn> turns_;
  std::vector<CanFrames> cans_;
  std::vector<std::unique_ptr<bus::cni::IncomingList>> lists_;  // FlexRay's, by PDU; null for other nodes' lists
  std::vector<bool> others_sync_;                               // by slot
};

}  // namespace ttf::cli::launch::external
