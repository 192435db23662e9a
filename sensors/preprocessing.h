// The common part of all kinds' preprocessing. It turns a device's raw list into a list of observations, stamped with the
// global time that the host latched at the strobe.
#pragma once

#include "nodes/host/step.h"
#include "schedules/model/cluster.h"
#include "sensors/lists.h"

namespace ttf::sensors {

class Preprocessing : public nodes::host::Step {
 public:
  // A raw list whose strobe was not seen has no time and is left out.
  void run(nodes::host::StepContext& context) final;

 protected:
  Preprocessing(const schedules::model::Cluster& cluster, const schedules::model::Task& task);
  virtual void process(nodes::host::StepContext& context, const nodes::host::Strobe& measurement) = 0;

 private:
  SensorId sensor_;
};

}  // namespace ttf::sensors
