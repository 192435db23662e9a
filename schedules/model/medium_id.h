// The medium of a list: FlexRay or one of the cluster's CANs.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

#include "core/check.h"
#include "schedules/model/limits.h"

namespace ttf::schedules::model {

class MediumId {
 public:
  constexpr MediumId() = default;  // FlexRay

  // Returns the CAN with this index in Cluster::can_buses.
  static constexpr MediumId can(std::size_t index) {
    TTF_CHECK(index < kMostCans, "CAN {}", index);
    MediumId medium;
    medium.number_ = static_cast<std::int8_t>(index);
    return medium;
  }

  constexpr bool is_flexray() const { return number_ < 0; }
  constexpr bool is_can() const { return number_ >= 0; }

  // Index in Cluster::can_buses; only a CAN has one.
  constexpr std::size_t can_index() const {
    TTF_CHECK(is_can(), "FlexRay is no CAN");
    return static_cast<std::size_t>(number_);
  }

  // The number in records (recording::records::ListHop::can_bus): a CAN's index, -1 for FlexRay.
  constexpr std::int8_t number() const { return number_; }

  // FlexRay precedes the CANs, which follow the cluster's order.
  constexpr auto operator<=>(const MediumId&) const = default;

 private:
  std::int8_t number_ = -1;
};

inline constexpr MediumId kFlexRay{};

}  // namespace ttf::schedules::model
