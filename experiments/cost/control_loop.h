// A control loop of blocks: continuous plants, and discrete systems that hold their outputs.
//
//   plant      x' = a x + b (u + w),  y = c x;   w: independent white noises of one density at all inputs
//   discrete   when executed: x+ = a x + b (u + n),  y+ = c x + d (u + n);   between: x and y are held
// Every block has one output. A further output of a plant is a block, too. A plant reads the outputs of other blocks all the
// time. A discrete block reads them when it is executed, with the measurement noise n of each plant. A sampler is a discrete
// block without state, with d = 1. So is an actuator.
//
// All times are in one unit. A noise's density is its variance per unit of time.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/cost/flow.h"

namespace ttf::experiments::cost {

// One row of c and d; d is empty for a plant.
struct StateSpace {
  Eigen::MatrixXd a, b, c, d;
};
// Without state: y = sum of gain * input.
StateSpace gains(const std::vector<double>& of_inputs);

using Block = std::size_t;

// An execution of blocks: x+ = e x + v, E v v' = noise.
struct Jump {
  Eigen::MatrixXd e, noise;
};

class ControlLoop {
 public:
  // Blocks are numbered from 0 as they are added. An input may be a block that is added later, but before flow().
  Block add_plant(const StateSpace& system, const std::vector<Block>& inputs, double noise_density = 0.0,
                  double measurement_variance = 0.0);
  // Another output of a plant: c x.
  Block add_output(Block plant, const Eigen::MatrixXd& c, double measurement_variance = 0.0);
  Block add_discrete(const StateSpace& system, const std::vector<Block>& inputs);
  // Adds weight * output^2 to the cost rate.
  void add_cost(Block block, double weight);

  Flow flow() const;
  // Executes the blocks one after the other: each sees what those before it have set.
  Jump executes(const std::vector<Block>& blocks) const;
  // Executes one block by other matrices of the same sizes.
  Jump executes_as(Block block, const StateSpace& system) const;

 private:
  struct Entry {
    StateSpace system;
    std::vector<Block> inputs;
    bool continuous = false;
    double noise_density = 0.0, measurement_variance = 0.0;
    Eigen::Index states = 0;
    Eigen::Index first = 0;  // its place in the loop's state. A discrete block's output comes behind its states
    double cost = 0.0;
  };
  Block add(Entry entry);
  // The row that takes a block's output from the loop's state.
  Eigen::RowVectorXd output_of(Block block) const;

  std::vector<Entry> blocks_;
  Eigen::Index size_ = 0;
};

}  // namespace ttf::experiments::cost
