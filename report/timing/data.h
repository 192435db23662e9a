// The records that the timing diagram keeps, in the order of arrival. A record with views has a struct of its own here, which
// holds its values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recording/records/records.h"
#include "report/drawing/fault_lanes.h"

namespace ttf::report::timing {

struct TimingData {
  struct Measurement {
    TrueTime at;
    MeasurementId id;
  };
  struct CanFrame {
    std::size_t bus;
    TrueTime start, end;
    PduId pdu;
    std::uint32_t sequence;
    std::uint8_t fragment;
    NodeId node;
    SensorId sensor;
  };
  struct SlotFrame {
    TrueTime start, end;
    GlobalTime global;
    NodeId node;
    std::int64_t cycle;
    std::uint16_t slot;
    std::uint8_t channel;
    bool null_frame;
    PduId pdu;
    std::uint32_t sequence;
    std::uint8_t fragment;
    SensorId sensor;
    bool by_the_cluster = true;  // otherwise its sender had no global time yet (recording::records::Stamp)
  };
  struct Image {
    recording::records::Stamp stamp;
    std::uint32_t sequence;
    std::vector<MeasurementId> newest;
  };
  struct Use {
    recording::records::Stamp stamp;
    std::uint32_t image;
    bool stale = false;  // too late to be of use
  };
  struct OnChannel {  // recording::records::ChannelFrame
    TrueTime start, end;
    NodeId sender;
    std::uint8_t channel;
    recording::records::ChannelState state;
    std::uint16_t slot;
    TrueTime sent;
    std::uint8_t sent_channel;
  };

  std::vector<Measurement> measurements;
  std::vector<CanFrame> can_frames;
  std::vector<SlotFrame> slot_frames;
  std::vector<recording::records::ListHop> hops;
  std::vector<recording::records::TaskRun> executions;
  std::vector<recording::records::ListFused> fused;
  std::vector<recording::records::FusionStep> steps;
  std::vector<Image> images;
  std::vector<Use> uses;
  std::vector<drawing::FaultEvent>
      faults;  // begins and ends of the log up to the window's end; acts only in the window
  std::vector<OnChannel> on_channel;
  std::vector<recording::records::TimingProblem> problems;
};

}  // namespace ttf::report::timing
