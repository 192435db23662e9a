// What can happen in a run, as plain structs, and the port they are reported to.
//
// These records are the contract between what runs (simulator, real-time runner) and what looks at it (log writer,
// diagrams, reports, measures). Spans are views that are valid during the call only. Coordinates follow ISO 8855,
// metres, seconds, radians. Covariances are row-major.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

#include "core/ids.h"
#include "core/time.h"

namespace ttf::recording::records {

// When and where something happened: on all three clocks. `global` is what the node's own clock of the cluster
// showed; where it has none (off FlexRay, or while its controller is not in normal operation: starting up,
// integrating, halted), it is `local` once more.
struct Stamp {
  TrueTime true_time{};
  LocalTime local{};
  GlobalTime global{};
  NodeId node{};
};

// When the node's clock of the cluster showed or will show `at`, by what it showed at the stamp. Global times of
// different nodes, or of one before and after a restart, may be whole rounds of the cycle counter apart; true times are
// comparable.
constexpr TrueTime true_time_of(const Stamp& stamp, GlobalTime at) { return stamp.true_time + (at - stamp.global); }

// A sensor measured, as its device saw it (`stamp.node`). The time stamp that travels with the observations is its
// host's latched global time (FusionInput::measured).
struct Measured {
  Stamp stamp;
  MeasurementId id;
  std::span<const ObjectId> truth_ids;  // per raw item, kClutterObject for none; truth, in the log only
};
inline constexpr ObjectId kClutterObject{0xffff};

// What travels is a list: of a PDU, under a sequence number that counts on where the bus' field wraps, and (with that
// number) of the measurement `sensor` made. kNoSensor: a list that descends from no single measurement, such as an
// image, which ImageWritten ties to the measurements in it.

// One frame on a private CAN, as its sender saw it.
struct CanFrameSent {
  std::uint8_t bus = 0;  // index in Cluster::can_buses
  Stamp start{};         // it won the arbitration
  Stamp end{};           // it has left, intermission included
  std::uint32_t identifier = 0;
  bool flexible_data_rate = false;
  PduId pdu = kNoPdu;
  SensorId sensor = kNoSensor;
  std::uint32_t sequence = 0;
  std::uint8_t fragment = 0;
  std::span<const std::byte> data;
};

// One FlexRay frame on one channel.
struct SlotFrameSent {
  Stamp stamp;  // start of transmission
  Stamp end{};
  std::int64_t cycle = 0;  // running cycle
  std::uint16_t slot = 0;
  std::uint8_t channel = 0;  // 0 A, 1 B
  bool null_frame = false;
  PduId pdu = kNoPdu;
  SensorId sensor = kNoSensor;
  std::uint32_t sequence = 0;
  std::uint8_t fragment = 0;
  std::span<const std::byte> bytes;  // header, payload and trailer as on the wire
};

// A frame that was on a channel otherwise than its sender's controller sent it, or that no controller sent, noise
// included: as the best-placed of its receivers had it, so that what one of them alone could not make out is that one's
// SlotProblem and no record here. Reported when it has arrived everywhere, or is sure to arrive nowhere, which may be
// before its sender reports it. Symbols have none.
inline constexpr std::uint8_t kChannelHeaderCrc = 1;  // it fails its header CRC
inline constexpr std::uint8_t kChannelFrameCrc = 2;   // it fails its frame CRC, or is not as long as its header says
inline constexpr std::uint8_t kChannelCoding = 4;     // nobody can make it out, or no more of it than `bytes`
inline constexpr std::uint8_t kChannelCut = 8;        // it breaks off after `bytes`; a CRC that never came is not wrong
inline constexpr std::uint8_t kChannelNothing = 16;   // nothing of it reached anybody; alone
struct ChannelFrame {
  TrueTime start{};  // first and last bit, as and where they left the sender, or appeared
  TrueTime end{};
  NodeId sender = kNoNode;   // kNoNode: it came out of nothing
  std::uint8_t channel = 0;  // 0 A, 1 B
  std::uint8_t state = 0;    // bits as above, of our own decoder; 0: a sound frame
  std::uint16_t slot = 0;    // it was sent in; 0: no controller sent it, and the next three are 0, too
  std::uint8_t cycle_counter = 0;
  TrueTime sent{};                   // the stamp of its SlotFrameSent, which has the same sender
  std::uint8_t sent_channel = 0;     // and this channel
  std::span<const std::byte> bytes;  // header, payload and trailer as on the wire; none of what nobody can make out
};

// Per-slot, per-channel status as one receiver saw it, reported when it is anything but one valid frame in an owned
// slot. Bits: 1 syntax error, 2 content error, 4 boundary violation, 8 transmission conflict, 16 no frame.
struct SlotProblem {
  Stamp stamp;
  std::int64_t cycle = 0;
  std::uint16_t slot = 0;
  std::uint8_t channel = 0;
  std::uint8_t status = 0;
};

// A list of a PDU on its way: every hop is one record, so that a diagram can draw the arrows.
enum class Hop : std::uint8_t {
  kWritten = 1,      // a task's output became visible in a CNI
  kSent = 2,         // its last frame has left
  kReceived = 3,     // complete in the receiver's CNI
  kTorn = 4,         // displaced before all its fragments were there: lost
  kRead = 5,         // a task read it at its start, for the first time
  kOverwritten = 6,  // a newer list replaced it before it was ever read
  kStale = 7,        // a fragment of it came when a newer list had begun to arrive; not used
  kDiscarded = 8     // a task read it and could not use it: raw data whose strobe was not seen have no time
};
struct ListHop {
  Stamp stamp;
  Hop hop = Hop::kWritten;
  PduId pdu{};
  SensorId sensor = kNoSensor;
  std::uint32_t sequence = 0;
  std::int8_t can_bus = -1;  // -1: FlexRay
};

struct TaskRun {
  Stamp start;
  std::uint8_t task = 0;  // index in Node::tasks
  Stamp activated{};
  Stamp end{};
  bool deadline_met = true;
};

// The corrections computed from a double cycle. The offset correction acts from gOffsetCorrectionStart of this same
// cycle to its end, the rate correction from the next cycle on.
struct ClockCorrected {
  Stamp stamp;  // end of the odd cycle's static segment, before either is in force; what all
                // clocks showed at that instant, however late it was looked at
  std::int64_t cycle = 0;
  std::int32_t offset_microticks = 0;
  std::int32_t rate_microticks = 0;
  bool offset_missing = false, rate_missing = false, offset_limited = false, rate_limited = false;
};

// Protocol operation control of a node's controller went from one state to another: numbers as E-Ray's CCSV.POCS, words
// as bus/poc/text.cc. A node that begins integrated has not changed its state.
struct StateChanged {
  Stamp stamp;  // global time as the node has it in the new state
  std::uint8_t from = 0, to = 0;
  std::string_view from_name, to_name;
  std::string_view why;          // one sentence without the final stop
  std::string_view consequence;  // why start-up went this way and not another; empty where there is but one
};

// A symbol on one channel, as its sender sent it.
inline constexpr std::uint8_t kSymbolCas = 1;        // collision avoidance symbol
inline constexpr std::uint8_t kSymbolWakeup = 2;     // a wake-up pattern
inline constexpr std::uint8_t kSymbolMediaTest = 3;  // media access test symbol
struct SymbolSent {
  Stamp stamp;  // start of transmission
  Stamp end{};
  std::uint8_t channel = 0;  // 0 A, 1 B
  std::uint8_t kind = kSymbolCas;
};

// A node's supply came or went. Nothing of a node is left while it is off.
struct PowerChanged {
  Stamp stamp;  // off: by the clocks it had until then
  bool on = true;
};

// What a fault of the run's fault plan does: known to who injects it, not to any node. It acts once or many times,
// between its begin and its end.
inline constexpr std::uint8_t kFaultBegins = 1;
inline constexpr std::uint8_t kFaultActs = 2;
inline constexpr std::uint8_t kFaultEnds = 3;
struct FaultActivity {
  TrueTime at{};
  std::uint32_t fault = 0;  // index in the plan
  std::uint8_t what = kFaultBegins;
  NodeId node = kNoNode;  // the faulty node, kNoNode for the medium's faults
  std::string_view kind;  // as the plan names it, "babbling_idiot"
  std::string_view text;  // one sentence
};

// What the central guardian of one channel kept from the others, wholly or from `until` on. It belongs to no node, so
// its true time is all there is.
inline constexpr std::uint8_t kSignalFrame = 1;
inline constexpr std::uint8_t kSignalCas = 2;     // collision avoidance or media access test symbol
inline constexpr std::uint8_t kSignalWakeup = 3;  // a wake-up pattern
inline constexpr std::uint8_t kSignalUndecodable = 4;
struct GuardianIntervention {
  TrueTime at{};             // the signal begins at the coupler
  NodeId branch = kNoNode;   // on whose branch
  std::uint8_t channel = 0;  // 0 A, 1 B
  std::uint8_t signal = kSignalFrame;
  std::uint8_t reason = 0;  // as bus::GuardianReason, 0 where it was cut
  bool cut = false;         // else blocked
  TrueTime until{};         // cut: so far it went through; blocked: `at`
  std::string_view why;     // the reason in words
};

// Largest difference between any two nodes' global times within a double cycle: seen by the simulator, which belongs
// to no node, so its true time is all there is.
struct PrecisionSample {
  TrueTime at{};
  std::int64_t cycle = 0;
  Duration precision{};
};

// Input of the fusion step as it was decoded from the controller: replaying these gives every image again.
struct FusionInput {
  Stamp stamp;
  std::uint32_t step = 0;
  PduId pdu{};
  SensorId sensor = kNoSensor;
  std::uint32_t sequence = 0;
  GlobalTime measured{};                 // unwrapped time stamp of the list
  std::uint16_t count = 0;               // elements
  std::span<const std::byte> fragments;  // fragment payloads one after the other
};

// What became of one observation list.
enum class Disposition : std::uint8_t { kFused = 1, kFusedLate = 2, kHeld = 3, kDroppedTooOld = 4, kDuplicate = 5 };
struct ListFused {
  Stamp stamp;
  std::uint32_t step = 0;
  MeasurementId id;
  GlobalTime measured{};
  Disposition disposition = Disposition::kFused;
};

// One activation of the fusion task.
struct FusionStep {
  Stamp stamp;
  std::uint32_t step = 0;  // the numbered fusion instants of the diagrams
  std::uint16_t confirmed = 0;
  std::uint16_t tentative = 0;
};

// State of a confirmed track, at the time the state is valid for. State: x, y, vx, vy, ax, ay (the last two zero for
// constant-velocity models).
struct TrackState {
  Stamp stamp;
  std::uint32_t step = 0;
  TrackId track{};
  GlobalTime valid_at{};
  std::span<const double, 6> state;
  std::span<const double, 36> covariance;
  bool predicted_for_image = false;  // the output's prediction, not the filter state
};

// One observation after preprocessing or as recorded, for plots: position and its covariance.
struct ObservationSeen {
  Stamp stamp;
  MeasurementId id;
  GlobalTime measured{};
  std::uint16_t index = 0;
  double x = 0, y = 0, sxx = 0, sxy = 0, syy = 0;
};

// The real-time image of one object as decoded from the bus, in the sensor car's frame: velocities are relative to
// it. Status: the sum of the bits below. Length and width are what is typical of vehicles where they were not
// measured.
inline constexpr std::uint8_t kImageConfirmed = 1;  // else tentative
inline constexpr std::uint8_t kImageCoasting = 2;   // not observed of late: predicted only
inline constexpr std::uint8_t kImageHasLength = 4;  // length was measured
inline constexpr std::uint8_t kImageHasWidth = 8;
struct ImageObject {
  TrackId track{};
  double x = 0, y = 0, heading = 0, speed = 0, acceleration = 0, length = 0, width = 0;
  double sigma_x = 0, sigma_y = 0, correlation_xy = 0, sigma_heading = 0, sigma_speed = 0, sigma_acceleration = 0,
         sigma_length = 0, sigma_width = 0;
  std::uint8_t status = 0;
};
struct ImageWritten {
  Stamp stamp;
  std::uint32_t sequence = 0;
  GlobalTime valid_at{};            // the instant of use the image is predicted to
  GlobalTime newest_measurement{};  // of all that is fused in it
  std::span<const ImageObject> objects;
  std::span<const MeasurementId> newest;  // the newest measurement of each sensor that is fused in it
};

// What the feature service used, and what it made of it.
struct FeatureObject {
  ImageObject image;
  double time_gap_s = 0;           // infinity where there is none
  double time_to_collision_s = 0;  // infinity where there is none
  bool warning = false;
};
struct FeatureUsed {
  Stamp stamp;
  std::uint32_t image_sequence = 0;
  GlobalTime image_valid_at{};  // its age is stamp.global less this
  bool fresh = true;            // first use of this image
  std::span<const FeatureObject> objects;
  bool stale = false;  // too old to be used: nothing was judged, objects is empty
};

struct ReferenceFix {  // DGPS on the tracked car, transformed with the (erroneous) alignment
  TrueTime measured_true{};
  GlobalTime measured{};
  GlobalTime available{};
  ObjectId object{};
  double x = 0, y = 0, sigma = 0;
  double vx = 0, vy = 0, sigma_velocity = 0;  // from Doppler; not a number where the receiver gives none
  LocalTime measured_local{};                 // on the receiver's own clock, which is GPS time
};

// An object as it truly was when a node measured or used an image: that instant on the node's clocks, too.
struct TruthState {
  TrueTime at{};
  ObjectId object{};
  double x = 0, y = 0, heading = 0, speed = 0, acceleration = 0, yaw_rate = 0, length = 0, width = 0;
  LocalTime local{};
  GlobalTime global{};
  NodeId node{};
};

// What a node's process did not do in its time, or what did not come to it in its time: of runs in real time, where the
// schedule is kept by an ordinary kernel. Loss and lateness are told apart.
inline constexpr std::uint8_t kLateWakeUp = 1;  // something was due for longer than the arrival window allows
inline constexpr std::uint8_t kSlotMissed = 2;  // so late that nothing was sent in an own slot
inline constexpr std::uint8_t kLateFrame = 3;   // a frame came after its window, and was not used
inline constexpr std::uint8_t kEarlyFrame = 4;  // before it; not used either
inline constexpr std::uint8_t kFramesLost = 5;  // `count` frames of a slot never came, as the next one's cycle shows
struct TimingProblem {
  Stamp stamp;  // true time: when it was noticed; local and global: when it was due
  std::uint8_t what = kLateWakeUp;
  Duration late{};  // in real time; negative: early; of frames lost: how late that was noticed
  std::int64_t cycle = 0;
  std::uint16_t slot = 0;    // 0: none
  std::uint8_t channel = 0;  // 0 A, 1 B
  std::uint32_t count = 1;
};

// How late a process was: how often by how much, in bins of recording/records/lateness_bins.h, since it began. Told at
// its end, and now and then before.
inline constexpr std::uint8_t kLatenessOfWakeUps = 1;     // of the node's process, at what it had to do
inline constexpr std::uint8_t kLatenessOfFloor = 2;       // of a plain periodic thread beside it: the machine's own
inline constexpr std::uint8_t kLatenessOfDepartures = 3;  // of its frames, behind their action points
inline constexpr std::uint8_t kLatenessOfArrivals = 4;    // of others' frames, behind their action points on its clock
inline constexpr std::uint8_t kLatenessOfTransits = 5;    // of what came from this host: from sender to process
struct LatenessHistogram {
  Stamp stamp;
  std::uint8_t of = kLatenessOfWakeUps;
  Duration longest{};
  std::span<const std::uint64_t> counts;  // by bin, to the last that is not empty
};

// What the medium of a node's process has counted since that began, as LatenessHistogram: of runs in real time.
// Frames and signals of FlexRay, and CAN frames (bus/ports/live_medium.h).
struct MediumCounts {
  Stamp stamp;
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t not_sent = 0;   // there was no room
  std::uint64_t lost = 0;       // never heard, as the medium knows
  std::uint64_t foreign = 0;    // not of this program
  std::uint64_t malformed = 0;  // of its form, but wrong
  std::uint64_t dropped = 0;    // no room in the process itself, on its way in or out
};

// The kinds of record: this is the one list of them. A kind's number is its row, counted from 1. Logs hold that number
// and the content hash covers it, so a new kind goes to the end and no row ever moves. The log, the merge of logs and
// the place of a record in it treat every kind: none of them compiles while it does not know a row.
template <class Record> struct Kind {
  using Type = Record;
  std::string_view topic;  // its name in a log
  bool in_hash = true;
};
// For what is not of the run but of the machine it ran on, or of one who sees all clocks, which a node set of separate
// processes has not.
inline constexpr bool kNotInHash = false;

inline constexpr std::tuple kKinds{
    Kind<Measured>{"/measured"},
    Kind<CanFrameSent>{"/can_frame"},
    Kind<SlotFrameSent>{"/slot_frame"},
    Kind<SlotProblem>{"/slot_problem"},
    Kind<ListHop>{"/list_hop"},
    Kind<TaskRun>{"/task_run"},
    Kind<ClockCorrected>{"/clock_corrected"},
    Kind<PrecisionSample>{"/precision", kNotInHash},
    Kind<FusionInput>{"/fusion_input"},
    Kind<ListFused>{"/list_fused"},
    Kind<FusionStep>{"/fusion_step"},
    Kind<TrackState>{"/track"},
    Kind<ObservationSeen>{"/observation"},
    Kind<ImageWritten>{"/image"},
    Kind<FeatureUsed>{"/feature"},
    Kind<ReferenceFix>{"/reference"},
    Kind<TruthState>{"/truth"},
    Kind<StateChanged>{"/state_change"},
    Kind<SymbolSent>{"/symbol"},
    Kind<PowerChanged>{"/power"},
    Kind<FaultActivity>{"/fault"},
    Kind<GuardianIntervention>{"/guardian"},
    Kind<ChannelFrame>{"/channel_frame"},
    Kind<TimingProblem>{"/timing_problem", kNotInHash},
    Kind<LatenessHistogram>{"/lateness", kNotInHash},
    Kind<MediumCounts>{"/medium", kNotInHash},
};
inline constexpr std::size_t kKindCount = std::tuple_size_v<decltype(kKinds)>;
template <std::size_t number> using RecordAt = typename std::tuple_element_t<number - 1, decltype(kKinds)>::Type;

// The port. One function per kind of record, in the order of the list; an implementation overrides what it cares for.
template <std::size_t kinds> class SinkOf : public SinkOf<kinds - 1> {
 public:
  using SinkOf<kinds - 1>::on;
  virtual void on(const RecordAt<kinds>&) {}
};
template <> class SinkOf<0> {
 public:
  virtual ~SinkOf() = default;
  // Whether SlotFrameSent and ChannelFrame are looked at, nearly all that a drive records. Where nobody does, a drive
  // tells of none, and its FlexRay carries what frames say instead of their bits; every other record is the same.
  virtual bool wants_frames() const { return true; }
  void on() = delete;  // the name, which each kind adds to
};
class Sink : public SinkOf<kKindCount> {};

}  // namespace ttf::recording::records
