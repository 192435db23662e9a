// The exchange between threads, which other tests rely on, keeps the port's laws.
#include "bus/ports/exchange.h"

#include "tests/laws/exchange_laws.h"
#include "tests/support/memory_exchange.h"

namespace ttf::laws {
namespace {

template <std::size_t kMembers> class MemoryExchangeBench : public ExchangeBench {
 public:
  MemoryExchangeBench() {
    for (std::size_t i = 0; i < kMembers; ++i) members_.push_back(hub_.join(NodeId{static_cast<std::uint8_t>(i)}));
  }
  std::size_t members() const override { return kMembers; }
  bus::ports::Exchange& member(std::size_t index) override { return *members_[index]; }
  void end(std::size_t index) override { hub_.leave(NodeId{static_cast<std::uint8_t>(index)}); }

 private:
  test::MemoryExchange hub_;
  std::vector<std::unique_ptr<bus::ports::Exchange>> members_;
};

using MemoryExchangeBenches = testing::Types<MemoryExchangeBench<2>, MemoryExchangeBench<6>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Memory, ExchangeLaws, MemoryExchangeBenches);

}  // namespace
}  // namespace ttf::laws
