#include "keys/descriptions.h"

namespace ttf::keys {
namespace {

constexpr Description kFault[] = {
    {"kind", "The fault is of this kind; docs/reference/faults.md describes them all.", "crash"},
    {"node", "This node works; the others fail.", "gateway", "kind=lone_coldstart"},
    {"node", "This node fails.", "gateway"},
    {"can", "The fault is on this private CAN, and so is the node.", "laser_can"},
    {"bit",
     "This bit of the frame is inverted, 0 being the start of frame and stuff bits counted; absent, a drawn one.",
     "25"},
    {"identifier", "The node's frames outside the schedule have this identifier, which no message has."},
    {"from", "The fault begins this long after the start of cycle 0; in a cold drive, after its time zero."},
    {"duration", "The fault lasts this long.", "2 ms", "kind=transient"},
    {"duration", "The fault lasts this long; absent, to the end of the drive.", "200 ms"},
    {"direction", "Frames are lost when the node sends, when it receives, or both."},
    {"channels", "The fault is on these channels."},
    {"probability", "Each chosen frame is affected with this probability."},
    {"every", "Every n-th frame of the node is chosen, the first included."},
    {"receivers", "These nodes receive the frames so; absent, all do, or for `sos_value` a drawn half.",
     "[fusion, gateway]"},
    {"signal", "The node sends noise, or its last frame again."},
    {"length", "A burst of noise lasts this long."},
    {"interval", "Bursts begin at least this long after each other."},
    {"jitter", "Each interval is longer by a time drawn from 0 to this."},
    {"mode", "The node sends one frame more in the other's slot, or its own frames with the other's frame id.", "",
     "kind=masquerading"},
    {"mode", "The node sends symbols, startup frames, or in the key slot of another.", "", "kind=duplicate_coldstart"},
    {"mode",
     "The node believes in later slots, a longer cycle, longer static slots, a longer payload, or another key slot.",
     "shifted_slots", "kind=wrong_schedule"},
    {"slot", "The frame claims to be of this static slot, which belongs to another.", "3", "kind=masquerading"},
    {"slot", "The node takes this slot for its key slot; absent, that of the next coldstart node.", "3",
     "kind=duplicate_coldstart"},
    {"slot", "The node takes this slot for its key slot.", "3", "kind=wrong_schedule"},
    {"by", "The node is wrong by this much.", "1"},
    {"shift", "Frames come late by this, or early where it is negative; it is not 0.", "1 us", "kind=sos_timing"},
    {"shift", "Frames come early or late by up to this.", "5 us", "kind=byzantine_clock"},
    {"pattern",
     "Each receiver sees a drawn shift, late at every other node, or the same turned round in every other cycle."},
    {"bits", "These bits of the region are inverted, 0 being the first on the bus; not together with `flips`.",
     "[3, 4]"},
    {"flips", "So many drawn bits of the region are inverted; not together with `bits`."},
    {"drift", "The node's oscillator deviates by this from then on.", "200"},
    {"others", "The other coldstart nodes, or all other nodes, are without supply."},
};

constexpr Description kFaultList[] = {
    {"faults", "These faults happen in a drive whose scenario has no faults of its own."},
};

}  // namespace

Descriptions fault_descriptions() { return kFault; }
Descriptions fault_list_descriptions() { return kFaultList; }

}  // namespace ttf::keys
