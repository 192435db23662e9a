// The FlexRay parameters of a cluster file: name, range, unit and member in one table per type. Ranges: FlexRay
// Protocol Specification 2.1 Rev. A, annex B; for narrower registers of Bosch's E-Ray controller, theirs
// (GTUC10). gCycleCountMax has that of 3.0.1 (schedules/model/repetitions.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "schedules/model/flexray_parameters.h"

namespace ttf::schedules::file {

template <class Struct> struct IntegerParameter {
  std::string_view name;
  int low;
  int high;
  std::string_view unit;
  int Struct::*member;
  std::optional<int> otherwise = std::nullopt;  // default; without one the key is required
};

// Written as a decimal number of `unit`, stored as a whole number of picoseconds (or bit/s).
template <class Struct> struct ScaledParameter {
  std::string_view name;
  std::int64_t scale;
  std::int64_t low;
  std::int64_t high;
  std::string_view unit;
  std::int64_t Struct::*member;
};

template <class Struct> struct FlagParameter {
  std::string_view name;
  bool Struct::*member;
};

using Global = model::GlobalParameters;
using Local = model::NodeParameters;

inline constexpr IntegerParameter<Global> kGlobalIntegers[] = {
    {"gColdStartAttempts", 2, 31, "", &Global::gColdStartAttempts},
    {"gListenNoise", 2, 16, "", &Global::gListenNoise},
    {"gMacroPerCycle", 10, 16000, "macroticks", &Global::gMacroPerCycle},
    {"gdActionPointOffset", 1, 63, "macroticks", &Global::gdActionPointOffset},
    {"gdStaticSlot", 4, 661, "macroticks", &Global::gdStaticSlot},
    {"gNumberOfStaticSlots", 2, 1023, "", &Global::gNumberOfStaticSlots},
    {"gPayloadLengthStatic", 0, 127, "two-byte words", &Global::gPayloadLengthStatic},
    {"gdMinislot", 2, 63, "macroticks", &Global::gdMinislot},
    {"gNumberOfMinislots", 0, 7986, "", &Global::gNumberOfMinislots},
    {"gdMinislotActionPointOffset", 1, 31, "macroticks", &Global::gdMinislotActionPointOffset},
    {"gdDynamicSlotIdlePhase", 0, 2, "minislots", &Global::gdDynamicSlotIdlePhase},
    {"gdSymbolWindow", 0, 142, "macroticks", &Global::gdSymbolWindow},
    {"gdNIT", 2, 805, "macroticks", &Global::gdNIT},
    {"gOffsetCorrectionStart", 9, 15999, "macroticks", &Global::gOffsetCorrectionStart},
    {"gSyncNodeMax", 2, 15, "", &Global::gSyncNodeMax},
    {"gMaxWithoutClockCorrectionPassive", 1, 15, "double cycles", &Global::gMaxWithoutClockCorrectionPassive},
    {"gMaxWithoutClockCorrectionFatal", 1, 15, "double cycles", &Global::gMaxWithoutClockCorrectionFatal},
    {"gCycleCountMax", 7, 63, "", &Global::gCycleCountMax},
    {"gNetworkManagementVectorLength", 0, 12, "bytes", &Global::gNetworkManagementVectorLength},
    {"gdTSSTransmitter", 3, 15, "gdBit", &Global::gdTSSTransmitter},
    {"gdCASRxLowMax", 67, 99, "gdBit", &Global::gdCASRxLowMax},
    {"gdWakeupSymbolTxLow", 15, 60, "gdBit", &Global::gdWakeupSymbolTxLow},
    {"gdWakeupSymbolTxIdle", 45, 180, "gdBit", &Global::gdWakeupSymbolTxIdle},
    {"gdWakeupSymbolRxIdle", 14, 59, "gdBit", &Global::gdWakeupSymbolRxIdle},
    {"gdWakeupSymbolRxLow", 11, 59, "gdBit", &Global::gdWakeupSymbolRxLow},
    {"gdWakeupSymbolRxWindow", 76, 301, "gdBit", &Global::gdWakeupSymbolRxWindow},
    {"gClusterDriftDamping", 0, 5, "microticks", &Global::gClusterDriftDamping},
};

inline constexpr ScaledParameter<Global> kGlobalScaled[] = {
    {"gdCycle", 1'000'000, 10'000'000, 16'000'000'000, "us", &Global::gdCycle_ps},
    {"gdMacrotick", 1'000'000, 1'000'000, 6'000'000, "us", &Global::gdMacrotick_ps},
    {"gdBit", 1'000'000, 100'000, 400'000, "us", &Global::gdBit_ps},
    {"gdMaxPropagationDelay", 1'000'000, 0, 2'500'000, "us", &Global::gdMaxPropagationDelay_ps},
    {"gdMinPropagationDelay", 1'000'000, 0, 2'500'000, "us", &Global::gdMinPropagationDelay_ps},
    {"gdMaxMicrotick", 1'000, 12'500, 50'000, "ns", &Global::gdMaxMicrotick_ps},
    {"baudrate", 1, 2'500'000, 10'000'000, "bit/s", &Global::baudrate},
};

inline constexpr IntegerParameter<Local> kNodeIntegers[] = {
    {"pSamplesPerMicrotick", 1, 4, "", &Local::pSamplesPerMicrotick},
    {"pMicroPerCycle", 640, 640000, "microticks", &Local::pMicroPerCycle},
    {"pKeySlotId", 1, 1023, "", &Local::pKeySlotId},
    {"pClusterDriftDamping", 0, 20, "microticks", &Local::pClusterDriftDamping},
    {"pOffsetCorrectionOut", 5, 15266, "microticks", &Local::pOffsetCorrectionOut},
    {"pRateCorrectionOut", 2, 1923, "microticks", &Local::pRateCorrectionOut},
    {"pDecodingCorrection", 14, 143, "microticks", &Local::pDecodingCorrection},
    {"pDelayCompensationA", 0, 200, "microticks", &Local::pDelayCompensationA},
    {"pDelayCompensationB", 0, 200, "microticks", &Local::pDelayCompensationB},
    {"pdAcceptedStartupRange", 0, 1875, "microticks", &Local::pdAcceptedStartupRange},
    {"pdListenTimeout", 1284, 1283846, "microticks", &Local::pdListenTimeout},
    {"pMacroInitialOffsetA", 2, 72, "macroticks", &Local::pMacroInitialOffsetA},
    {"pMacroInitialOffsetB", 2, 72, "macroticks", &Local::pMacroInitialOffsetB},
    {"pMicroInitialOffsetA", 0, 240, "microticks", &Local::pMicroInitialOffsetA},
    {"pMicroInitialOffsetB", 0, 240, "microticks", &Local::pMicroInitialOffsetB},
    {"pLatestTx", 0, 7980, "minislots", &Local::pLatestTx},
    {"pAllowPassiveToActive", 0, 31, "pairs of cycles", &Local::pAllowPassiveToActive},
    {"pWakeupPattern", 2, 63, "", &Local::pWakeupPattern},
    {"pExternOffsetCorrection", 0, 7, "microticks", &Local::pExternOffsetCorrection, 0},  // GTUC11.EOC
    {"pExternRateCorrection", 0, 7, "microticks", &Local::pExternRateCorrection, 0},      // GTUC11.ERC
};

inline constexpr ScaledParameter<Local> kNodeScaled[] = {
    {"pdMicrotick", 1'000, 12'500, 50'000, "ns", &Local::pdMicrotick_ps},
};

inline constexpr FlagParameter<Local> kNodeFlags[] = {
    {"pKeySlotUsedForStartup", &Local::pKeySlotUsedForStartup},
    {"pKeySlotUsedForSync", &Local::pKeySlotUsedForSync},
    {"pKeySlotOnlyEnabled", &Local::pKeySlotOnlyEnabled},
    {"pAllowHaltDueToClock", &Local::pAllowHaltDueToClock},
};

}  // namespace ttf::schedules::file
