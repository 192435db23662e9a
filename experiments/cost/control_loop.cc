#include "experiments/cost/control_loop.h"

#include <utility>

#include "core/check.h"
#include "experiments/cost/dense.h"

namespace ttf::experiments::cost {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;

StateSpace gains(const std::vector<double>& of_inputs) {
  const Index inputs = static_cast<Index>(of_inputs.size());
  StateSpace system{MatrixXd(0, 0), MatrixXd(0, inputs), MatrixXd(1, 0), MatrixXd(1, inputs)};
  for (Index i = 0; i < inputs; ++i) system.d(0, i) = of_inputs[static_cast<std::size_t>(i)];
  return system;
}

Block ControlLoop::add(Entry entry) {
  const StateSpace& system = entry.system;
  entry.states = system.a.rows();
  entry.first = size_;
  TTF_CHECK(system.a.cols() == entry.states && system.b.rows() == entry.states && system.c.cols() == entry.states &&
                system.c.rows() == 1 && system.b.cols() == static_cast<Index>(entry.inputs.size()),
            "block {} has matrices that do not fit", blocks_.size());
  size_ += entry.states + (entry.continuous ? 0 : 1);
  blocks_.push_back(std::move(entry));
  return blocks_.size() - 1;
}

Block ControlLoop::add_plant(const StateSpace& system, const std::vector<Block>& inputs, double noise_density,
                             double measurement_variance) {
  return add({system, inputs, true, noise_density, measurement_variance});
}

Block ControlLoop::add_output(Block plant, const MatrixXd& c, double measurement_variance) {
  Entry entry = blocks_.at(plant);
  TTF_CHECK(entry.continuous && c.rows() == 1 && c.cols() == entry.states, "an output of {} states", c.cols());
  entry.system = {MatrixXd(), MatrixXd(), c, MatrixXd()};
  entry.inputs.clear();
  entry.measurement_variance = measurement_variance;
  entry.cost = 0.0;
  blocks_.push_back(entry);
  return blocks_.size() - 1;
}

Block ControlLoop::add_discrete(const StateSpace& system, const std::vector<Block>& inputs) {
  TTF_CHECK(system.d.rows() == 1 && system.d.cols() == system.b.cols(), "a discrete block without its d");
  return add({system, inputs});
}

void ControlLoop::add_cost(Block block, double weight) { blocks_.at(block).cost += weight; }

RowVectorXd ControlLoop::output_of(Block block) const {
  const Entry& entry = blocks_.at(block);
  RowVectorXd row = RowVectorXd::Zero(size_);
  if (entry.continuous)
    row.segment(entry.first, entry.states) = entry.system.c;
  else
    row[entry.first + entry.states] = 1.0;
  return row;
}

Flow ControlLoop::flow() const {
  Flow flow{MatrixXd::Zero(size_, size_), MatrixXd::Zero(size_, size_), MatrixXd::Zero(size_, size_)};
  for (Block block = 0; block < blocks_.size(); ++block) {
    const Entry& entry = blocks_[block];
    const RowVectorXd output = output_of(block);
    flow.q += outer(entry.cost * output.transpose(), output);
    if (!entry.continuous || entry.system.a.rows() == 0) continue;  // discrete, or an output alone
    const StateSpace& system = entry.system;
    flow.a.block(entry.first, entry.first, entry.states, entry.states) = system.a;
    for (std::size_t input = 0; input < entry.inputs.size(); ++input)
      flow.a.middleRows(entry.first, entry.states) +=
          outer(system.b.col(static_cast<Index>(input)), output_of(entry.inputs[input]));
    flow.noise.block(entry.first, entry.first, entry.states, entry.states) =
        entry.noise_density * product(system.b, system.b.transpose());
  }
  return flow;
}

Jump ControlLoop::executes_as(Block block, const StateSpace& system) const {
  const Entry& entry = blocks_.at(block);
  TTF_CHECK(!entry.continuous && system.a.rows() == entry.states && system.b.cols() == entry.system.b.cols(),
            "block {} is executed as another one", block);
  Jump jump{MatrixXd::Identity(size_, size_), MatrixXd::Zero(size_, size_)};
  const Index rows = entry.states + 1;
  MatrixXd of_state(rows, entry.states), of_input(rows, system.b.cols());
  of_state << system.a, system.c;
  of_input << system.b, system.d;
  jump.e.middleRows(entry.first, rows).setZero();
  jump.e.block(entry.first, entry.first, rows, entry.states) = of_state;
  for (std::size_t input = 0; input < entry.inputs.size(); ++input) {
    const Eigen::VectorXd column = of_input.col(static_cast<Index>(input));
    jump.e.middleRows(entry.first, rows) += outer(column, output_of(entry.inputs[input]));
    jump.noise.block(entry.first, entry.first, rows, rows) +=
        outer(blocks_.at(entry.inputs[input]).measurement_variance * column, column.transpose());
  }
  return jump;
}

Jump ControlLoop::executes(const std::vector<Block>& blocks) const {
  Jump all{MatrixXd::Identity(size_, size_), MatrixXd::Zero(size_, size_)};
  for (const Block block : blocks) {
    const Jump one = executes_as(block, blocks_.at(block).system);
    all.noise = propagated(one.e, all.noise) + one.noise;
    all.e = product(one.e, all.e);
  }
  return all;
}

}  // namespace ttf::experiments::cost
