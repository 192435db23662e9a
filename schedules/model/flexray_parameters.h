// FlexRay parameters under their specification names: FlexRay Protocol Specification 2.1 Rev. A, annex B.
// schedules/check/checker.h checks their ranges and constraints.
//
// Units: [MT] macroticks, [uT] microticks of the node, [bit] gdBit. Times with fractions of a nanosecond are in
// picoseconds (a 12.5 ns microtick is 12'500 ps).
#pragma once

#include <array>
#include <cstdint>

namespace ttf::schedules::model {

enum class Channel : std::uint8_t { kA = 0, kB = 1 };
inline constexpr std::array kBothChannels = {Channel::kA, Channel::kB};
enum class Channels : std::uint8_t { kA = 1, kB = 2, kAB = 3 };
constexpr char letter(Channel channel) { return channel == Channel::kA ? 'A' : 'B'; }
constexpr bool includes(Channels set, Channel one) {
  return (static_cast<unsigned>(set) >> static_cast<unsigned>(one)) & 1u;
}

// Returns the default channel of a node's wake-up pattern: A if the node is attached to it.
constexpr Channel default_wakeup(Channels attached) {
  return includes(attached, Channel::kA) ? Channel::kA : Channel::kB;
}

// Global parameters: the same in every node of the cluster.
struct GlobalParameters {
  int gColdStartAttempts = 8;
  int gListenNoise = 2;
  int gMacroPerCycle = 5000;  // [MT]
  std::int64_t gdMacrotick_ps = 1'000'000;
  std::int64_t gdBit_ps = 100'000;  // 10 Mbit/s
  int gdActionPointOffset = 7;      // [MT]
  int gdStaticSlot = 84;            // [MT]
  int gNumberOfStaticSlots = 2;
  int gPayloadLengthStatic = 28;  // two-byte words
  int gdMinislot = 5;             // [MT]
  int gNumberOfMinislots = 0;
  int gdMinislotActionPointOffset = 3;  // [MT]
  int gdDynamicSlotIdlePhase = 1;       // minislots
  int gdSymbolWindow = 0;               // [MT]
  int gdNIT = 2;                        // [MT]
  int gOffsetCorrectionStart = 4998;    // [MT]
  int gSyncNodeMax = 8;
  int gMaxWithoutClockCorrectionPassive = 2;
  int gMaxWithoutClockCorrectionFatal = 4;
  int gCycleCountMax = 63;
  int gNetworkManagementVectorLength = 0;  // bytes
  int gdTSSTransmitter = 9;                // [bit]
  int gdCASRxLowMax = 91;                  // [bit]
  int gdWakeupSymbolTxLow = 60;            // [bit]
  int gdWakeupSymbolTxIdle = 180;          // [bit]
  int gdWakeupSymbolRxIdle = 59;           // [bit]
  int gdWakeupSymbolRxLow = 55;            // [bit]
  int gdWakeupSymbolRxWindow = 301;        // [bit]
  int gClusterDriftDamping = 2;            // [uT]
  std::int64_t gdMaxPropagationDelay_ps = 2'500'000;
  std::int64_t gdMinPropagationDelay_ps = 0;
  std::int64_t gdMaxMicrotick_ps = 25'000;

  std::int64_t gdCycle_ps = 5'000'000'000;
  std::int64_t baudrate = 10'000'000;  // bit/s

  // Equals gdCycle, as the checker proves.
  std::int64_t cycle_ps() const { return gMacroPerCycle * gdMacrotick_ps; }
};

inline constexpr int kSamplesPerBit = 8;  // cSamplesPerBit

// cdCAS: low bits of a collision avoidance symbol after its TSS (annex A) [bit].
inline constexpr int kCasBits = 30;

// Returns the bits on the bus from the first TSS bit to the last FES bit of a static frame. These are TSS, FSS
// and FES, and ten bits (byte start sequence and data) for each of 8 header and trailer bytes and each payload
// byte. The idle delimiter is not included.
constexpr int frame_bits(const GlobalParameters& flexray, int payload_words) {
  return flexray.gdTSSTransmitter + 1 + 80 + 20 * payload_words + 2;
}

// The parameters of one controller.
struct NodeParameters {
  Channels pChannels = Channels::kAB;    // channels to which the controller is attached
  Channel pWakeupChannel = Channel::kA;  // for its wake-up pattern
  std::int64_t pdMicrotick_ps = 25'000;
  int pSamplesPerMicrotick = 2;
  int pMicroPerCycle = 200'000;  // [uT] nominal, before rate correction
  int pKeySlotId = 0;            // 1..; every controller has a key slot (0, for no key slot, is of 3.0.1)
  bool pKeySlotUsedForStartup = false;
  bool pKeySlotUsedForSync = false;
  bool pKeySlotOnlyEnabled = false;  // single-slot mode, before a host's ALL_SLOTS command
  int pClusterDriftDamping = 2;      // [uT]
  int pOffsetCorrectionOut = 0;      // [uT]
  int pRateCorrectionOut = 0;        // [uT]
  int pDecodingCorrection = 56;      // [uT]
  int pDelayCompensationA = 0;       // [uT]
  int pDelayCompensationB = 0;       // [uT]
  int pdAcceptedStartupRange = 0;    // [uT]
  int pdListenTimeout = 0;           // [uT]
  int pMacroInitialOffsetA = 0;      // [MT]
  int pMacroInitialOffsetB = 0;      // [MT]
  int pMicroInitialOffsetA = 0;      // [uT]
  int pMicroInitialOffsetB = 0;      // [uT]
  int pLatestTx = 0;                 // minislots
  int pAllowPassiveToActive = 0;     // even/odd cycle pairs, 0: never
  bool pAllowHaltDueToClock = false;
  int pWakeupPattern = 2;
  int pExternOffsetCorrection = 0;  // [uT] largest shift of a double cycle by a host's external correction
  int pExternRateCorrection = 0;    // [uT] largest change of the rate by it
};

}  // namespace ttf::schedules::model
