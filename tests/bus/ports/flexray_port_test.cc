// The test medium obeys the laws of the port, too: its results hold for any medium.
#include "tests/laws/flexray_port_laws.h"

#include "tests/bus/bus_rig.h"

namespace ttf::laws {
namespace {

class TestMediumBench final : public FlexRayBench {
 public:
  const schedules::model::GlobalParameters& parameters() const override { return flexray_; }
  std::int64_t microtick_ps() const override { return 25'000; }
  std::size_t controllers() const override { return 4; }
  bus::ports::FlexRayPort& port(std::size_t controller) override { return medium_.port(controller); }
  void run_until(Microticks now) override {
    while (medium_.next() && medium_.oscillator(0).ticks_at(*medium_.next()) <= now) {
      const auto arrival = medium_.pop();
      const bus::ports::Reception reception = medium_.reception(arrival);
      reached_.push_back(
          {arrival.receiver, reception.channel, reception.signal, reception.start, reception.end, arrival.bytes});
    }
    medium_.set_now(medium_.oscillator(0).time_of(now));
  }
  const std::vector<Reached>& reached() const override { return reached_; }

 private:
  schedules::model::GlobalParameters flexray_;
  bus::TestMedium medium_{std::vector<timebase::Oscillator>(4, {25'000, 0, 0}), Duration{700}};
  std::vector<Reached> reached_;
};

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(TestMedium, FlexRayPortLaws, TestMediumBench);

}  // namespace ttf::laws
