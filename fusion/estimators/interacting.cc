#include <optional>
#include <tuple>

#include "fusion/estimators/make.h"
#include "fusion/estimators/single.h"
#include "fusion/filters/imm.h"

namespace ttf::fusion::estimators {

// The kernel of two motion models (fusion/filters/imm.h) for ModelEstimator: an object drives straight on and
// turns now and then.
template <class F> class StraightAndTurning {
 public:
  using Own = StraightOrTurning;
  static constexpr bool kNeedsCourse = true;

  StraightAndTurning(const filters::ModeChain<2>& chain, const Single<F, motion::ConstantVelocity>& straight,
                     const Single<F, motion::Ctrv>& turning)
      : imm_(chain, straight.model, turning.model), share_(chain.share), turning_(turning) {}

  Own from(const linear::Gaussian<4>& known) const {
    return {.estimates = {known, turning_.from(known)}, .probability = share_};
  }
  std::optional<linear::Gaussian<4>> without_course(const Own& own) const {
    if (!turning_.without_course(std::get<1>(own.estimates))) return std::nullopt;
    return std::get<0>(own.estimates);
  }
  void predict(Own& own, double dt) const {
    imm_.predict(own, dt);
    bound_heading<motion::Ctrv>(std::get<1>(own.estimates));
  }
  template <sensors::Model S>
  filters::Innovation<S::kDimension> innovate(const S& sensor, const sensors::Measurement<S::kDimension>& z,
                                              const Own& own) const {
    return imm_.innovate(sensor, z, own);
  }
  template <sensors::Model S>
  void update(const S& sensor, const sensors::Measurement<S::kDimension>& z, Own& own) const {
    imm_.update(sensor, z, own);
  }
  void merge(Own& first, double a, const Own& second, double b) const { imm_.merge(first, a, second, b); }
  linear::Gaussian<2> position(const Own& own) const {
    const Cartesian all = cartesian(own);
    return {all.x.head<2>(), all.p.topLeftCorner<2, 2>()};
  }
  Cartesian cartesian(const Own& own) const { return imm_.whole(own); }
  linear::Vector<2> velocity(const Own& own) const { return imm_.velocity(own); }

 private:
  filters::Imm<F, motion::ConstantVelocity, motion::Ctrv> imm_;
  linear::Vector<2> share_;
  Single<F, motion::Ctrv> turning_;
};

std::shared_ptr<const Estimator> make_interacting(const config::TrackerConfig& config) {
  return under_the_filter(config, [&]<class F>() {
    return StraightAndTurning<F>({.seconds = config.mode_seconds},
                                 single<F>(config, motion::ConstantVelocity(config.process_noise)),
                                 single<F>(config, motion::Ctrv(config.turn_noise, config.process_noise)));
  });
}

}  // namespace ttf::fusion::estimators
