// A command to the vehicle, as a list on the bus with one element: whether it is valid, an acceleration [m/s^2], and an angle of
// the front wheels [rad]. Its time stamp is the instant at which it was issued. An invalid command asks for nothing.
#pragma once

#include <array>
#include <cstdint>

#include "nodes/host/step.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::driving {

struct Command {
  bool valid = false;
  double acceleration = 0.0, steering = 0.0;
};

using CommandSignals = std::array<std::size_t, 3>;
CommandSignals bind_command(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout);
// Returns the command of a list; an empty list is invalid.
Command decode_command(const schedules::model::PduLayout& layout, const bus::cni::ListView& list,
                       const CommandSignals& signals);

// The one output of a service that commands: it numbers its lists, and records each as its readers decode it.
class CommandOutput {
 public:
  CommandOutput(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
  // `record` says why; command, list and stamp are filled in.
  void issue(host::StepContext& context, const Command& command, recording::records::CommandIssued record);

 private:
  CommandSignals signals_;
  std::uint32_t sequence_ = 0;
};

// A port of the actuator. It refuses lists whose instant is further off than `oldest`, and all without global time.
class CommandInput {
 public:
  struct Reading {
    recording::records::CommandTaken taken;
    GlobalTime issued{};
  };
  // `input` is the place of the port among the task's.
  CommandInput(const schedules::model::Cluster& cluster, const schedules::model::Task& task, std::size_t input,
               Duration oldest);
  // Returns the verdict on the port's list: kNoneNew, kLate, kInvalid or kApplied.
  Reading read(host::StepContext& context) const;
  bool is_old(const host::StepContext& context, GlobalTime issued) const;

 private:
  std::size_t input_;
  CommandSignals signals_;
  Duration round_, oldest_;
};

}  // namespace ttf::nodes::driving
