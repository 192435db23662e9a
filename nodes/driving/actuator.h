// The actuator's task: it reads commands from the bus, and hands over those that it accepts to engine, brakes and steering, from a
// dead time after its reading on. sim/world/vehicle/driven.h has the rest: lag, limits, and the reaction without commands.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "nodes/driving/command.h"
#include "nodes/driving/steering/commands.h"
#include "nodes/host/step.h"
#include "sim/world/vehicle/actuator.h"

namespace ttf::nodes::driving {

// Ports `command` and, if they are bound, `emergency` and `lateral`. A list is taken once. It is refused if its instant
// is too far away, or if it is invalid. An accepted command lives until its service's next list, or until it is older
// than `oldest`. So a lost list ends no command. The strongest deceleration among the living ones counts, with the
// wheels of `command`. It is handed over when a list is new. A list that lost a fragment, or whose frame was not
// intact, never gets here (bus/cni/list_buffer.h). With `lateral` the front wheels follow that list alone
// (steering/commands.h).
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
  std::optional<steering::LateralCommands> lateral_;
  double steering_ = 0.0;  // [rad], of the last accepted command
};

}  // namespace ttf::nodes::driving
