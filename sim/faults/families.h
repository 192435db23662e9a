// The families of faults. Each function makes the working part of a fault of the plan; the family's source file
// says what it does, and how. docs/reference/faults.md has the whole table.
#pragma once

#include <memory>

#include "sim/faults/active_fault.h"

namespace ttf::sim::faults {

// Supply and clock.
std::unique_ptr<ActiveFault> make_crash(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_lone_coldstart(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_drift(const FaultSetting& setting);

// The node's own frames, as they leave or towards some receivers.
std::unique_ptr<ActiveFault> make_omission(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_sos_timing(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_sos_value(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_header_flips(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_payload_flips(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_trailer_flips(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_channel_swap(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_byzantine_clock(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_masquerading(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_wrong_schedule(const FaultSetting& setting);

// Signals out of nothing.
std::unique_ptr<ActiveFault> make_babbling_idiot(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_noise(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_duplicate_coldstart(const FaultSetting& setting);  // not by the same key slot

// The medium.
std::unique_ptr<ActiveFault> make_transient(const FaultSetting& setting);

// The private CANs.
std::unique_ptr<ActiveFault> make_can_omission(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_can_corruption(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_can_babbling(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_can_bus_off(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_can_stuck_dominant(const FaultSetting& setting);
std::unique_ptr<ActiveFault> make_can_no_acknowledgement(const FaultSetting& setting);

// Makes the working part of a fault by its kind and mode.
std::unique_ptr<ActiveFault> make_active_fault(const FaultSetting& setting);

}  // namespace ttf::sim::faults
