// Walks through the records of several logs in their canonical order. Private to the module.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "recording/log/codec.h"
#include "recording/mcap/chunk.h"
#include "recording/merge/common_time.h"
#include "recording/merge/record_place.h"
#include "recording/merge/stored_log.h"

namespace ttf::recording::merge {

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
  MergeWalk(const std::vector<StoredLog>& logs, const std::vector<CommonTime>& times);

  // Returns all records of the next instant, in their order; empty at the end. Valid until the next call.
  const std::vector<Message>& next();

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
  static bool later(const std::unique_ptr<Open>& a, const std::unique_ptr<Open>& b);
  void open(const Upcoming& upcoming);
  std::unique_ptr<Open> closed_chunk();

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

}  // namespace ttf::recording::merge
