#include "schedules/packing/orders.h"

#include <algorithm>
#include <tuple>

namespace ttf::schedules::packing {
namespace {

bool period_then_length(const Signal& a, const Signal& b) {
  return std::tuple(a.repetition, -a.bits) < std::tuple(b.repetition, -b.bits);
}
bool windows_first(const Signal& a, const Signal& b) {
  return std::tuple(!a.is_windowed(), a.repetition, -a.bits) < std::tuple(!b.is_windowed(), b.repetition, -b.bits);
}
int choices(const Signal& signal) { return signal.window.latest - signal.window.earliest + 1; }
// The share of its cycles that a signal may take, without fractions.
bool narrow_windows_first(const Signal& a, const Signal& b) {
  const int of_a = choices(a) * b.repetition, of_b = choices(b) * a.repetition;
  return std::tuple(of_a, a.repetition, -a.bits) < std::tuple(of_b, b.repetition, -b.bits);
}
bool length_then_period(const Signal& a, const Signal& b) {
  return std::tuple(-a.bits, a.repetition) < std::tuple(-b.bits, b.repetition);
}
bool bandwidth(const Signal& a, const Signal& b) { return a.bits * b.repetition > b.bits * a.repetition; }
bool as_given(const Signal&, const Signal&) { return false; }

}  // namespace

const std::vector<OrderRule>& order_rules() {
  static const std::vector<OrderRule> rules{{"windows, period, length", windows_first},
                                            {"narrowest window, period, length", narrow_windows_first},
                                            {"period, length", period_then_length},
                                            {"length, period", length_then_period},
                                            {"bandwidth", bandwidth},
                                            {"as given", as_given}};
  return rules;
}

Order ordered(const Instance& instance, Order order, const OrderRule& rule, bool by_node) {
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    const Signal &a = instance.signals[i], &b = instance.signals[j];
    return by_node && a.node != b.node ? a.node < b.node : rule.before(a, b);
  });
  return order;
}

}  // namespace ttf::schedules::packing
