// The events of a drive as plain structs, and the port that reports them: the contract between the producers
// (simulator, real-time runner) and the readers (log writer, diagrams, reports, measures).
//
// Spans are views, valid during the call only. Coordinates follow ISO 8855; units are metres, seconds, radians.
// Covariances are row-major.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "core/ids.h"
#include "core/time.h"
#include "recording/records/enumerations.h"

namespace ttf::recording::records {

// The instant of an event on all three clocks, and its node. `global` is the global time as the node's
// controller shows it. A node without one has `local` there again: off FlexRay, or while its controller is not
// in normal operation (starting up, integrating, halted).
struct Stamp {
  TrueTime true_time{};
  LocalTime local{};
  GlobalTime global{};
  NodeId node{};
};

// Returns when the node's global time was or will be `at`, judged by the stamp. Unlike true times, global times
// of different nodes, or of one node before and after a restart, may differ by whole rounds of the cycle
// counter.
constexpr TrueTime true_time_of(const Stamp& stamp, GlobalTime at) { return stamp.true_time + (at - stamp.global); }

// A measurement, as the sensor's device (`stamp.node`) saw it. The time stamp that travels with the
// observations is the global time that the sensor's host latched (FusionInput::measured).
struct Measured {
  Stamp stamp;
  MeasurementId id;
  std::span<const ObjectId> truth_ids;  // per raw item, kClutterObject for clutter; truth, in the log only
};
inline constexpr ObjectId kClutterObject{0xffff};

// The records below name a list on its way by its PDU and a sequence number, which counts on where the bus'
// field wraps. With that number, `sensor` names the measurement. kNoSensor marks a list that descends from no
// single measurement, such as an image; ImageWritten names an image's measurements.

// One frame on a private CAN, as its sender saw it.
struct CanFrameSent {
  std::uint8_t bus = 0;  // index in Cluster::can_buses
  Stamp start{};         // the frame won the arbitration
  Stamp end{};           // its receivers have accepted it; the bus is idle four bit times later
  std::uint32_t identifier = 0;
  bool flexible_data_rate = false;
  PduId pdu = kNoPdu;
  SensorId sensor = kNoSensor;
  std::uint32_t sequence = 0;
  std::uint8_t fragment = 0;
  std::span<const std::byte> data;
};

// A controller on a private CAN detected an error, and its error flag is the first of an error frame. The frame is
// sent again.
struct CanErrorFrame {
  Stamp stamp;           // the end of the bit with the error
  std::uint8_t bus = 0;  // index in Cluster::can_buses
  CanError error = CanError::kBit;
  bool as_transmitter = false;
  std::uint16_t transmit_errors = 0, receive_errors = 0;  // its counters behind it
};

// A controller on a private CAN changed its state of error confinement.
struct CanStateChanged {
  Stamp stamp;
  std::uint8_t bus = 0;
  CanState from = CanState::kActive, to = CanState::kActive;
  std::uint16_t transmit_errors = 0, receive_errors = 0;
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

// A frame that differed on its channel from the frame that its sender's controller sent, or that no controller
// sent, such as noise. The record holds the frame of the best-placed receiver; an error of a single receiver is
// a SlotProblem of that receiver instead. The record is written once the frame has arrived everywhere, or can
// arrive nowhere any more, which may be before its sender records it. Symbols have no such record.
struct ChannelFrame {
  TrueTime start{};  // first and last bit, as they left the sender, or where they appeared
  TrueTime end{};
  NodeId sender = kNoNode;   // kNoNode: noise, without a sender
  std::uint8_t channel = 0;  // 0 A, 1 B
  ChannelState state{};      // by our own decoder
  std::uint16_t slot = 0;    // slot of transmission; 0: no controller sent it, and the next three are 0, too
  std::uint8_t cycle_counter = 0;
  TrueTime sent{};                   // the stamp of its SlotFrameSent, which has the same sender
  std::uint8_t sent_channel = 0;     // and this channel
  std::span<const std::byte> bytes;  // header, payload and trailer as on the wire; empty if undecodable
};

// Status of a slot on one channel as one receiver saw it. Recorded if the slot had an error, or if the frame that is
// expected there did not come.
struct SlotProblem {
  Stamp stamp;
  std::int64_t cycle = 0;
  std::uint16_t slot = 0;
  std::uint8_t channel = 0;
  SlotStatus status = SlotStatus::kValidFrame;
};

// A list of a PDU on its way: each hop is one record, so that a diagram can draw the arrows.
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

// The corrections computed from a double cycle. The offset correction acts from gOffsetCorrectionStart to the
// end of this same cycle, the rate correction from the next cycle on.
struct ClockCorrected {
  Stamp stamp;  // end of the odd cycle's static segment, before either correction acts; all clocks as they were
                // at that instant, however late it was recorded
  std::int64_t cycle = 0;
  std::int32_t offset_microticks = 0;
  std::int32_t rate_microticks = 0;
  bool offset_missing = false, rate_missing = false, offset_limited = false, rate_limited = false;
};

// A controller's protocol operation control changed its state. A node that begins integrated records no change.
struct StateChanged {
  Stamp stamp;  // global time as the node has it in the new state
  PocKind from{}, to{};
  std::string_view from_name, to_name;
  std::string_view why;          // one sentence without the final stop
  std::string_view consequence;  // why start-up took this branch; empty if only one exists
};

// A symbol on one channel, as its sender sent it.
struct SymbolSent {
  Stamp stamp;  // start of transmission
  Stamp end{};
  std::uint8_t channel = 0;  // 0 A, 1 B
  Symbol kind = Symbol::kCas;
};

// A node's supply was switched on or off. A node keeps no state while it is off.
struct PowerChanged {
  Stamp stamp;  // off: by the clocks as they were until then
  bool on = true;
};

// An activity of a fault of the fault plan. Only the injector has it, no node does. A fault acts once or many
// times, between its begin and its end.
enum class FaultAct : std::uint8_t { kBegins = 1, kActs = 2, kEnds = 3 };
struct FaultActivity {
  TrueTime at{};
  std::uint32_t fault = 0;  // index in the plan
  FaultAct what = FaultAct::kBegins;
  NodeId node = kNoNode;  // the faulty node; kNoNode for a fault of the medium
  std::string_view kind;  // as the plan names it, "babbling_idiot"
  std::string_view text;  // one sentence
};

// A bus signal that the central guardian of one channel blocked, or cut at `until`. The guardian has no clock
// of a node: true time only.
enum class GuardedSignal : std::uint8_t {
  kFrame = 1,
  kCas = 2,     // collision avoidance or media access test symbol
  kWakeup = 3,  // a wake-up pattern
  kUndecodable = 4
};
struct GuardianIntervention {
  TrueTime at{};             // the bus signal begins at the coupler
  NodeId branch = kNoNode;   // the branch of this node
  std::uint8_t channel = 0;  // 0 A, 1 B
  GuardedSignal signal = GuardedSignal::kFrame;
  GuardianReason reason = GuardianReason::kForwarded;  // kForwarded if cut
  bool cut = false;                                    // else blocked
  TrueTime until{};                                    // cut: the bus signal went through until then; blocked: `at`
  std::string_view why;                                // the reason in words
};

// The largest difference between any two nodes' global times within a double cycle, as the simulator sees it:
// true time only.
struct PrecisionSample {
  TrueTime at{};
  std::int64_t cycle = 0;
  Duration precision{};
};

// Input of the fusion step as decoded from the controller: replaying these records gives every image again.
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

// The fate of one list at the strategy. A fused list has the innovations of the observations that confirmed tracks took, in
// their gates: the sum of the squares nu' S^-1 nu, and that of their degrees of freedom. They are those at its own place
// among the lists so far. Later lists that are taken in again after it do not count again.
enum class Disposition : std::uint8_t { kFused = 1, kFusedLate = 2, kHeld = 3, kDroppedTooOld = 4, kDuplicate = 5 };
struct ListFused {
  Stamp stamp;
  std::uint32_t step = 0;
  MeasurementId id;
  GlobalTime measured{};
  Disposition disposition = Disposition::kFused;
  double innovation_squares = 0.0;
  std::uint32_t innovation_degrees = 0;
};

// One activation of the fusion task.
struct FusionStep {
  Stamp stamp;
  std::uint32_t step = 0;  // the numbered fusion instants of the diagrams
  std::uint16_t confirmed = 0;
  std::uint16_t tentative = 0;
};

// A sample of odometry that the fusion took in, as decoded: speed [m/s] and yaw rate [rad/s], each with the sigma of its noise.
// Or, with `stopped`, no newer one has come for so long that the fusion says the odometry has stopped.
struct OdometryTaken {
  Stamp stamp;
  std::uint32_t step = 0;
  MeasurementId id;
  GlobalTime measured{};
  double speed = 0.0, yaw_rate = 0.0, sigma_speed = 0.0, sigma_yaw_rate = 0.0;
  bool stopped = false;
};

// A quantity beside a track's state, as the track believes it.
struct Believed {
  double value = 0.0, sigma = 0.0;
};
// The quantities of an image's object that are not in the state: heading [rad], speed [m/s] and acceleration [m/s^2] along
// it, length and width [m]. The bus rounds them, and their sigmas by more. A sigma of 0 says that the motion model has no
// such quantity, as constant velocity has no acceleration.
struct BelievedBox {
  Believed heading, speed, acceleration, length, width;
};

// State of a confirmed track at `valid_at`: x, y, vx, vy, ax, ay (the last two are zero for constant-velocity
// models).
struct TrackState {
  Stamp stamp;
  std::uint32_t step = 0;
  TrackId track{};
  GlobalTime valid_at{};
  std::span<const double, 6> state;
  std::span<const double, 36> covariance;
  bool predicted_for_image = false;  // the prediction for the image, not the filter's state
  std::optional<BelievedBox> box{};  // a prediction for the image has it, except in old logs
};

// One observation after preprocessing or as recorded, for plots: its position and covariance.
struct ObservationSeen {
  Stamp stamp;
  MeasurementId id;
  GlobalTime measured{};
  std::uint16_t index = 0;
  double x = 0, y = 0, sxx = 0, sxy = 0, syy = 0;
};

// One object of the real-time image as decoded from the bus, in the sensor car's frame: velocities are relative
// to that car. Length and width are typical of vehicles unless measured.
enum class ImageStatus : std::uint8_t {
  kConfirmed = 1,  // else tentative
  kCoasting = 2,   // not observed of late: predicted only
  kHasLength = 4,  // length was measured
  kHasWidth = 8
};
template <> inline constexpr bool kIsBits<ImageStatus> = true;
struct ImageObject {
  TrackId track{};
  double x = 0, y = 0, heading = 0, speed = 0, acceleration = 0, length = 0, width = 0;
  double sigma_x = 0, sigma_y = 0, correlation_xy = 0, sigma_heading = 0, sigma_speed = 0, sigma_acceleration = 0,
         sigma_length = 0, sigma_width = 0;
  ImageStatus status{};
};
struct ImageWritten {
  Stamp stamp;
  std::uint32_t sequence = 0;
  GlobalTime valid_at{};            // the instant of use, to which the image is predicted
  GlobalTime newest_measurement{};  // the newest measurement fused in it
  std::span<const ImageObject> objects;
  std::span<const MeasurementId> newest;  // per sensor, the newest measurement fused in it
};

// An object as the feature service used it, with its judgement.
struct FeatureObject {
  ImageObject image;
  double time_gap_s = 0;           // infinity: none
  double time_to_collision_s = 0;  // infinity: none
  bool warning = false;
};
struct FeatureUsed {
  Stamp stamp;
  std::uint32_t image_sequence = 0;
  GlobalTime image_valid_at{};  // its age is stamp.global minus this
  bool fresh = true;            // first use of this image
  std::span<const FeatureObject> objects;
  bool stale = false;  // too old to be used: nothing was judged, and `objects` is empty
};

// A service's warning begins or ends. The time to collision is infinite without an approach; the track is kNoTrack
// without an object. Each side of the vehicle has a blind spot of its own.
enum class WarningKind : std::uint8_t {
  kForwardCollision = 0,
  kEmergencyBraking = 1,
  kLaneDeparture = 2,
  kBlindSpotLeft = 3,
  kBlindSpotRight = 4
};
inline constexpr std::size_t kWarningKinds = 5;
struct Warning {
  Stamp stamp;
  WarningKind service = WarningKind::kForwardCollision;
  bool on = false;
  TrackId track{};
  double time_to_collision_s = 0;
};

// A command of a service to the actuator: acceleration [m/s^2] and angle of the front wheels [rad]. An invalid one asks for
// nothing. The gap [m] and the object's speed [m/s] are those that it rests on; the gap is infinite without an object ahead.
enum class CommandReason : std::uint8_t { kNothing = 0, kSetSpeed = 1, kGap = 2, kEmergency = 3, kPlan = 4, kLane = 5 };
struct CommandIssued {
  Stamp stamp;
  PduId pdu{};
  std::uint32_t sequence = 0;
  bool valid = false;
  CommandReason reason = CommandReason::kNothing;
  double acceleration = 0, steering = 0;
  double own_speed = 0, gap = 0, speed_ahead = 0;
  TrackId track{};  // the object ahead, if there is one
};

// An actuator's reading of a command: it is applied from the instant `from` on, or not. A reading has a record for the
// list of adaptive cruise control, and one for each new list of another service. An earlier command that counts on has
// one of its own. An applied one has the actuation that was handed over. Several of one reading have the same.
enum class CommandVerdict : std::uint8_t {
  kApplied = 0,
  kNoneNew = 1,
  kInvalid = 2,
  kLate = 3,
  kNothingAsked = 4,  // by a service other than cruise control
  kWeaker = 5         // the service asks for less than another one
};
struct CommandTaken {
  Stamp stamp;
  PduId pdu{};
  std::uint32_t sequence = 0;
  CommandVerdict verdict = CommandVerdict::kApplied;
  double acceleration = 0, steering = 0;
  TrueTime from{};
};

// A detection of a detector that several cameras share, at its end. By modes it is recorded at its begin. The picture is
// that of its begin. `area` is the share of the picture that was looked at, `took` the simulated time of the detector.
struct DetectionMade {
  Stamp stamp;
  TrueTime begin{};
  MeasurementId id;         // the picture
  std::uint32_t frame = 0;  // SequencePlanned::frame
  std::uint16_t place = 0;  // in the frame's sequence, from 0
  bool secondary = false;
  double area = 1.0;
  Duration took{};
  std::uint16_t found = 0;
};

// A frame of detections as its detector planned it or its mode says, at the execution that begins it. The letters of `text` name cameras
// in the order of the detector's ports, capital ones primary detections (schedules/sequence/detections.h).
struct SequencePlanned {
  Stamp stamp;
  std::uint32_t frame = 0;  // counted from 0
  std::string_view text;
  Duration bound{};
  Duration length{};  // expected, by the times of earlier detections
};

// A motion plan: the speed [m/s] to drive at, and the planner's state. An invalid one
// asks for nothing. It rests on the most important object. The own place is that on the lane [m, rad]. The region [px]
// holds the object. Without an object the track is kNoTrack. Without a region the camera is kNoSensor.
struct PlanMade {
  Stamp stamp;
  PduId pdu{};
  std::uint32_t sequence = 0;
  bool valid = false;
  PlannerState state = PlannerState::kDecelerate;
  double speed = 0;
  TrackId track = kNoTrack;
  double gap = 0, speed_ahead = 0;
  double own_speed = 0, along = 0, offset = 0, heading = 0;
  SensorId camera = kNoSensor;
  std::array<double, 4> region{};  // left and upper edge from the picture's middle, width, height
};

struct ReferenceFix {  // DGPS on the tracked car, transformed with the (erroneous) alignment
  TrueTime measured_true{};
  GlobalTime measured{};
  GlobalTime available{};
  ObjectId object{};
  double x = 0, y = 0, sigma = 0;
  double vx = 0, vy = 0, sigma_velocity = 0;  // from Doppler; not a number if the receiver gives none
  LocalTime measured_local{};                 // on the receiver's own clock, which shows GPS time
};

// The true state of an object when a node measured or used an image; that instant on the node's clocks, too. The
// acceleration is without white noise, which has no value at an instant (sim/world/world.h). In logs of before 2026-11-24 it
// contains the noise of its 10 ms.
struct TruthState {
  TrueTime at{};
  ObjectId object{};
  double x = 0, y = 0, heading = 0, speed = 0, acceleration = 0, yaw_rate = 0, length = 0, width = 0;
  LocalTime local{};
  GlobalTime global{};
  NodeId node{};
  // No sensor could measure it: it is in no field, or hidden (sensors/in_view.h). Also false in logs of before 2026-11-30, and
  // where fields are unknown.
  bool out_of_view = false;
};

// The true state of the sensors' vehicle over ground, at the instants of TruthState; absent where it stands at the origin of
// the ground. The origin of its axes is the middle of the rear axle; velocity and acceleration are along its own axes.
struct EgoTruth {
  TrueTime at{};
  double x = 0, y = 0, heading = 0, vx = 0, vy = 0, yaw_rate = 0, acceleration = 0;
  LocalTime local{};
  GlobalTime global{};
  NodeId node{};
};

// A missed instant in real time, where an ordinary kernel keeps the schedule: the node's process was late, or a
// frame was. Loss and lateness are separate kinds.
struct TimingProblem {
  Stamp stamp;  // true time: when it was noticed; local and global: when it was due
  TimingFault what = TimingFault::kLateWakeUp;
  Duration late{};  // in real time; negative: early; for lost frames: how late the loss was noticed
  std::int64_t cycle = 0;
  std::uint16_t slot = 0;    // 0: none
  std::uint8_t channel = 0;  // 0 A, 1 B
  std::uint32_t count = 1;
};

// How often a process was late, by bins of recording/records/lateness_bins.h, since it began. Recorded at its
// end, and now and then before.
enum class LatenessOf : std::uint8_t {
  kWakeUps = 1,     // the acts of the node's process
  kFloor = 2,       // a plain periodic thread beside it: the machine's own
  kDepartures = 3,  // its frames, behind their action points
  kArrivals = 4,    // others' frames, behind their action points on its clock
  kTransits = 5     // from sender to process, for frames of the same machine
};
struct LatenessHistogram {
  Stamp stamp;
  LatenessOf of = LatenessOf::kWakeUps;
  Duration longest{};
  std::span<const std::uint64_t> counts;  // by bin, up to the last that is not empty
};

// The counts of a node's live medium since it began, recorded when LatenessHistogram is: in real time only.
// They count FlexRay frames and bus signals, and CAN frames (bus/ports/live_medium.h).
struct MediumCounts {
  Stamp stamp;
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t not_sent = 0;   // no room
  std::uint64_t lost = 0;       // never received, as the medium detects
  std::uint64_t foreign = 0;    // not of this program
  std::uint64_t malformed = 0;  // in this program's form, but wrong
  std::uint64_t dropped = 0;    // no room in the process itself, inwards or outwards
};

// The one list of the kinds of record. A kind's number is its row, counted from 1. Logs hold that number and
// the content hash covers it, so a new kind goes to the end and no row ever moves. The log, the merge of logs
// and the place of a record in it treat every kind: each fails to compile if it misses a row.
template <class Record> struct Kind {
  std::string_view topic;  // its name in a log
  bool in_hash = true;
};
// Marks a kind that describes the machine, not the drive, or that needs all clocks at once, which a node set of
// separate processes lacks.
inline constexpr bool kNotInHash = false;

template <class... Records> struct KindList {
  using Types = std::tuple<Records...>;  // only named: to make it is dear to compile
  static constexpr std::size_t kCount = sizeof...(Records);

  constexpr explicit KindList(Kind<Records>... kinds) : topics{kinds.topic...}, in_hash{kinds.in_hash...} {}
  // A kind's number; 0 if it is not in the list.
  template <class Record> static constexpr std::size_t number_of() {
    std::size_t number = 0, row = 0;
    ((++row, number = std::is_same_v<Record, Records> ? row : number), ...);
    return number;
  }

  std::array<std::string_view, kCount> topics;  // indexed by number - 1, as the next
  std::array<bool, kCount> in_hash;
};

inline constexpr KindList kKinds{
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
    Kind<CanErrorFrame>{"/can_error"},
    Kind<CanStateChanged>{"/can_state"},
    Kind<OdometryTaken>{"/odometry"},
    Kind<EgoTruth>{"/ego"},
    Kind<Warning>{"/warning"},
    Kind<CommandIssued>{"/command"},
    Kind<CommandTaken>{"/actuator"},
    Kind<DetectionMade>{"/detection"},
    Kind<SequencePlanned>{"/sequence"},
    Kind<PlanMade>{"/plan"},
};
inline constexpr std::size_t kKindCount = kKinds.kCount;
template <std::size_t number> using RecordAt = std::tuple_element_t<number - 1, decltype(kKinds)::Types>;

// The port: one function per kind of record, in the order of the list. An implementation overrides those it
// needs.
template <std::size_t kinds> class SinkOf : public SinkOf<kinds - 1> {
 public:
  using SinkOf<kinds - 1>::on;
  virtual void on(const RecordAt<kinds>&) {}
};
template <> class SinkOf<0> {
 public:
  virtual ~SinkOf() = default;
  // Returns whether the sink uses SlotFrameSent and ChannelFrame, which are nearly all records of a drive. If
  // not, the drive records neither, and its FlexRay carries the frames' content instead of their bits. All
  // other records are the same.
  virtual bool wants_frames() const { return true; }
  void on() = delete;  // declares the name, which each kind overloads
};
class Sink : public SinkOf<kKindCount> {};

}  // namespace ttf::recording::records
