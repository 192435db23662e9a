// The memory live medium, used by other tests, keeps the port's laws between threads. Each law notices a
// medium that breaks it.
#include "bus/ports/live_medium.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/laws/live_medium_laws.h"
#include "tests/support/memory_live_medium.h"

namespace ttf::laws {
namespace {

// Two channels, a CAN and a CAN FD; the last member is not on the first CAN.
template <std::size_t kMembers, test::Reported kReported> class MemoryLiveBench : public LiveBench {
 public:
  MemoryLiveBench() {
    for (std::size_t i = 0; i < kMembers; ++i) {
      std::vector<bus::ports::Line> lines;
      for (bus::ports::Line line = 0; line < bus_.lines(); ++line)
        if (on(i, line)) lines.push_back(line);
      members_.push_back(bus_.join(lines));
    }
  }
  std::size_t members() const override { return kMembers; }
  bus::ports::LiveMedium& member(std::size_t index) override { return *members_[index]; }
  std::vector<bool> can_buses() const override { return {false, true}; }
  bool on(std::size_t member, bus::ports::Line line) const override {
    return line != bus::ports::line_of_can(0) || member + 1 < kMembers || kMembers == 2;
  }
  bool intrude(bus::ports::Line line, Intruder what) override {
    bus_.intrude(line,
                 what == Intruder::kForeign ? &bus::ports::LiveCounts::foreign : &bus::ports::LiveCounts::malformed);
    return true;
  }
  std::size_t flood() const override { return 3000; }
  std::chrono::milliseconds quiet() const override { return std::chrono::milliseconds(5); }

 protected:
  test::MemoryLiveBus bus_{{.can_buses = {false, true}, .reported = kReported}};
  std::vector<std::unique_ptr<bus::ports::LiveMedium>> members_;
};

using MemoryLiveBenches =
    testing::Types<MemoryLiveBench<2, test::Reported::kWithTheFrame>, MemoryLiveBench<5, test::Reported::kWithTheFrame>,
                   MemoryLiveBench<2, test::Reported::kInAFollowUp>, MemoryLiveBench<5, test::Reported::kInAFollowUp>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Memory, LiveMediumLaws, MemoryLiveBenches);

enum class Defect {
  kDrops,
  kDoubles,
  kAlters,
  kEchoes,
  kSwaps,
  kStampsEarly,
  kStampsWhenAskedFor,
  kReadsBytesLater,
  kReusesBytes,
  kBlocks,
  kAllocates,
  kHandsStrangersOver,
  kCountsNoStrangers,
  kCountsNoLosses,
  kSilentDescriptor,
  kLoudDescriptor,
  kForgetsWhatCameBefore,
  kStatesNothing,
  kStatesWrong,
  kStatesTwice,
  kMiscounts,
  kOtherLine,
};

// A medium with one defect, otherwise lawful.
class DefectiveMedium final : public bus::ports::LiveMedium {
 public:
  using Bytes = std::array<std::byte, bus::wire::kMaxFrameBytes>;
  // `common`: the single place for arrivals at any member.
  DefectiveMedium(std::unique_ptr<bus::ports::LiveMedium> sound, Defect defect, std::shared_ptr<Bytes> common)
      : sound_(std::move(sound)), defect_(defect), common_(std::move(common)) {}

  bus::ports::LiveStatus send(const bus::ports::LiveSignal& signal, bus::ports::MachineTime due) override {
    if (defect_ == Defect::kEchoes) echo_ = true;
    if (defect_ == Defect::kReusesBytes) std::ranges::copy(signal.bytes, common_->begin());
    bus::ports::LiveSignal sent = signal;
    if (defect_ == Defect::kReadsBytesLater && signal.signal == bus::ports::Signal::kFrame) {  // sends the one before
      const auto before = std::exchange(later_, sent);
      return before ? sound_->send(*before, due) : bus::ports::LiveStatus::kDone;
    }
    if (defect_ == Defect::kBlocks) std::this_thread::sleep_for(std::chrono::milliseconds(++sent_ == 20 ? 1100 : 0));
    if (defect_ == Defect::kOtherLine && signal.slot > 1)
      sent.channel = signal.channel == schedules::model::Channel::kA ? schedules::model::Channel::kB
                                                                     : schedules::model::Channel::kA;
    if (defect_ == Defect::kStatesNothing) sent.states_late = false;
    if (defect_ == Defect::kStatesWrong) due = due - Duration::milliseconds(1);
    return sound_->send(sent, due);
  }
  bus::ports::LiveStatus send_can(std::size_t can_bus, const bus::ports::CanFrame& frame) override {
    return sound_->send_can(can_bus, frame);
  }
  std::optional<bus::ports::LiveArrival> receive() override {
    if (std::exchange(echo_, false)) return invented();
    if (auto again = std::exchange(again_, {})) return again;
    auto received = sound_->receive();
    if (!received) return handed_over(received);
    ++received_;
    if (defect_ == Defect::kDrops && received_ == 5) received = sound_->receive();
    if (defect_ == Defect::kDoubles && received_ == 5) again_ = received;
    if (defect_ == Defect::kStatesTwice && received->late) {
      again_ = received;
      again_->kind = bus::ports::LiveArrival::Kind::kFollowUp;
    }
    if (defect_ == Defect::kAlters && received_ > 5 && !received->signal.bytes.empty()) {
      std::ranges::copy(received->signal.bytes, bytes_.begin());
      bytes_[received->signal.bytes.size() - 1] ^= std::byte{1};
      received->signal.bytes = std::span(bytes_).first(received->signal.bytes.size());
    }
    if (defect_ == Defect::kReusesBytes && received->kind == bus::ports::LiveArrival::Kind::kFlexRay) {
      std::ranges::copy(received->signal.bytes, common_->begin());
      received->signal.bytes = std::span(*common_).first(received->signal.bytes.size());
    }
    if (defect_ == Defect::kSwaps && received_ == 5)
      if (auto next = sound_->receive()) {
        kept_ = *received;  // its bytes are another's by now
        again_ = kept_;
        return next;
      }
    if (defect_ == Defect::kStampsEarly) received->at = received->at - Duration::milliseconds(1);
    if (defect_ == Defect::kStampsWhenAskedFor) received->at = bus::ports::host_now();
    if (defect_ == Defect::kAllocates) allocated_ = std::make_unique<int>(1);
    return received;
  }
  int descriptor(bus::ports::Line line) const override { return sound_->descriptor(line); }
  void watch(bus::ports::Line line, bool on) override {
    if (defect_ == Defect::kSilentDescriptor) return;
    sound_->watch(line, on);
    if (defect_ == Defect::kLoudDescriptor && descriptor(line) >= 0) eventfd_write(descriptor(line), 1);
    eventfd_t ignored = 0;
    if (defect_ == Defect::kForgetsWhatCameBefore) eventfd_read(descriptor(line), &ignored);
  }
  bus::ports::LiveCounts counts() const override {
    bus::ports::LiveCounts counts = sound_->counts();
    if (defect_ == Defect::kCountsNoLosses) counts.lost = 0;
    if (defect_ == Defect::kCountsNoStrangers) counts.foreign = counts.malformed = 0;
    if (defect_ == Defect::kMiscounts && counts.sent > 0) ++counts.sent;
    return counts;
  }
  const std::string& failure() const override { return sound_->failure(); }

 private:
  static bus::ports::LiveArrival invented() {
    bus::ports::LiveArrival arrival;
    arrival.signal.slot = 1;
    return arrival;
  }
  std::optional<bus::ports::LiveArrival> handed_over(std::optional<bus::ports::LiveArrival> nothing) {
    const bus::ports::LiveCounts counts = sound_->counts();
    if (defect_ == Defect::kHandsStrangersOver && std::exchange(strangers_, counts.foreign) != counts.foreign)
      return invented();
    return nothing;
  }

  std::unique_ptr<bus::ports::LiveMedium> sound_;
  Defect defect_;
  std::shared_ptr<Bytes> common_;
  std::uint64_t sent_ = 0, received_ = 0, strangers_ = 0;
  bool echo_ = false;
  std::optional<bus::ports::LiveSignal> later_;
  std::optional<bus::ports::LiveArrival> again_;
  bus::ports::LiveArrival kept_;
  Bytes bytes_{};
  std::unique_ptr<int> allocated_;
};

class DefectiveBench : public MemoryLiveBench<3, test::Reported::kWithTheFrame> {
 public:
  explicit DefectiveBench(Defect defect) {
    const auto bytes = std::make_shared<DefectiveMedium::Bytes>();
    for (auto& member : members_) member = std::make_unique<DefectiveMedium>(std::move(member), defect, bytes);
  }
  std::chrono::milliseconds patience() const override { return std::chrono::milliseconds(500); }
};

using Law = std::string (*)(ttf::laws::LiveBench&);
struct Noticed {
  const char* name;
  Defect defect;
  Law law;
};
class LiveLawsNotice : public testing::TestWithParam<Noticed> {};

std::string in_turn(LiveBench& bench) { return once_and_unchanged(bench, false); }
std::string in_threads(LiveBench& bench) { return once_and_unchanged(bench, true); }
std::string foreign(LiveBench& bench) { return strangers_are_counted(bench, LiveBench::Intruder::kForeign); }
std::string malformed(LiveBench& bench) { return strangers_are_counted(bench, LiveBench::Intruder::kMalformed); }

INSTANTIATE_TEST_SUITE_P(
    AMediumThat, LiveLawsNotice,
    testing::Values(Noticed{"L1_Drops", Defect::kDrops, in_turn},
                    Noticed{"L1_DropsInThreads", Defect::kDrops, in_threads},
                    Noticed{"L1_Doubles", Defect::kDoubles, in_turn}, Noticed{"L1_Alters", Defect::kAlters, in_turn},
                    Noticed{"L1_SendsOnTheOtherLine", Defect::kOtherLine, in_turn},
                    Noticed{"L1_Miscounts", Defect::kMiscounts, in_turn},
                    Noticed{"L1_CountsNoLosses", Defect::kCountsNoLosses, missing_is_counted},
                    Noticed{"L2_Echoes", Defect::kEchoes, does_not_receive_itself},
                    Noticed{"L3_Swaps", Defect::kSwaps, keeps_the_order},
                    Noticed{"L4_StampsBeforeItWasSent", Defect::kStampsEarly, arrives_when_it_says},
                    Noticed{"L4_StampsWhenAskedFor", Defect::kStampsWhenAskedFor, arrives_when_it_says},
                    Noticed{"L5_ReadsBytesLater", Defect::kReadsBytesLater, keeps_what_is_its_own},
                    Noticed{"L5_ReusesBytes", Defect::kReusesBytes, keeps_what_is_its_own},
                    Noticed{"L6_Blocks", Defect::kBlocks, never_blocks_nor_allocates},
                    Noticed{"L6_Allocates", Defect::kAllocates, never_blocks_nor_allocates},
                    Noticed{"L7_HandsStrangersOver", Defect::kHandsStrangersOver, foreign},
                    Noticed{"L7_CountsNoForeign", Defect::kCountsNoStrangers, foreign},
                    Noticed{"L7_CountsNoMalformed", Defect::kCountsNoStrangers, malformed},
                    Noticed{"L8_HasASilentDescriptor", Defect::kSilentDescriptor, what_is_watched_is_readable},
                    Noticed{"L8_HasALoudDescriptor", Defect::kLoudDescriptor, what_is_watched_is_readable},
                    Noticed{"L8_ForgetsWhatCameBefore", Defect::kForgetsWhatCameBefore, what_is_watched_is_readable},
                    Noticed{"Departure_StatesNothing", Defect::kStatesNothing, says_how_late_it_left},
                    Noticed{"Departure_StatesWrong", Defect::kStatesWrong, says_how_late_it_left},
                    Noticed{"Departure_StatesTwice", Defect::kStatesTwice, in_turn}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(LiveLawsNotice, IsNotTakenToKeepTheLaw) {
  DefectiveBench bench(GetParam().defect);
  const std::string wrong = GetParam().law(bench);
  EXPECT_NE(wrong, "");
  RecordProperty("wrong", wrong);
}

}  // namespace
}  // namespace ttf::laws
