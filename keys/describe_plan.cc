#include "keys/descriptions.h"

namespace ttf::keys {
namespace {

constexpr Description kPlan[] = {
    {"plan", "The program chooses what the file leaves out, with these demands (docs/schedules/synthesis.md)."},
    {"plan.cycle", "The cycle has one of these lengths, instead of `gdCycle`."},
    {"plan.cycle.shortest", "This is the shortest of the lengths.", "8.5 ms"},
    {"plan.cycle.longest", "No length is above this.", "9 ms"},
    {"plan.cycle.step", "The lengths are this far apart.", "5 us"},
    {"plan.payload", "A static slot has one of these payloads, instead of `gPayloadLengthStatic`."},
    {"plan.payload.shortest", "This is the shortest of the payloads; even.", "32"},
    {"plan.payload.longest", "No payload is above this; even.", "96"},
    {"plan.payload.step", "The payloads are this far apart; even."},
    {"plan.sensors", "The cluster has these further sensors, each with a device, a host, lists, a CAN and slots."},
    {"plan.sensors.NAME.like", "The sensor is a copy of this one.", "laser"},
    {"plan.sensors.NAME.kind", "The sensor is of this kind, with its steps and layouts; absent, of its original's.",
     "radar"},
    {"plan.sensors.NAME.raw", "The device's list has at most so many elements; absent, as its original.", "32"},
    {"plan.sensors.NAME.objects", "The host's list has at most so many elements; absent, as its original.", "12"},
    {"plan.sensors.NAME.preprocessing", "The host's task takes at most this time; absent, as its original.", "14 ms"},
    {"plan.rates", "Sensors without `repetition` measure so often."},
    {"plan.rates.NAME.shortest", "The sensor's period is at least this.", "34 ms"},
    {"plan.rates.NAME.longest", "The sensor's period is at most this.", "40 ms"},
    {"plan.chains", "Data goes along these chains; a sensor without one has a chain to the task that uses the image."},
    {"plan.chains.NAME.from", "The chain begins with measurements of this sensor.", "laser"},
    {"plan.chains.NAME.to", "The chain ends where this task begins, which time activates.", "feature.use"},
    {"plan.chains.NAME.largest_age", "Measurements are at most this old at the chain's end; absent, of any age.",
     "60 ms"},
    {"plan.objective", "These are best, the most important first; absent, the worst age (docs/schedules/synthesis.md).",
     "[data_age, worst_age, slots]"},
    {"plan.error",
     "The objective `error` is counted with these: the expected squared error of a position, on one axis."},
    {"plan.error.motion", "The position moves at constant velocity, or as a random walk."},
    {"plan.error.over", "The mean is that over the uses of a round, or over all time."},
    {"plan.error.process_noise", "The spectral density of the acceleration (of a random walk: of the velocity).",
     "1.0"},
    {"plan.error.process_noises", "The value is the largest ratio to the least error of each density: minimax regret.",
     "[0.01, 1, 25]"},
    {"plan.error.sigma", "Each sensor of a chain measures the position with this standard deviation."},
    {"plan.gap_error",
     "The objective `gap_error` is counted with these: the expected squared error of a following vehicle's gap."},
    {"plan.gap_error.time_gap", "The vehicle keeps this time gap."},
    {"plan.gap_error.lag", "The vehicle's acceleration follows its command with this lag."},
    {"plan.gap_error.memory", "The speed of the vehicle ahead returns to its mean in this time."},
    {"plan.gap_error.density", "The spectral density of the acceleration of the vehicle ahead."},
    {"plan.gap_error.delay", "A command acts so long after the chain's end."},
    {"plan.one_channel", "Each of these lists is sent on one channel, which the plan chooses.", "[image]"},
    {"plan.slot_multiplexing",
     "A static slot may have several senders, in different cycles, as in FlexRay 3.0; otherwise one in all cycles, as "
     "in 2.1."},
    {"plan.in_order", "Lists are fused in the order of their measurements; otherwise they may wait for older ones."},
};

}  // namespace

Descriptions plan_descriptions() { return kPlan; }

}  // namespace ttf::keys
