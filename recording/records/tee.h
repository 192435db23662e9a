// Passes every record on to several sinks, in their order.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "recording/records/every.h"

namespace ttf::recording::records {

class Tee final : public Every<Tee> {
 public:
  explicit Tee(std::vector<Sink*> sinks) : sinks_(std::move(sinks)) {}
  bool wants_frames() const override {
    return std::any_of(sinks_.begin(), sinks_.end(), [](const Sink* sink) { return sink->wants_frames(); });
  }
  template <class Record> void each(const Record& record) {
    for (Sink* sink : sinks_) sink->on(record);
  }

 private:
  std::vector<Sink*> sinks_;
};

}  // namespace ttf::recording::records
