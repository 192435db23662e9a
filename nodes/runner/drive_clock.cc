#include "nodes/runner/drive_clock.h"

#include "core/check.h"
#include "core/int128.h"
#include "timebase/floor_div.h"

namespace ttf::nodes::runner {
namespace {

constexpr std::int64_t kPpm = 1'000'000;

std::int64_t scaled_down(std::int64_t ns, std::int64_t times, std::int64_t by) {
  return static_cast<std::int64_t>(timebase::floor_div(static_cast<Int128>(ns) * times, by));
}
std::int64_t scaled_up(std::int64_t ns, std::int64_t times, std::int64_t by) { return -scaled_down(-ns, times, by); }

}  // namespace

DriveClock::DriveClock(bus::ports::MachineTime origin, std::int64_t scale_ppm)
    : origin_(origin), scale_ppm_(scale_ppm) {
  TTF_CHECK(scale_ppm > 0, "time scale of {} ppm", scale_ppm);
}

TrueTime DriveClock::drive_time(bus::ports::MachineTime at) const { return TrueTime{} + in_drive(at - origin_); }
bus::ports::MachineTime DriveClock::machine_time(TrueTime at) const { return origin_ + in_real(at - TrueTime{}); }
Duration DriveClock::in_drive(Duration real) const { return {scaled_down(real.ns, kPpm, scale_ppm_)}; }
Duration DriveClock::in_real(Duration drive) const { return {scaled_up(drive.ns, scale_ppm_, kPpm)}; }

bus::ports::MachineTime DriveClock::next_turn(Duration period, Duration phase, bus::ports::MachineTime now) const {
  const Duration since = now - (origin_ + phase);
  const auto turn = static_cast<std::int64_t>(timebase::floor_div(static_cast<Int128>(since.ns), period.ns)) + 1;
  return origin_ + phase + Duration{turn * period.ns};
}

}  // namespace ttf::nodes::runner
