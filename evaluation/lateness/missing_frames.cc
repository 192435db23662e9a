#include "evaluation/lateness/missing_frames.h"

#include <algorithm>
#include <limits>

#include "core/int128.h"

namespace ttf::evaluation::lateness {
namespace {

using schedules::model::FrameSlot;

std::int64_t within_type_ns(Int128 ns) {
  using Limits = std::numeric_limits<std::int64_t>;
  return static_cast<std::int64_t>(std::clamp<Int128>(ns, Limits::min(), Limits::max()));
}

// Returns 0..cycles - 1 for any number.
std::size_t cycle_counter(Int128 cycle, std::int64_t cycles) {
  return static_cast<std::size_t>((cycle % cycles + cycles) % cycles);
}

bool is_on(const FrameSlot& frame, int slot, std::uint8_t channel) {
  return frame.slot == slot &&
         schedules::model::share_a_channel(
             frame.channels, channel == 0 ? schedules::model::Channels::kA : schedules::model::Channels::kB);
}

}  // namespace

// Counts the turns from `first_back` to `last_back` cycles before `cycle`; both are 1 or more.
std::int64_t MissingFrames::turns_before(const Sender& sender, std::int64_t cycle, std::int64_t first_back,
                                         std::int64_t last_back) const {
  const auto up_to = [&](std::int64_t back) {
    std::int64_t sum = back / cycles_ * static_cast<std::int64_t>(sender.turns.count());
    for (std::int64_t rest = 1; rest <= back % cycles_; ++rest)
      if (sender.turns[cycle_counter(Int128{cycle} - rest, cycles_)]) ++sum;
    return sum;
  };
  return first_back > last_back ? 0 : up_to(last_back) - up_to(first_back - 1);
}

std::int64_t MissingFrames::due_ns(const recording::records::TimingProblem& problem) const {
  const std::int64_t scale = time_scale_ppm_ > 0 ? time_scale_ppm_ : 1'000'000;
  return within_type_ns(Int128{problem.stamp.true_time.ns} - Int128{problem.late.ns} * 1'000'000 / scale);
}

MissingFrames::Sender& MissingFrames::sender_at(const Place& place) {
  const auto [found, is_new] = senders_.try_emplace(place);
  Sender& sender = found->second;
  if (!is_new) return sender;
  const auto [slot, channel, node] = place;
  for (const FrameSlot& frame : cluster_.frames)
    for (std::int64_t counter = 0; counter < cycles_ && frame.sender == node && is_on(frame, slot, channel); ++counter)
      if (schedules::model::in_cycle(frame, counter)) sender.turns.set(static_cast<std::size_t>(counter));
  return sender;
}

// Returns the cycles between two turns: by the counters, with whole rounds by the instants. Absent if the
// length of a cycle is unknown.
std::optional<std::int64_t> MissingFrames::cycles_from(const Turn& earlier, const Turn& later) const {
  const Int128 cycle_ns = cluster_.cycle().ns;
  if (cycle_ns <= 0) return std::nullopt;
  const Int128 apart = Int128{later.due_ns} - earlier.due_ns;
  const Int128 about = (2 * apart + (apart < 0 ? -cycle_ns : cycle_ns)) / (2 * cycle_ns);
  const auto off = static_cast<std::int64_t>(cycle_counter(Int128{later.cycle} - earlier.cycle - about, cycles_));
  return within_type_ns(about + (off < cycles_ / 2 ? off : off - cycles_));
}

void MissingFrames::add(const recording::records::TimingProblem& problem) {
  const Turn turn{due_ns(problem), problem.cycle};
  if (problem.what == recording::records::TimingFault::kSlotMissed)
    sender_at({problem.slot, problem.channel, problem.stamp.node}).missed.push_back(turn);
  if (problem.what == recording::records::TimingFault::kFramesLost)
    lost_.push_back({turn, problem.stamp.node, problem.slot, problem.channel, problem.count});
}

void MissingFrames::add(const recording::records::SlotFrameSent& frame) {
  Sender& sender = sender_at({frame.slot, frame.channel, frame.stamp.node});
  const Turn turn{frame.stamp.true_time.ns, frame.cycle};
  if (sender.last)
    if (const auto cycles = cycles_from(*sender.last, turn);
        cycles && *cycles > 1 && turns_before(sender, turn.cycle, 1, *cycles - 1) > 0)
      sender.silences.push_back({*sender.last, turn});
  sender.last = turn;
}

// Returns how many cycles the first missing frame was before the one that came.
std::int64_t MissingFrames::reach_of(const Lost& lost) const {
  std::vector<std::int64_t> turns;  // one round's, backwards
  for (std::int64_t back = 1; back <= cycles_; ++back) {
    const auto counter = static_cast<std::int64_t>(cycle_counter(Int128{lost.came.cycle} - back, cycles_));
    if (std::any_of(cluster_.frames.begin(), cluster_.frames.end(), [&](const FrameSlot& frame) {
          return frame.sender != lost.receiver && is_on(frame, lost.slot, lost.channel) &&
                 schedules::model::in_cycle(frame, counter);
        }))
      turns.push_back(back);
  }
  if (turns.empty() || lost.count == 0) return 0;
  const std::uint64_t last = lost.count - 1;
  return static_cast<std::int64_t>(last / turns.size()) * cycles_ + turns[last % turns.size()];
}

MissingFramesCount MissingFrames::count(const Lost& lost, std::int64_t reach, const Sender& sender) const {
  // Turns outside this range are too far away.
  const Int128 cycle_ns = cluster_.cycle().ns;
  const std::int64_t from_ns = within_type_ns(lost.came.due_ns - (reach + cycles_) * cycle_ns);
  const std::int64_t to_ns = within_type_ns(lost.came.due_ns + cycles_ * cycle_ns);
  const auto is_before = [](const Turn& turn, std::int64_t ns) { return turn.due_ns < ns; };
  const auto ends_before = [](const Silence& silence, std::int64_t ns) { return silence.behind.due_ns < ns; };

  std::vector<std::int64_t> missed;  // in cycles before the frame that came
  for (auto turn = std::lower_bound(sender.missed.begin(), sender.missed.end(), from_ns, is_before);
       turn != sender.missed.end() && turn->due_ns <= to_ns; ++turn)
    if (const auto back = cycles_from(*turn, lost.came); back && *back >= 1 && *back <= reach) missed.push_back(*back);
  std::sort(missed.begin(), missed.end());
  missed.erase(std::unique(missed.begin(), missed.end()), missed.end());
  MissingFramesCount found{missed.size(), 0};
  for (auto silence = std::lower_bound(sender.silences.begin(), sender.silences.end(), from_ns, ends_before);
       silence != sender.silences.end() && silence->before.due_ns <= to_ns; ++silence) {
    const auto before = cycles_from(silence->before, lost.came), behind = cycles_from(silence->behind, lost.came);
    if (!before || !behind || *before <= 1 || *behind >= reach) continue;
    const std::int64_t first = std::max<std::int64_t>(1, *behind + 1), last = std::min(reach, *before - 1);
    if (first > last) continue;
    const auto withheld =
        std::upper_bound(missed.begin(), missed.end(), last) - std::lower_bound(missed.begin(), missed.end(), first);
    const std::int64_t silent = turns_before(sender, lost.came.cycle, first, last);
    found.away += static_cast<std::uint64_t>(std::max<std::int64_t>(0, silent - withheld));
  }
  return found;
}

std::map<NodeId, MissingFramesCount> MissingFrames::by_receiver() const {
  std::map<Place, Sender> senders = senders_;
  for (auto& [place, sender] : senders)  // late reports are of earlier turns
    std::sort(sender.missed.begin(), sender.missed.end(),
              [](const Turn& a, const Turn& b) { return a.due_ns < b.due_ns; });
  std::map<NodeId, MissingFramesCount> all;
  for (const Lost& lost : lost_) {
    const std::int64_t reach = reach_of(lost);
    std::uint64_t left = lost.count;  // records of a damaged log may claim more
    MissingFramesCount& of_node = all[lost.receiver];
    for (auto at = senders.lower_bound({lost.slot, lost.channel, NodeId{0}});
         at != senders.end() && std::get<0>(at->first) == lost.slot && std::get<1>(at->first) == lost.channel; ++at) {
      if (std::get<2>(at->first) == lost.receiver) continue;
      const MissingFramesCount found = count(lost, reach, at->second);
      const std::uint64_t withheld = std::min(left, found.withheld);
      const std::uint64_t away = std::min(left - withheld, found.away);
      left -= withheld + away;
      of_node.withheld += withheld;
      of_node.away += away;
    }
  }
  return all;
}

}  // namespace ttf::evaluation::lateness
