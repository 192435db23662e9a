// A timeline of lanes with slices, instants, counters and flows, written as a Perfetto trace while it grows.
//
// Events come roughly in the order of time; after a while they are written in exactly that order. A slice that
// begins before the last one of its lane has ended goes into a lane beside it, with the same name and a number.
// A slice becomes an instant if it has no length, or is too long to be true (a damaged log). The trace is one
// packet sequence; times before the drive's start are written as its start.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/time.h"

namespace ttf::recording::exports {

// A property of a slice or an instant, shown when it is selected.
struct TraceNote {
  const char* name;
  std::variant<std::int64_t, std::string> value;
};

// A reported slice or instant.
struct TraceMark {
  TrueTime at{};
  std::uint64_t serial = 0;  // order of the reports
  auto operator<=>(const TraceMark&) const = default;
};

// A slice's part in a flow; the last slice ends it.
struct TraceFlow {
  std::uint64_t id = 0;
  bool ends = false;
};

struct TraceCounts {
  std::uint64_t slices = 0, instants = 0, counters = 0, flows = 0;
};

class TraceTimeline {
 public:
  // Receives the bytes of the trace, in order.
  using Write = std::function<void(std::string_view)>;
  // Returns the flows through a mark; called once, when the mark is written.
  using FlowsOf = std::function<std::vector<TraceFlow>(const ttf::recording::exports::TraceMark&)>;

  TraceTimeline(Write write, FlowsOf flows_of) : write_(std::move(write)), flows_of_(std::move(flows_of)) {}

  // A group is a heading over its lanes.
  TraceMark slice(const std::string& group, const std::string& lane, TrueTime begin, TrueTime end, std::string name,
                  std::vector<TraceNote> notes);
  TraceMark instant(const std::string& group, const std::string& lane, TrueTime at, std::string name,
                    std::vector<TraceNote> notes);
  void counter(const std::string& group, const std::string& lane, TrueTime at, double value);
  // Opens a slice whose end is not known yet, in a lane that has only this one. finish() ends it at the latest.
  void begin(const std::string& group, const std::string& lane, TrueTime at, std::string name,
             std::vector<TraceNote> notes);
  void end(const std::string& group, const std::string& lane, TrueTime at);

  // Adds a note to a mark that is not yet written.
  void note(const TraceMark& mark, TraceNote note);

  // Writes all events before `at`; no later report may be that old.
  void write_before(TrueTime at);
  void finish();
  const TraceCounts& counts() const { return counts_; }

 private:
  enum class What : std::uint8_t { kEnd, kCounter, kInstant, kBegin };  // in this order at one instant
  struct Lane {
    std::uint64_t track = 0;
    TrueTime busy_until{};
    bool open = false;  // begin() without its end()
  };
  struct Event {
    What what{};
    std::uint64_t track = 0;
    double value = 0;
    std::string name;
    std::vector<TraceNote> notes;
  };
  using Place = std::tuple<TrueTime, What, std::uint64_t>;  // the last: TraceMark::serial

  std::uint64_t group_track(const std::string& group);
  Lane& lane_of(const std::string& group, const std::string& lane, bool counts, std::size_t beside = 0);
  TraceMark put(TrueTime at, Event event);
  void write(const Place& place, const Event& event);

  Write write_;
  FlowsOf flows_of_;
  std::map<std::string, std::uint64_t> groups_;  // by name: track
  std::map<std::tuple<std::string, std::string, std::size_t>, Lane> lanes_;
  std::map<Place, Event> waiting_;
  std::uint64_t tracks_ = 0, serials_ = 0;
  TrueTime written_{}, last_{};  // events before `written_` are written
  TraceCounts counts_;
};

}  // namespace ttf::recording::exports
