// Maps FlexRay's parameters to FIBEX 3.1 (ASAM MCD-2 NET): specification name -> element, in the order of the
// schema, and values to their text. FIBEX has times in microseconds and the bit rate in bit/s. Everything else
// is in the specification's unit; names and ranges are those of schedules/file/parameter_table.h.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "schedules/model/flexray_parameters.h"

namespace ttf::schedules::exchange::fibex {

struct FibexParameter {
  std::string_view name;
  std::string_view element;
};

// In fx:CLUSTER, after fx:SPEED (the baudrate); flexray:WAKE-UP follows gdTSSTransmitter.
inline constexpr FibexParameter kFibexCluster[] = {
    {"gColdStartAttempts", "flexray:COLD-START-ATTEMPTS"},
    {"gdActionPointOffset", "flexray:ACTION-POINT-OFFSET"},
    {"gdDynamicSlotIdlePhase", "flexray:DYNAMIC-SLOT-IDLE-PHASE"},
    {"gdMinislot", "flexray:MINISLOT"},
    {"gdMinislotActionPointOffset", "flexray:MINISLOT-ACTION-POINT-OFFSET"},
    {"gdNIT", "flexray:N-I-T"},
    {"gdStaticSlot", "flexray:STATIC-SLOT"},
    {"gdSymbolWindow", "flexray:SYMBOL-WINDOW"},
    {"gdTSSTransmitter", "flexray:T-S-S-TRANSMITTER"},
    {"gListenNoise", "flexray:LISTEN-NOISE"},
    {"gMacroPerCycle", "flexray:MACRO-PER-CYCLE"},
    {"gdMacrotick", "flexray:MACROTICK"},
    {"gMaxWithoutClockCorrectionFatal", "flexray:MAX-WITHOUT-CLOCK-CORRECTION-FATAL"},
    {"gMaxWithoutClockCorrectionPassive", "flexray:MAX-WITHOUT-CLOCK-CORRECTION-PASSIVE"},
    {"gNetworkManagementVectorLength", "flexray:NETWORK-MANAGEMENT-VECTOR-LENGTH"},
    {"gNumberOfMinislots", "flexray:NUMBER-OF-MINISLOTS"},
    {"gNumberOfStaticSlots", "flexray:NUMBER-OF-STATIC-SLOTS"},
    {"gOffsetCorrectionStart", "flexray:OFFSET-CORRECTION-START"},
    {"gPayloadLengthStatic", "flexray:PAYLOAD-LENGTH-STATIC"},
    {"gSyncNodeMax", "flexray:SYNC-NODE-MAX"},
    {"gdCASRxLowMax", "flexray:CAS-RX-LOW-MAX"},
    {"gdBit", "flexray:BIT"},
    {"gdCycle", "flexray:CYCLE"},
    {"gClusterDriftDamping", "flexray:CLUSTER-DRIFT-DAMPING"},
};

inline constexpr FibexParameter kFibexWakeUp[] = {
    {"gdWakeupSymbolRxIdle", "flexray:WAKE-UP-SYMBOL-RX-IDLE"},
    {"gdWakeupSymbolRxLow", "flexray:WAKE-UP-SYMBOL-RX-LOW"},
    {"gdWakeupSymbolRxWindow", "flexray:WAKE-UP-SYMBOL-RX-WINDOW"},
    {"gdWakeupSymbolTxIdle", "flexray:WAKE-UP-SYMBOL-TX-IDLE"},
    {"gdWakeupSymbolTxLow", "flexray:WAKE-UP-SYMBOL-TX-LOW"},
};

// Parameters without a place in FIBEX: in fx:CLUSTER/fx:MANUFACTURER-EXTENSION, in a namespace of our own.
inline constexpr FibexParameter kFibexExtension[] = {
    {"gdMaxPropagationDelay", "ttf:MAX-PROPAGATION-DELAY"},
    {"gdMinPropagationDelay", "ttf:MIN-PROPAGATION-DELAY"},
    {"gdMaxMicrotick", "ttf:MAX-MICROTICK"},
};

// The same, unless the cycle counter is that of 2.1.
inline constexpr FibexParameter kFibexRound[] = {{"gCycleCountMax", "ttf:CYCLE-COUNT-MAX"}};

// In fx:CONTROLLER, after flexray:KEY-SLOT-USAGE (pKeySlotId and its use).
inline constexpr FibexParameter kFibexController[] = {
    {"pClusterDriftDamping", "flexray:CLUSTER-DRIFT-DAMPING"},
    {"pDecodingCorrection", "flexray:DECODING-CORRECTION"},
    {"pdListenTimeout", "flexray:LISTEN-TIMEOUT"},
    {"pExternOffsetCorrection", "flexray:EXTERN-OFFSET-CORRECTION"},
    {"pExternRateCorrection", "flexray:EXTERN-RATE-CORRECTION"},
    {"pLatestTx", "flexray:LATEST-TX"},
    {"pMicroPerCycle", "flexray:MICRO-PER-CYCLE"},
    {"pOffsetCorrectionOut", "flexray:OFFSET-CORRECTION-OUT"},
    {"pRateCorrectionOut", "flexray:RATE-CORRECTION-OUT"},
    {"pSamplesPerMicrotick", "flexray:SAMPLES-PER-MICROTICK"},
    {"pDelayCompensationA", "flexray:DELAY-COMPENSATION-A"},
    {"pDelayCompensationB", "flexray:DELAY-COMPENSATION-B"},
    {"pWakeupPattern", "flexray:WAKE-UP-PATTERN"},
    {"pAllowHaltDueToClock", "flexray:ALLOW-HALT-DUE-TO-CLOCK"},
    {"pAllowPassiveToActive", "flexray:ALLOW-PASSIVE-TO-ACTIVE"},
    {"pdAcceptedStartupRange", "flexray:ACCEPTED-STARTUP-RANGE"},
    {"pMacroInitialOffsetA", "flexray:MACRO-INITIAL-OFFSET-A"},
    {"pMacroInitialOffsetB", "flexray:MACRO-INITIAL-OFFSET-B"},
    {"pMicroInitialOffsetA", "flexray:MICRO-INITIAL-OFFSET-A"},
    {"pMicroInitialOffsetB", "flexray:MICRO-INITIAL-OFFSET-B"},
    {"pKeySlotOnlyEnabled", "flexray:SINGLE-SLOT-ENABLED"},
    {"pdMicrotick", "flexray:MICROTICK"},
};

// Also in fx:CONTROLLER: pdMaxDrift [microticks], which follows from pdListenTimeout = 2 (pMicroPerCycle +
// pdMaxDrift).
inline constexpr int kLeastMaxDrift = 2, kMostMaxDrift = 1923;

// Returns the parameter's value as FIBEX writes it. The name must be in the tables.
std::string fibex_value(const model::GlobalParameters& parameters, std::string_view name);
std::string fibex_value(const model::NodeParameters& parameters, std::string_view name);

// Sets the parameter from FIBEX's text. For a wrong text it returns the expectation ("must be 2..31") and
// changes nothing.
std::optional<std::string> set_fibex_value(model::GlobalParameters& parameters, std::string_view name,
                                           std::string_view text);
std::optional<std::string> set_fibex_value(model::NodeParameters& parameters, std::string_view name,
                                           std::string_view text);

// Returns the value as a cluster file writes it, in its own units (pdMicrotick: ns there, us here).
std::string yaml_value(const model::GlobalParameters& parameters, std::string_view name);
std::string yaml_value(const model::NodeParameters& parameters, std::string_view name);

}  // namespace ttf::schedules::exchange::fibex
