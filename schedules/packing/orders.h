// The orders in which first fit tries the signals. No order is best for all instances, so all are tried.
#pragma once

#include <string_view>
#include <vector>

#include "schedules/packing/instance.h"

namespace ttf::schedules::packing {

struct OrderRule {
  std::string_view name;
  // Returns whether a goes before b. Signals without a difference keep their order.
  bool (*before)(const Signal& a, const Signal& b);
};

// In the order in which they are tried.
const std::vector<OrderRule>& order_rules();

// With `by_node`, all signals of a node go before those of the next one.
Order ordered(const Instance& instance, Order order, const OrderRule& rule, bool by_node = false);

}  // namespace ttf::schedules::packing
