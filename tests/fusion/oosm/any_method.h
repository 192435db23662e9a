// A method chosen at run time. It satisfies the laws of the method inside; exactness() returns that method's
// exactness. Its size is always that of the largest, the augmented state.
#pragma once

#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "fusion/oosm/adjoint.h"
#include "fusion/oosm/al1.h"
#include "fusion/oosm/algorithm_a.h"
#include "fusion/oosm/algorithm_b.h"
#include "fusion/oosm/algorithm_c.h"
#include "fusion/oosm/augmented.h"
#include "fusion/oosm/bl1.h"
#include "fusion/oosm/clone.h"
#include "fusion/oosm/kind.h"
#include "fusion/oosm/rewind.h"

namespace ttf::fusion::oosm {

template <int N, int M, Motion<N> Model, int Capacity = 16, int Clones = 8> class AnyMethod {
 public:
  static constexpr int kStates = N, kDimension = M;
  static constexpr Exactness kExactness = Exactness::kApproximate;  // the least exactness of all

  AnyMethod(Kind kind, const Model& motion) : method_(make(kind, motion)) {}

  Kind kind() const { return kKinds[method_.index()].kind; }
  // Returns the exactness of the method inside.
  Exactness exactness() const {
    return std::visit([](const auto& method) { return std::decay_t<decltype(method)>::kExactness; }, method_);
  }

  void start(GlobalTime time, const linear::Gaussian<N>& prior) {
    std::visit([&](auto& method) { method.start(time, prior); }, method_);
  }
  bool announce(const Stamp& stamp) {
    return std::visit([&](auto& method) { return method.announce(stamp); }, method_);
  }
  Taken take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement) {
    return std::visit([&](auto& method) { return method.take(stamp, measurement); }, method_);
  }
  std::optional<linear::Gaussian<N>> at(const Stamp& stamp) const {
    return std::visit([&](const auto& method) { return method.at(stamp); }, method_);
  }
  const linear::Gaussian<N>& state() const {
    return std::visit([](const auto& method) -> const linear::Gaussian<N>& { return method.state(); }, method_);
  }
  GlobalTime time() const {
    return std::visit([](const auto& method) { return method.time(); }, method_);
  }

 private:
  // In the order of kKinds.
  using Methods =
      std::variant<Rewind<N, M, Model, Capacity>, Augmented<N, M, Model, Capacity>, Clone<N, M, Model, Clones>,
                   Adjoint<N, M, Model, Capacity>, Al1<N, M, Model, Capacity>, Bl1<N, M, Model, Capacity>,
                   AlgorithmA<N, M, Model>, AlgorithmB<N, M, Model>, AlgorithmC<N, M, Model>>;
  static_assert(std::variant_size_v<Methods> == kKinds.size());

  template <std::size_t I = 0> static Methods make(Kind kind, const Model& motion) {
    if constexpr (I + 1 < kKinds.size())
      if (kind != kKinds[I].kind) return make<I + 1>(kind, motion);
    return Methods(std::in_place_index<I>, motion);
  }

  Methods method_;
};

}  // namespace ttf::fusion::oosm
