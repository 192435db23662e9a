// A sink that treats every kind of record alike: the derived class defines each() once.
//
//   class Counter final : public Every<Counter> {
//    public:
//     template <class Record> void each(const Record&) { ++records_; }
//   ...
#pragma once

#include <cstddef>

#include "recording/records/records.h"

namespace ttf::recording::records {

template <class Derived, std::size_t kinds = kKindCount> class Every : public Every<Derived, kinds - 1> {
 public:
  using Every<Derived, kinds - 1>::on;
  void on(const RecordAt<kinds>& record) final { static_cast<Derived&>(*this).each(record); }
};
template <class Derived> class Every<Derived, 0> : public Sink {};

}  // namespace ttf::recording::records
