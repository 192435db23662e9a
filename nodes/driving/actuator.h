// The actuator's task: it reads commands from the bus, and hands over those that it accepts to engine, brakes and steering, from a
// dead time after its reading on. sim/world/vehicle/driven.h has the rest: lag, limits, and the reaction without commands.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "core/time.h"
#include "nodes/driving/command.h"
#include "nodes/host/step.h"
#include "sim/world/vehicle/actuator.h"

namespace ttf::nodes::driving {

// The demand on one axis of a vehicle: on engine and brakes, or on the steering. It is the newest command's value. It
// has an age of its own, since commands may cease for one axis alone, or never begin (sim/world/vehicle/actuator.h).
class Demand {
 public:
  // Notes an execution of the actuator, before all else of it. Silence counts from the first one on.
  void execute(LocalTime now) {
    if (!since_) since_ = now;
  }
  void accept(double value, LocalTime now) { value_ = value, since_ = now; }
  // Returns whether no command has come for the time `after`.
  bool alone(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const;
  // Returns the newest value. With `decay` it fades after that time. It is 0 before the first command.
  double value(const sim::world::vehicle::ActuatorConfig& config, LocalTime now) const;

 private:
  double value_ = 0.0;
  std::optional<LocalTime> since_;  // the newest command, or else the first execution
};

// The steering of a vehicle that has commands of its own for it, beside those of engine and brakes.
//
// Each of the two axes has an age of its own. If one of them gets a command, the actuation has the other's
// last value. An axis without commands for the time `after`, since the actuator's first execution, too, reacts as the
// actuator's file says. It holds its value, or lets it fade. Or the vehicle brakes, with the wheels as they were asked
// for. If neither axis gets a command, there is no actuation.
class LateralCommands {
 public:
  // `input` is the place of the port `lateral` among the task's.
  LateralCommands(const schedules::model::Cluster& cluster, const schedules::model::Task& task, std::size_t input,
                  const sim::world::vehicle::ActuatorConfig& config);
  // Reads the list, and returns the verdict. Puts it together with the step's actuation: that of engine and brakes, or
  // none.
  recording::records::CommandTaken combine(host::StepContext& context);

 private:
  sim::world::vehicle::ActuatorConfig config_;
  CommandInput input_;
  Demand pull_, wheels_;
};

// Ports `command` and, if they are bound, `emergency` and `lateral`. A list is taken once. It is refused if its instant
// is too far away, or if it is invalid. An accepted command lives until its service's next list, or until it is older
// than `oldest`. So a lost list ends no command. The strongest deceleration among the living ones counts, with the
// wheels of `command`. It is handed over when a list is new. A list that lost a fragment, or whose frame was not
// intact, never gets here (bus/cni/list_buffer.h). With `lateral` the front wheels follow that list alone
// (LateralCommands).
class Actuator final : public host::Step {
 public:
  static constexpr std::string_view kName = "actuator";  // in a schedule

  Actuator(const schedules::model::Cluster& cluster, const schedules::model::Task& task,
           const sim::world::vehicle::ActuatorConfig& config);
  void run(host::StepContext& context) override;
  bool reads_newest(std::string_view) const override { return true; }  // the newest command is the demand

 private:
  struct Port {
    CommandInput input;
    std::optional<CommandInput::Reading> living{};  // the accepted command, until the next list or its age ends it
  };
  // Those of one execution, in order. An applied one has what was handed over.
  struct Records {
    std::array<recording::records::CommandTaken, 4> all;
    std::size_t count = 0;
    void add(const recording::records::CommandTaken& taken) { all[count++] = taken; }
  };
  // Returns the verdict on a port's list, and keeps an accepted command.
  recording::records::CommandTaken read(host::StepContext& context, Port& port);
  Records run_longitudinal(host::StepContext& context);
  void hand_over(host::StepContext& context, const recording::records::CommandTaken& taken) const;

  sim::world::vehicle::ActuatorConfig config_;
  std::optional<Port> command_, emergency_;
  std::optional<LateralCommands> lateral_;
  double steering_ = 0.0;  // [rad], of the last accepted command
};

}  // namespace ttf::nodes::driving
