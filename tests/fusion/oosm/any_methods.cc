#include "tests/fusion/oosm/any_methods.h"

namespace ttf::fusion::oosm {

template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
Compiled<N, M, Model, Capacity>::Compiled(Kind kind, const Model& motion) : method_(kind, motion) {}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
void Compiled<N, M, Model, Capacity>::start(GlobalTime time, const linear::Gaussian<N>& prior) {
  method_.start(time, prior);
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
bool Compiled<N, M, Model, Capacity>::announce(const Stamp& stamp) {
  return method_.announce(stamp);
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
Taken Compiled<N, M, Model, Capacity>::take(const Stamp& stamp, const linear::LinearMeasurement<N, M>& measurement) {
  return method_.take(stamp, measurement);
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
std::optional<linear::Gaussian<N>> Compiled<N, M, Model, Capacity>::at(const Stamp& stamp) const {
  return method_.at(stamp);
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
const linear::Gaussian<N>& Compiled<N, M, Model, Capacity>::state() const {
  return method_.state();
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
GlobalTime Compiled<N, M, Model, Capacity>::time() const {
  return method_.time();
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
Exactness Compiled<N, M, Model, Capacity>::exactness() const {
  return method_.exactness();
}
template <int N, int M, ttf::fusion::oosm::Motion<N> Model, int Capacity>
Kind Compiled<N, M, Model, Capacity>::kind() const {
  return method_.kind();
}

template class Compiled<2, 1, Line, 24>;
template class Compiled<4, 2, Plane, 24>;

}  // namespace ttf::fusion::oosm
