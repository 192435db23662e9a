#include "keys/descriptions.h"

namespace ttf::keys {
namespace {

constexpr Description kEgo[] = {
    {"vehicle", "The vehicle is like this; absent, like a Ford Escort."},
    {"vehicle.model", "The wheels slip sideways as forces ask, or do not."},
    {"vehicle.front_axle", "The front axle is this far ahead of the centre of mass."},
    {"vehicle.rear_axle", "The rear axle is this far behind the centre of mass."},
    {"vehicle.largest_steering", "The front wheels turn by this at most, to either side."},
    {"vehicle.largest_steering_rate", "The front wheels turn no faster than this."},
    {"vehicle.fastest", "The vehicle drives no faster than this."},
    {"vehicle.largest_acceleration", "Engine and brakes give this at most."},
    {"vehicle.full_power_speed", "Above this speed the engine's power limits the acceleration."},
    {"vehicle.kinematic_below", "Below this speed the wheels do not slip."},
    {"vehicle.mass", "The vehicle has this mass."},
    {"vehicle.yaw_inertia", "The vehicle has this moment of inertia about its vertical axis."},
    {"vehicle.height", "The centre of mass is this high, so that accelerations shift the load between the axles."},
    {"vehicle.friction", "Tyres and ground have this coefficient of friction."},
    {"vehicle.front_stiffness", "The front tyres have this cornering stiffness for their load."},
    {"vehicle.rear_stiffness", "The rear tyres have this cornering stiffness for their load."},
    {"start", "The vehicle starts here; absent, it stands at the origin of the ground."},
    {"start.at", "The vehicle starts on this lane of the road, and follows it."},
    {"start.at.lane", "The rear axle starts in the middle of this lane.", "-1"},
    {"start.at.s", "The rear axle starts at this station, the length along the road.", "0"},
    {"start.x", "The middle of the rear axle starts at this x."},
    {"start.y", "The middle of the rear axle starts at this y."},
    {"start.heading", "The vehicle heads this way at first, counted from x to y."},
    {"start.speed", "The vehicle drives at this speed at first."},
    {"profile", "The vehicle drives these segments one after the other, then straight on at constant speed."},
    {"profile[].duration", "The segment lasts this long.", "2 s"},
    {"profile[].speed", "The vehicle accelerates or brakes until it has this speed.", "8.3"},
    {"profile[].acceleration",
     "The vehicle accelerates by this, 0 if absent; with `speed`, up or down to it, and by 2 m/s^2 if absent.", "-3"},
    {"profile[].yaw_rate", "The vehicle steers so that it turns at this rate.", "0.3"},
    {"profile[].steering", "The front wheels turn to this angle; absent, it follows its lane.", "0.1"},
    {"profile[].lane", "The vehicle follows this lane, and changes to it where it is on another one.", "-2"},
    {"profile[].within", "A change takes this long, on half a wave of a cosine."},
    {"actuator", "Commands on the bus drive the vehicle through this actuator, instead of `profile`."},
    {"actuator.dead_time", "Nothing happens for this time after the actuator has read a command."},
    {"actuator.lag", "The acceleration approaches a command with this time constant."},
    {"actuator.steering_lag", "The front wheels approach a command with this time constant; absent, it is `lag`."},
    {"actuator.gain", "The vehicle accelerates by this share of what it is asked for."},
    {"actuator.largest_acceleration", "A command asks for no larger acceleration."},
    {"actuator.largest_deceleration", "A command asks for no larger deceleration."},
    {"actuator.largest_steering", "A command asks for no larger angle of the front wheels, to either side."},
    {"actuator.oldest", "A command is refused whose instant is further off than this when it is read."},
    {"actuator.without_command", "The actuator does this without commands, whatever keeps them away."},
    {"actuator.without_command.reaction",
     "The actuator goes on with the last command, lets it fade, or brakes with the wheels as they are."},
    {"actuator.without_command.after",
     "The reaction begins this long after the last command began, or after the drive's start."},
    {"actuator.without_command.decay", "A command fades with this time constant."},
    {"actuator.without_command.deceleration", "The actuator brakes by this."},
    {"front", "The front bumper is this far ahead of the rear axle: gaps begin there."},
    {"width", "The vehicle is this wide."},
};

constexpr Description kRoad[] = {
    {"start", "The road's line begins here; absent, at the origin along x."},
    {"start.x", "The line begins at this x."},
    {"start.y", "The line begins at this y."},
    {"start.heading", "The line begins in this direction, counted from x to y."},
    {"lanes", "The road has these lanes, all of one width; absent, one to the right of its line."},
    {"lanes.left", "So many lanes lie to the left of the line, driven against it."},
    {"lanes.right", "So many lanes lie to the right of the line, driven along it."},
    {"lanes.width", "Each lane is this wide."},
    {"pieces", "The line has these pieces, one after the other; before and after them it goes straight on."},
    {"pieces[].length", "The piece is this long.", "100"},
    {"pieces[].curvature", "The piece has this curvature, positive to the left; 0 is a straight."},
    {"pieces[].end_curvature", "The curvature changes evenly to this at the piece's end; absent, it does not change.",
     "0.02"},
    {"closed", "The road's end is its beginning, as that of a roundabout."},
};

constexpr Description kTrafficLight[] = {
    {"name", "The light has this name.", "crossing"},
    {"at", "The light stands over the stop line of this lane; objects that follow stop there."},
    {"at.lane", "The stop line is that of this lane.", "-1"},
    {"at.s", "The stop line is at this station, the length along the road.", "120"},
    {"x", "The light stands at this x over ground.", "50"},
    {"y", "The light stands at this y over ground.", "4"},
    {"heading", "The light looks this way, counted from x to y."},
    {"phases", "The light shows these phases in turn, again and again from the start of the drive on."},
    {"phases[].light", "The light is this.", "red"},
    {"phases[].duration", "The phase lasts this long.", "10 s"},
};

}  // namespace

Descriptions ego_descriptions() { return kEgo; }
Descriptions road_descriptions() { return kRoad; }
Descriptions traffic_light_descriptions() { return kTrafficLight; }

}  // namespace ttf::keys
