#include "keys/descriptions.h"

namespace ttf::keys {
namespace {

// FlexRay Protocol Specification 2.1 Rev. A, annex B.
constexpr Description kGlobals[] = {
    {"gColdStartAttempts", "A coldstart node tries so often to start the cluster.", "8"},
    {"gListenNoise", "Noise makes a listen timeout longer by this factor.", "2"},
    {"gMacroPerCycle", "A cycle has so many macroticks.", "5000"},
    {"gdActionPointOffset", "A static frame begins this long after the start of its slot.", "7"},
    {"gdStaticSlot", "A static slot lasts this long.", "84"},
    {"gNumberOfStaticSlots", "A cycle has so many static slots.", "40"},
    {"gPayloadLengthStatic", "Each static frame has this payload.", "28"},
    {"gdMinislot", "A minislot lasts this long.", "5"},
    {"gNumberOfMinislots", "A cycle has so many minislots; 0: no dynamic segment.", "250"},
    {"gdMinislotActionPointOffset", "A dynamic frame begins this long after the start of its minislot.", "3"},
    {"gdDynamicSlotIdlePhase", "A dynamic slot ends with an idle phase this long.", "1"},
    {"gdSymbolWindow", "The symbol window lasts this long; 0: there is no symbol window.", "0"},
    {"gdNIT", "The network idle time lasts this long.", "386"},
    {"gOffsetCorrectionStart", "Offset correction begins at this macrotick of every odd cycle.", "4900"},
    {"gSyncNodeMax", "At most so many nodes send sync frames.", "5"},
    {"gMaxWithoutClockCorrectionPassive",
     "A node becomes passive after so many double cycles without clock correction terms.", "2"},
    {"gMaxWithoutClockCorrectionFatal", "A node halts after so many double cycles without clock correction terms.",
     "4"},
    {"gCycleCountMax", "The cycle counter begins anew after this value: 63 in FlexRay 2.1, 7, 9, ..., 63 in 3.0.1.",
     "63"},
    {"gNetworkManagementVectorLength", "The network management vector has so many bytes.", "0"},
    {"gdTSSTransmitter", "A transmission start sequence lasts this long.", "9"},
    {"gdCASRxLowMax", "A receiver takes a low phase up to this length for a collision avoidance symbol.", "91"},
    {"gdWakeupSymbolTxLow", "The low phase of a sent wake-up symbol lasts this long.", "60"},
    {"gdWakeupSymbolTxIdle", "The idle phase of a sent wake-up symbol lasts this long.", "180"},
    {"gdWakeupSymbolRxIdle", "The idle phase of a received wake-up symbol lasts at least this long.", "59"},
    {"gdWakeupSymbolRxLow", "The low phase of a received wake-up symbol lasts at least this long.", "55"},
    {"gdWakeupSymbolRxWindow", "A received wake-up symbol pair lasts at most this long.", "301"},
    {"gClusterDriftDamping", "The damping of rate correction in all nodes follows from this.", "2"},
    {"gdCycle", "A cycle lasts this long.", "5000"},
    {"gdMacrotick", "A macrotick lasts this long.", "1"},
    {"gdBit", "A bit lasts this long.", "0.1"},
    {"gdMaxPropagationDelay", "A frame reaches every receiver within this time.", "2.5"},
    {"gdMinPropagationDelay", "A frame takes at least this time to a receiver.", "0"},
    {"gdMaxMicrotick", "The longest microtick of all nodes lasts this long.", "25"},
    {"baudrate", "The bus carries so many bits a second.", "10000000"},
};

constexpr Description kNodeParameters[] = {
    {"pSamplesPerMicrotick", "A microtick has so many samples of the bus.", "2"},
    {"pMicroPerCycle", "A cycle has so many microticks before rate correction.", "200000"},
    {"pKeySlotId", "The node sends its startup or sync frames in this slot.", "1"},
    {"pClusterDriftDamping", "Rate correction pulls the node's rate back to nominal by this.", "2"},
    {"pOffsetCorrectionOut", "A larger offset correction is out of bounds.", "400"},
    {"pRateCorrectionOut", "A larger rate correction is out of bounds.", "601"},
    {"pDecodingCorrection", "A receiver finds the start of a frame earlier by this than it decodes it.", "56"},
    {"pDelayCompensationA", "The node takes this for the reception delay on channel A.", "50"},
    {"pDelayCompensationB", "The node takes this for the reception delay on channel B.", "50"},
    {"pdAcceptedStartupRange", "A startup frame may deviate by this while the node integrates.", "400"},
    {"pdListenTimeout", "The node listens this long before it starts or wakes the cluster.", "401202"},
    {"pMacroInitialOffsetA", "Integration on channel A begins at this macrotick of the slot.", "10"},
    {"pMacroInitialOffsetB", "Integration on channel B begins at this macrotick of the slot.", "10"},
    {"pMicroInitialOffsetA", "Integration on channel A begins this long before that macrotick.", "0"},
    {"pMicroInitialOffsetB", "Integration on channel B begins this long before that macrotick.", "0"},
    {"pLatestTx", "The node begins no dynamic frame after this minislot.", "235"},
    {"pAllowPassiveToActive",
     "A passive node becomes active after so many pairs of cycles with valid clock correction; 0: never.", "15"},
    {"pWakeupPattern", "A wake-up pattern repeats the wake-up symbol so often.", "2"},
    {"pExternOffsetCorrection", "An external correction shifts the cycle by this when the host asks for it."},
    {"pExternRateCorrection", "An external correction changes the rate by this when the host asks for it."},
    {"pdMicrotick", "A microtick of the node lasts this long.", "25"},
    {"pChannels", "The node is attached to these channels."},
    {"pWakeupChannel", "The node sends its wake-up pattern on this channel; absent, on A if it is attached to it."},
    {"pKeySlotUsedForStartup", "The frames in the key slot are startup frames: the node is a coldstart node.", "true"},
    {"pKeySlotUsedForSync", "The frames in the key slot are sync frames.", "true"},
    {"pKeySlotOnlyEnabled", "The node sends in its key slot only, until its host allows all slots.", "false"},
    {"pAllowHaltDueToClock", "The node halts when clock correction fails; otherwise it becomes passive.", "true"},
};

}  // namespace

Descriptions cluster_parameter_descriptions() { return kGlobals; }
Descriptions node_parameter_descriptions() { return kNodeParameters; }

}  // namespace ttf::keys
