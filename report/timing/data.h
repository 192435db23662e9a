// The records that the timing diagram keeps: plain values without spans, in the order of arrival.
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
  struct HopAt {
    TrueTime at;
    NodeId node;
    recording::records::Hop hop;
    SensorId sensor;
    std::uint32_t sequence;
    PduId pdu;
  };
  struct Execution {
    TrueTime activated, start, end;
    NodeId node;
    std::uint8_t task;
    bool deadline_met;
  };
  struct Fused {
    TrueTime at;
    NodeId node;
    std::uint32_t step;
    MeasurementId id;
    GlobalTime measured;
    recording::records::Disposition what;
  };
  struct Step {
    TrueTime at;
    NodeId node;
    std::uint32_t step;
  };
  struct Image {
    TrueTime at;
    NodeId node;
    std::uint32_t sequence;
    std::vector<MeasurementId> newest;
  };
  struct Use {
    TrueTime at;
    NodeId node;
    std::uint32_t image;
    bool fresh;
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
  struct Problem {  // recording::records::TimingProblem
    TrueTime at;
    NodeId node;
    recording::records::TimingFault what;
    Duration late;
    std::int64_t cycle;
    std::uint16_t slot;
    std::uint8_t channel;
    std::uint32_t count;
  };

  std::vector<Measurement> measurements;
  std::vector<CanFrame> can_frames;
  std::vector<SlotFrame> slot_frames;
  std::vector<HopAt> hops;
  std::vector<Execution> executions;
  std::vector<Fused> fused;
  std::vector<Step> steps;
  std::vector<Image> images;
  std::vector<Use> uses;
  std::vector<drawing::FaultEvent>
      faults;  // begins and ends of the log up to the window's end; acts only in the window
  std::vector<OnChannel> on_channel;
  std::vector<Problem> problems;
};

}  // namespace ttf::report::timing
