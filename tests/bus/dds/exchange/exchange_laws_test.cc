// The exchange over DDS keeps the port's laws: between participants in threads of one process.
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "bus/dds/exchange/exchange.h"
#include "bus/dds/exchange/exchange_supervisor.h"
#include "tests/bus/dds/common/sessions.h"
#include "tests/laws/exchange_laws.h"

namespace ttf::laws {
namespace {

using namespace std::chrono_literals;

enum class Ending { kLeaves, kAnnounced };

template <std::size_t kMembers, Ending kEnding> class DdsBench : public ExchangeBench {
 public:
  DdsBench() {
    bus::dds::common::Session session = bus::dds::common::session(kMembers);
    session.supervised = kEnding == Ending::kAnnounced;
    if (session.supervised) supervisor_ = std::make_unique<bus::dds::exchange::ExchangeSupervisor>(session);
    for (const NodeId node : session.members)
      members_.push_back(std::make_unique<bus::dds::exchange::Exchange>(session, node));
    std::vector<std::thread> threads;
    for (auto& member : members_) threads.emplace_back([&member] { member->wait_ready(30s); });
    for (std::thread& thread : threads) thread.join();
    if (supervisor_) supervisor_->wait_ready(30s);
  }
  ~DdsBench() override {
    std::vector<std::thread> threads;  // each waits for the others
    for (auto& member : members_) threads.emplace_back([&member] { member.reset(); });
    for (std::thread& thread : threads) thread.join();
  }
  std::size_t members() const override { return kMembers; }
  bus::ports::Exchange& member(std::size_t index) override { return *members_[index]; }
  void end(std::size_t index) override {
    if (supervisor_)
      supervisor_->announce_gone(NodeId{static_cast<std::uint8_t>(index)});
    else
      members_[index]->leave();
  }

 private:
  std::unique_ptr<bus::dds::exchange::ExchangeSupervisor> supervisor_;
  std::vector<std::unique_ptr<bus::dds::exchange::Exchange>> members_;
};

using DdsBenches = testing::Types<DdsBench<2, Ending::kLeaves>, DdsBench<6, Ending::kLeaves>,
                                  DdsBench<2, Ending::kAnnounced>, DdsBench<6, Ending::kAnnounced>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Dds, ExchangeLaws, DdsBenches);

}  // namespace
}  // namespace ttf::laws
