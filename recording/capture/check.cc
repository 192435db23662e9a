#include "recording/capture/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "core/errors.h"
#include "recording/capture/cycles.h"
#include "recording/capture/packet.h"
#include "recording/capture/wrong_slots.h"

namespace ttf::recording::capture {
namespace {

using schedules::model::Channel;

constexpr int kSlots = 2048;  // frame ids are 11 bits

// Tracks which owned slots of a capture's cycles have a frame.
class CaptureCoverage {
 public:
  // `count` frames are missing after a packet.
  using Missing = std::function<void(std::uint64_t packet, std::uint64_t count, std::string text)>;
  CaptureCoverage(const schedules::model::Cluster& cluster, schedules::model::Channels channels, Missing missing);

  // Takes the next frame, sent `advance` cycles after the previous one, in a cycle with this counter. Returns
  // whether it is the first frame of its slot and channel in that cycle.
  bool frame(std::int64_t advance, int counter, int slot, schedules::model::Channel channel, std::uint64_t packet);
  // Takes a frame that claims this place, but whose header fails its CRC: it is damaged, not missing.
  void damaged(int counter, int slot, schedules::model::Channel channel);
  // Call it after the last frame.
  void finish();
  std::int64_t cycles() const { return cycle_ + 1; }

 private:
  struct Owned {
    int slot = 0;
    schedules::model::Channel channel{};
  };
  struct Claim {
    std::int64_t cycle = 0;  // the running cycle at its arrival
    int counter = 0;
    Owned place;
  };
  std::uint64_t& packet_of(int slot, schedules::model::Channel channel);
  bool was_damaged(const Owned& owned) const;
  void close_cycle(int before_slot);
  void silent_cycles(std::int64_t count);

  Missing missing_;
  int counters_;
  std::vector<std::vector<Owned>> owned_;  // by cycle counter, in the order of slots
  std::vector<std::uint64_t> packets_;     // in the current cycle, by slot and channel; 0: no packet
  std::vector<Claim> damaged_;
  std::int64_t cycle_ = -1;  // running, from 0
  int counter_ = 0;
  int after_slot_ = 0;  // the first cycle's coverage begins after this slot
  int last_slot_ = 0;
  std::uint64_t last_packet_ = 0, last_before_cycle_ = 0;
};

CaptureCoverage::CaptureCoverage(const schedules::model::Cluster& cluster, schedules::model::Channels channels,
                                 Missing missing)
    : missing_(std::move(missing)), counters_(cluster.flexray.gCycleCountMax + 1),
      owned_(static_cast<std::size_t>(counters_)), packets_(kSlots * 2) {
  for (int counter = 0; counter < counters_; ++counter)
    for (const schedules::model::FrameSlot& frame : cluster.frames)
      for (const Channel channel : schedules::model::kBothChannels)
        if (includes(frame.channels, channel) && includes(channels, channel) &&
            frame.slot <= cluster.flexray.gNumberOfStaticSlots && in_cycle(frame, counter))
          owned_[static_cast<std::size_t>(counter)].push_back({frame.slot, channel});
}

std::uint64_t& CaptureCoverage::packet_of(int slot, Channel channel) {
  return packets_[static_cast<std::size_t>(slot * 2 + static_cast<int>(channel))];
}

bool CaptureCoverage::frame(std::int64_t advance, int counter, int slot, Channel channel, std::uint64_t packet) {
  if (cycle_ < 0) {
    cycle_ = 0;
    after_slot_ = slot;
  } else if (advance > 0) {
    close_cycle(kSlots);
    after_slot_ = 0;
    counter_ = (counter_ + 1) % counters_;
    silent_cycles(advance - 1);
    cycle_ += advance;
    last_before_cycle_ = last_packet_;
    std::fill(packets_.begin(), packets_.end(), 0);
    std::erase_if(damaged_, [this](const Claim& claim) { return claim.cycle < cycle_ - 1; });
  }
  counter_ = counter;
  last_slot_ = slot;
  last_packet_ = packet;
  std::uint64_t& seen = packet_of(slot, channel);
  const bool first = seen == 0;
  if (first) seen = packet;
  return first;
}

void CaptureCoverage::damaged(int counter, int slot, Channel channel) {
  damaged_.push_back({cycle_, counter, {slot, channel}});
}

bool CaptureCoverage::was_damaged(const Owned& owned) const {
  return std::any_of(damaged_.begin(), damaged_.end(), [&](const Claim& claim) {
    return claim.counter == counter_ && claim.place.slot == owned.slot && claim.place.channel == owned.channel;
  });
}

void CaptureCoverage::close_cycle(int before_slot) {
  std::uint64_t after = last_before_cycle_;
  int slot = 0;
  for (const Owned& owned : owned_[static_cast<std::size_t>(counter_)]) {
    for (; slot < owned.slot; ++slot)
      for (const Channel channel : schedules::model::kBothChannels) after = std::max(after, packet_of(slot, channel));
    if (owned.slot <= after_slot_ || owned.slot >= before_slot || packet_of(owned.slot, owned.channel) != 0 ||
        was_damaged(owned))
      continue;
    missing_(after, 1,
             fmt::format("slot {} on {}, cycle {}: has no frame", owned.slot, letter(owned.channel), counter_));
  }
}

// Counts the frames missing in `count` cycles without a frame, from counter_ on.
void CaptureCoverage::silent_cycles(std::int64_t count) {
  if (count == 0) return;
  std::uint64_t all = 0, missing = 0;
  for (int i = 0; i < counters_; ++i) {
    const auto frames = owned_[static_cast<std::size_t>((counter_ + i) % counters_)].size();
    all += frames;
    if (i < count % counters_) missing += frames;
  }
  missing += all * static_cast<std::uint64_t>(count / counters_);
  if (missing > 0)
    missing_(last_packet_, missing,
             fmt::format("cycles from {} on: {} without a single frame, {} frames missing", counter_, count, missing));
}

void CaptureCoverage::finish() {
  if (cycle_ >= 0) close_cycle(last_slot_);
}

struct Frame {
  std::uint64_t number = 0;
  std::optional<std::int64_t> time_ns;
  FlexRayPacket packet;
  std::optional<int> elsewhere;  // the slot it was in, if not the slot of its id (frames_in_wrong_slots)

  bool is_sound() const {
    return packet.kind == FlexRayPacket::Kind::kFrame && packet.whole_header && packet.header_crc_holds;
  }
};

class CaptureChecker {
 public:
  CaptureChecker(const schedules::model::Cluster& cluster, const CaptureCheckOptions& options)
      : cluster_(cluster), options_(options), cycles_(cluster.flexray),
        coverage_(cluster, options.channels, [this](std::uint64_t packet, std::uint64_t count, std::string text) {
          report(Contradiction::kMissing, packet, std::move(text), count);
        }) {}

  CaptureVerdict check(const Capture& capture, const std::string& name) {
    std::vector<Frame> frames = frames_of(capture, name);
    find_wrong_slots(frames);
    for (const Frame& frame : frames) check(frame);
    if (coverage_.cycles() == 0)
      throw InputError({name, 0, "", "",
                        frames.empty() ? "has no FlexRay frame (link type 210) on these channels within the window"
                                       : "has no FlexRay frame with a sound header"});
    coverage_.finish();
    verdict_.cycles = coverage_.cycles();
    std::stable_sort(verdict_.findings.begin(), verdict_.findings.end(),
                     [](const CaptureFinding& a, const CaptureFinding& b) { return a.packet < b.packet; });
    return std::move(verdict_);
  }

 private:
  // In the order of time if all packets have stamps, else in the order of the file.
  std::vector<Frame> frames_of(const Capture& capture, const std::string& name) {
    std::vector<Frame> frames;
    bool stamped = true;
    std::optional<std::int64_t> first;
    for (const CapturedPacket& packet : capture.packets) {
      if (capture.link_type(packet) != static_cast<std::uint32_t>(LinkType::kFlexRay)) continue;
      stamped = stamped && packet.time_ns;
      if (packet.time_ns && (!first || *packet.time_ns < *first)) first = packet.time_ns;
    }
    if (!stamped && (options_.from_ns > 0 || options_.to_ns))
      throw InputError({name, 0, "", "", "has packets without time stamps: no window can be chosen"});
    for (const CapturedPacket& packet : capture.packets) {
      if (capture.link_type(packet) != static_cast<std::uint32_t>(LinkType::kFlexRay)) {
        ++verdict_.other_packets;
        continue;
      }
      const Frame frame{packet.number, stamped ? packet.time_ns : std::nullopt,
                        parse_flexray_packet(capture.data(packet)), std::nullopt};
      if (!in_window(frame, first.value_or(0)) || !includes(options_.channels, frame.packet.channel)) {
        ++verdict_.other_packets;
      } else if (frame.packet.kind == FlexRayPacket::Kind::kSymbol) {
        ++verdict_.symbols;
      } else {
        frames.push_back(frame);
      }
    }
    if (stamped)
      std::stable_sort(frames.begin(), frames.end(),
                       [](const Frame& a, const Frame& b) { return *a.time_ns < *b.time_ns; });
    verdict_.frames = frames.size();
    return frames;
  }

  bool in_window(const Frame& frame, std::int64_t first) const {
    if (!frame.time_ns) return true;
    const std::int64_t since = *frame.time_ns - first;
    return since >= options_.from_ns && (!options_.to_ns || since < *options_.to_ns);
  }

  // Either all frames have stamps, or no frame has.
  void find_wrong_slots(std::vector<Frame>& frames) const {
    std::vector<StampedFrame> stamped;
    for (const Frame& frame : frames)
      if (frame.time_ns && frame.is_sound())
        stamped.push_back({*frame.time_ns, frame.packet.header.frame_id, frame.packet.channel});
    const std::vector<std::optional<int>> found = frames_in_wrong_slots(cluster_.flexray, stamped);
    auto next = found.begin();
    for (Frame& frame : frames)
      if (frame.time_ns && frame.is_sound()) frame.elsewhere = *next++;
  }

  void check(const Frame& frame) {
    const FlexRayPacket& packet = frame.packet;
    const bool coding = (packet.errors & (kTssViolation | kCodingError | kFrameEndError)) != 0;
    if (packet.kind == FlexRayPacket::Kind::kFrame && !packet.whole_header && coding)
      return report(Contradiction::kCoding, frame.number,
                    fmt::format("on {}: coding errors are flagged ({:#04x}), and there is no header",
                                letter(packet.channel), packet.errors));
    if (packet.kind != FlexRayPacket::Kind::kFrame || !packet.whole_header)
      return report(Contradiction::kMalformed, frame.number, "holds neither a symbol nor a whole frame header");
    const bus::wire::FrameHeader& header = packet.header;
    const auto say = [&](Contradiction kind, const std::string& what) {
      report(kind, frame.number,
             fmt::format("slot {} on {}, cycle {}: {}", header.frame_id, letter(packet.channel), header.cycle, what));
    };
    if ((packet.errors & kFrameCrcError) != 0) say(Contradiction::kFrameCrc, "the frame CRC is flagged as wrong");
    if (coding) say(Contradiction::kCoding, fmt::format("coding errors are flagged ({:#04x})", packet.errors));
    if (!packet.header_crc_holds) {
      // Slot and length are unreliable then.
      say(Contradiction::kHeaderCrc, fmt::format("the header CRC {:#05x} does not hold", header.header_crc));
      coverage_.damaged(header.cycle, header.frame_id, packet.channel);
      return;
    }
    if ((packet.errors & kHeaderCrcError) != 0)
      say(Contradiction::kHeaderCrc, "the header CRC is flagged as wrong, though it holds");
    if (header.startup && !header.sync)
      say(Contradiction::kStartupWithoutSync, "is a startup frame, but no sync frame");
    const int was_in = frame.elsewhere.value_or(header.frame_id);
    const CycleTracker::Place place = cycles_.place(was_in, header.cycle, frame.time_ns);
    advance_ += place.advance;
    if (!place.counter_fits || header.cycle > cluster_.flexray.gCycleCountMax)
      say(Contradiction::kCycleCounter, fmt::format("the cycle counter should be {}", place.counter));
    check_owner(header, packet.channel, place.counter, say);
    if (frame.elsewhere)  // and its own slot lacks it
      say(Contradiction::kWrongSlot, was_in <= cluster_.flexray.gNumberOfStaticSlots
                                         ? fmt::format("was sent in slot {}", was_in)
                                         : std::string("was sent outside of the static segment"));
    else if (!coverage_.frame(std::exchange(advance_, 0), place.counter, header.frame_id, packet.channel, frame.number))
      say(Contradiction::kTwice, "is the second frame of its slot and cycle");
    check_length(packet, say);
  }

  template <class Say>
  void check_owner(const bus::wire::FrameHeader& header, Channel channel, int counter, const Say& say) const {
    bool slot = false, on_channel = false;
    for (const schedules::model::FrameSlot& frame : cluster_.frames) {
      if (frame.slot != header.frame_id) continue;
      slot = true;
      if (!includes(frame.channels, channel)) continue;
      on_channel = true;
      if (in_cycle(frame, counter)) return;
    }
    if (!slot)
      say(Contradiction::kUnownedSlot, "the slot has no owner");
    else if (!on_channel)
      say(Contradiction::kWrongChannel,
          fmt::format("the slot's owner sends on {} only", channel == Channel::kA ? 'B' : 'A'));
    else
      say(Contradiction::kWrongCycle, "the slot's owner does not send in this cycle (base cycle and repetition)");
  }

  template <class Say> void check_length(const FlexRayPacket& packet, const Say& say) const {
    const int words = packet.header.payload_words;
    if (packet.header.frame_id <= cluster_.flexray.gNumberOfStaticSlots &&
        words != cluster_.flexray.gPayloadLengthStatic)
      say(Contradiction::kPayloadLength, fmt::format("the payload has {} words, not {} (gPayloadLengthStatic)", words,
                                                     cluster_.flexray.gPayloadLengthStatic));
    else if (packet.payload.size() != 2 * static_cast<std::size_t>(words))
      say(Contradiction::kPayloadLength,
          fmt::format("{} bytes of payload were captured, but the header says {}", packet.payload.size(), 2 * words));
  }

  void report(Contradiction kind, std::uint64_t packet, std::string text, std::uint64_t count = 1) {
    verdict_.counts[static_cast<std::size_t>(kind)] += count;
    if (verdict_.findings.size() < kMostFindings) verdict_.findings.push_back({kind, packet, std::move(text)});
  }

  const schedules::model::Cluster& cluster_;
  const CaptureCheckOptions& options_;
  CycleTracker cycles_;
  CaptureCoverage coverage_;
  std::int64_t advance_ = 0;  // cycles since the last frame that the coverage received
  CaptureVerdict verdict_;
};

}  // namespace

const std::array<std::string_view, kContradictions> kContradictionNames{
    "malformed packet",       "header CRC error",     "frame CRC error", "coding error", "startup frame without sync",
    "cycle counter error",    "slot without owner",   "wrong channel",   "wrong cycle",  "wrong slot",
    "second frame in a slot", "wrong payload length", "missing frame"};

std::uint64_t CaptureVerdict::contradictions() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

CaptureVerdict check_capture(const Capture& capture, const std::string& name, const schedules::model::Cluster& cluster,
                             const CaptureCheckOptions& options) {
  return CaptureChecker(cluster, options).check(capture, name);
}

}  // namespace ttf::recording::capture
