#include "recording/merge/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/errors.h"
#include "recording/log/codec.h"
#include "recording/log/manifest_codec.h"
#include "recording/log/writer.h"
#include "recording/mcap/chunk.h"
#include "recording/merge/record_place.h"

namespace ttf::recording::merge {
namespace {

// Walks through the records of several logs in their canonical order.
class MergeWalk {
 public:
  // A record in an open chunk.
  struct Message {
    RecordPlace place;
    records::RecordKind kind{};
    std::uint32_t log = 0;
    std::uint32_t repetition = 0;  // how many records of its node, kind and instant precede it in its log
    std::uint64_t in_log = 0;      // place in its log
    std::string_view payload;
  };

  // `times`: by log, its common scale. Both arguments must outlive the walk.
  MergeWalk(const std::vector<StoredLog>& logs, const std::vector<CommonTime>& times) : logs_(logs), times_(times) {
    for (std::size_t log = 0; log < logs.size(); ++log)
      for (std::size_t chunk = 0; chunk < logs[log].chunks().size(); ++chunk)
        upcoming_.push_back({times[log](logs[log].chunks()[chunk].first), static_cast<std::uint32_t>(log),
                             static_cast<std::uint32_t>(chunk)});
    std::sort(upcoming_.begin(), upcoming_.end(), [](const Upcoming& a, const Upcoming& b) {
      return std::tie(a.first, a.log, a.chunk) > std::tie(b.first, b.log, b.chunk);
    });
  }

  // Returns all records of the next instant, in their order; empty at the end. Valid until the next call.
  const std::vector<Message>& next() {
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

 private:
  struct Upcoming {
    TrueTime first;
    std::uint32_t log;
    std::uint32_t chunk;
  };
  struct Open {
    std::string buffer;
    std::vector<Message> messages;  // by time
    std::size_t at = 0;
    TrueTime time() const { return messages[at].place.at; }
  };
  // Sorts the records of one instant.
  static void put_in_order(std::vector<Message>& instant) {
    if (instant.size() < 2) return;
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
  static bool later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b) { return a->time() > b->time(); }
  void open(const Upcoming& upcoming) {
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
  std::unique_ptr<Open> closed_chunk() {
    if (free_.empty()) return std::make_unique<Open>();
    std::unique_ptr<Open> chunk = std::move(free_.back());
    free_.pop_back();
    chunk->messages.clear();
    chunk->at = 0;
    return chunk;
  }

  const std::vector<StoredLog>& logs_;
  const std::vector<CommonTime>& times_;
  std::vector<Upcoming> upcoming_;           // the next one last
  std::vector<std::unique_ptr<Open>> open_;  // a heap, the earliest first
  std::vector<std::unique_ptr<Open>> used_;  // read to the end; valid until the next call, then free
  std::vector<std::unique_ptr<Open>> free_;
  std::vector<Message> instant_;
  mcap::ChunkOpener opener_;
  log::Decoder decoder_;
};

std::map<std::string, std::string> keys_of(const StoredLog& log) {
  std::map<std::string, std::string> keys;
  for (const auto& [key, value] : manifest_entries(log.info().manifest))
    if (key != "crc32" && key != "host") keys[key] = value;
  return keys;
}

// Returns the first key of the manifest by which `log` is of another drive than `first`; absent if they agree.
std::optional<Finding> misfit(const StoredLog& log, const StoredLog& first) {
  const auto mine = keys_of(log), others = keys_of(first);
  if (mine == others) return std::nullopt;
  for (const auto& [key, unused] : manifest_entries(first.info().manifest)) {  // in the order of writing
    const auto value = mine.find(key), expected = others.find(key);
    if (expected == others.end() || (value != mine.end() && value->second == expected->second)) continue;
    return Finding{
        log.name(), 0, key, value == mine.end() ? "" : value->second,
        fmt::format("must be {} as in {}: only logs of one drive are merged", expected->second, first.name())};
  }
  for (const auto& [key, value] : mine)
    if (!others.contains(key))
      return Finding{log.name(), 0, key, value,
                     fmt::format("is not in {}: only logs of one drive are merged", first.name())};
  return std::nullopt;
}

Finding given_twice(const StoredLog& log, const StoredLog& other) {
  return {log.name(), 0, "", "",
          fmt::format("holds the same records as {}: give each log once, and a merged log without its parts",
                      other.name())};
}

bool is_copy(const StoredLog& log, const StoredLog& other) {
  return log.name() == other.name() ||
         (log.info().records.records() > 0 && log.info().content_hash == other.info().content_hash);
}

// Returns the log that holds the records of the others, two or more, together; end() if there is none.
std::vector<StoredLog>::iterator whole_among(std::vector<StoredLog>& logs) {
  log::ContentHash all;
  std::size_t with_records = 0;
  for (const StoredLog& log : logs) {
    all.add(log.info().records);
    with_records += log.info().records.records() > 0;
  }
  if (with_records < 3) return logs.end();
  return std::find_if(logs.begin(), logs.end(), [&](const StoredLog& log) {
    log::ContentHash twice = log.info().records;
    twice.add(log.info().records);
    return twice.value() == all.value();
  });
}

std::vector<StoredLog> stored(const std::vector<std::string>& paths) {
  std::vector<StoredLog> logs;
  for (const std::string& path : paths) logs.emplace_back(path);
  return logs;
}

}  // namespace

MergedLogs::MergedLogs(const std::vector<std::string>& paths) : MergedLogs(stored(paths)) {}

MergedLogs::MergedLogs(std::vector<StoredLog> logs) : logs_(std::move(logs)) {
  if (const auto whole = whole_among(logs_); whole != logs_.end()) {
    warnings_.push_back(
        fmt::format("{}: is ignored: it holds the records of the other {} logs", whole->name(), logs_.size() - 1));
    logs_.erase(whole);
  }
  Findings findings;
  const StoredLog* first = nullptr;
  for (auto log = logs_.begin(); log != logs_.end(); ++log) {
    const auto copied = std::find_if(logs_.begin(), log, [&](const StoredLog& other) { return is_copy(*log, other); });
    if (copied != log) {
      findings.add(given_twice(*log, *copied));
      continue;
    }
    if (!log->info().manifest_sound) continue;
    if (first == nullptr)
      first = &*log;
    else if (auto finding = misfit(*log, *first))
      findings.add(std::move(*finding));
  }
  findings.throw_if_any();
  if (first != nullptr)
    manifest_ = first->info().manifest;
  else if (!logs_.empty())
    manifest_ = logs_.front().info().manifest;
  times_ = common_times(logs_, warnings_);
  const auto elsewhere = [&](const StoredLog& log) {
    return log.info().manifest_sound && log.info().manifest.host != manifest_.host;
  };
  if (std::any_of(logs_.begin(), logs_.end(), elsewhere)) manifest_.host.clear();
  const auto put_on_scale = [](const CommonTime& time) { return !time.changes_nothing(); };
  if (std::any_of(times_.begin(), times_.end(), put_on_scale)) manifest_.clock = log::kCommonClock;
}

std::vector<log::Attachment> MergedLogs::attachments() const {
  // By content, the first place in any log.
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> places;
  for (const StoredLog& log : logs_) {
    const std::vector<log::Attachment>& own = log.info().attachments;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const auto [known, added] = places.try_emplace({own[i].name, own[i].bytes, own[i].media_type}, i);
      if (!added) known->second = std::min(known->second, i);
    }
  }
  std::vector<std::pair<std::size_t, log::Attachment>> all;
  for (const auto& [what, place] : places)
    all.push_back({place, {std::get<0>(what), std::get<2>(what), std::get<1>(what)}});
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<log::Attachment> attachments;
  for (auto& [place, attachment] : all) attachments.push_back(std::move(attachment));
  return attachments;
}

log::ContentHash MergedLogs::content_hash() const {
  log::ContentHash hash;
  for (const StoredLog& log : logs_) hash.add(log.info().records);
  return hash;
}

std::vector<std::string> MergedLogs::warnings() const {
  std::vector<std::string> warnings;
  for (const StoredLog& log : logs_)
    if (!log.info().warning.empty()) warnings.push_back(log.info().warning);
  warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
  return warnings;
}

void MergedLogs::read(records::Sink& sink) const {
  MergeWalk walk(logs_, times_);
  log::Decoder decoder;
  std::vector<std::unique_ptr<records::Sink>> sinks;
  for (const CommonTime& time : times_) sinks.push_back(on_common_time(time, sink));
  while (true) {
    const std::vector<MergeWalk::Message>& instant = walk.next();
    if (instant.empty()) return;
    for (std::size_t i = 0; i < instant.size(); ++i) {
      const MergeWalk::Message& message = instant[i];
      if (i > 0 && message.place.of_node && message.log != instant[i - 1].log && message.kind == instant[i - 1].kind &&
          message.payload == instant[i - 1].payload) {
        const auto [a, b] = std::minmax(message.log, instant[i - 1].log);
        throw InputError(given_twice(logs_[b], logs_[a]));
      }
      records::Sink& out = times_[message.log].changes_nothing() ? sink : *sinks[message.log];
      decoder.decode(message.kind, message.payload, out);
    }
  }
}

std::vector<MergedLogs> merge_by_drive(std::vector<StoredLog> logs) {
  std::vector<std::vector<StoredLog>> drives;
  std::vector<StoredLog> unknown;
  for (StoredLog& log : logs) {
    if (!log.info().manifest_sound) {
      unknown.push_back(std::move(log));
      continue;
    }
    const auto drive = std::find_if(drives.begin(), drives.end(),
                                    [&](const std::vector<StoredLog>& other) { return !misfit(log, other.front()); });
    if (drive == drives.end())
      drives.emplace_back().push_back(std::move(log));
    else
      drive->push_back(std::move(log));
  }
  const bool apart = drives.size() > 1;
  for (StoredLog& log : unknown) {
    if (!apart && !drives.empty())
      drives.front().push_back(std::move(log));
    else
      drives.emplace_back().push_back(std::move(log));
  }
  std::vector<MergedLogs> merged;
  for (std::vector<StoredLog>& drive : drives) merged.emplace_back(std::move(drive));
  return merged;
}

void write_merged(const MergedLogs& merged, const std::string& path) {
  std::error_code none;  // a path that does not exist yet equals no log
  for (const StoredLog& log : merged.logs())
    if (std::filesystem::equivalent(log.name(), path, none))
      throw InputError({path, 0, "", "", "must differ from the merged logs"});
  bool created = false;
  try {
    log::LogWriter writer(path, merged.manifest());
    created = true;
    for (const log::Attachment& one : merged.attachments()) writer.attach(one.name, one.media_type, one.bytes);
    merged.read(writer);
    writer.close();
  } catch (const std::exception&) {
    if (created && std::filesystem::is_regular_file(path, none)) std::filesystem::remove(path, none);
    throw;
  }
}

}  // namespace ttf::recording::merge
