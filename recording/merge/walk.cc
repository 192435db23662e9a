#include "recording/merge/walk.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace ttf::recording::merge {
namespace {

// Sorts the records of one instant.
void put_in_order(std::vector<MergeWalk::Message>& instant) {
  if (instant.size() < 2) return;
  using Message = MergeWalk::Message;
  const auto group = [](const Message& m) { return std::tuple(m.place.rank, m.place.about, m.log); };
  std::sort(instant.begin(), instant.end(), [&](const Message& a, const Message& b) {
    return std::tuple_cat(group(a), std::tuple(a.in_log)) < std::tuple_cat(group(b), std::tuple(b.in_log));
  });
  for (std::size_t i = 1; i < instant.size(); ++i)
    if (instant[i].place.of_node && group(instant[i]) == group(instant[i - 1]))
      instant[i].repetition = instant[i - 1].repetition + 1;
  std::stable_sort(instant.begin(), instant.end(), [](const Message& a, const Message& b) {
    return std::tie(a.place.rank, a.place.about, a.repetition, a.payload) <
           std::tie(b.place.rank, b.place.about, b.repetition, b.payload);
  });
}

}  // namespace

MergeWalk::MergeWalk(const std::vector<StoredLog>& logs, const std::vector<CommonTime>& times)
    : logs_(logs), times_(times) {
  for (std::size_t log = 0; log < logs.size(); ++log)
    for (std::size_t chunk = 0; chunk < logs[log].chunks().size(); ++chunk)
      upcoming_.push_back({times[log](logs[log].chunks()[chunk].first), static_cast<std::uint32_t>(log),
                           static_cast<std::uint32_t>(chunk)});
  std::sort(upcoming_.begin(), upcoming_.end(), [](const Upcoming& a, const Upcoming& b) {
    return std::tie(a.first, a.log, a.chunk) > std::tie(b.first, b.log, b.chunk);
  });
}

std::unique_ptr<MergeWalk::Open> MergeWalk::closed_chunk() {
  if (free_.empty()) return std::make_unique<Open>();
  std::unique_ptr<Open> chunk = std::move(free_.back());
  free_.pop_back();
  chunk->messages.clear();
  chunk->at = 0;
  return chunk;
}

void MergeWalk::open(const Upcoming& upcoming) {
  std::unique_ptr<Open> chunk = closed_chunk();
  const StoredLog& log = logs_[upcoming.log];
  const auto records = opener_.open(log.content(log.chunks()[upcoming.chunk]), chunk->buffer);
  if (!records) return;  // it was sound when the log was read through
  RecordPlace place;     // the decoder passes one for a readable payload, and none for any other
  const std::unique_ptr<records::Sink> sink = placing([&place](const RecordPlace& found) { place = found; });
  std::uint64_t in_log = std::uint64_t{upcoming.chunk} << 32;
  mcap::for_each_message(*records, [&](std::uint16_t channel, std::uint64_t, std::string_view payload) {
    if (!records::is_kind(channel)) return false;
    const auto kind = static_cast<records::RecordKind>(channel);
    if (!decoder_.decode(kind, payload, *sink)) return false;
    place.at = times_[upcoming.log](place.at);
    chunk->messages.push_back({place, kind, upcoming.log, 0, in_log++, payload});
    return true;
  });
  std::sort(chunk->messages.begin(), chunk->messages.end(), [](const Message& a, const Message& b) {
    return std::tie(a.place.at, a.in_log) < std::tie(b.place.at, b.in_log);
  });
  open_.push_back(std::move(chunk));
  std::push_heap(open_.begin(), open_.end(), later);
}

bool MergeWalk::later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b) { return a->time() > b->time(); }

const std::vector<MergeWalk::Message>& MergeWalk::next() {
  std::move(used_.begin(), used_.end(), std::back_inserter(free_));
  used_.clear();
  instant_.clear();
  while (!upcoming_.empty() && (open_.empty() || upcoming_.back().first <= open_.front()->time())) {
    open(upcoming_.back());
    upcoming_.pop_back();
  }
  if (open_.empty()) return instant_;
  const TrueTime now = open_.front()->time();
  while (!open_.empty() && open_.front()->time() == now) {
    std::pop_heap(open_.begin(), open_.end(), later);
    Open& chunk = *open_.back();
    while (chunk.at < chunk.messages.size() && chunk.time() == now) instant_.push_back(chunk.messages[chunk.at++]);
    if (chunk.at < chunk.messages.size()) {
      std::push_heap(open_.begin(), open_.end(), later);
    } else {
      used_.push_back(std::move(open_.back()));
      open_.pop_back();
    }
  }
  put_in_order(instant_);
  return instant_;
}

}  // namespace ttf::recording::merge
