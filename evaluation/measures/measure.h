// The measures of a drive, one row each (table.cc): the table of `run`, summary.json and its schema, the report's page,
// the measures of experiments and docs/reference/measures.md come from these rows alone.
//
// This header needs no drive: the report reads values from summary.json, at the rows' paths. figures.h has the values
// themselves.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace ttf::evaluation::measures {

struct DriveFigures;  // figures.h

// A drive has the measure only with the part that is named.
enum class When : std::uint8_t {
  kAlways,
  kOdometry,    // a node takes samples of it
  kDriven,      // commands drive the vehicle; all below imply it
  kCollision,   // there was one
  kReaction,    // an image had the object ahead slow
  kDetections,  // cameras share a detector
  kLane,        // a service keeps it
  kWarnsAhead,  // a service warns of collisions, or brakes
  kBlindSpot,   // a service watches it
};

// The value of a drive: a number or a count. An optional that is empty, as any value that is not finite, is none.
class Getter {
 public:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  template <class Of> explicit(false) constexpr Getter(Of /*without captures*/) : of_(&call<Of>) {
    using Result = std::invoke_result_t<Of, const DriveFigures&>;
    is_count_ = std::integral<Result> || std::same_as<Result, std::optional<std::uint64_t>>;
  }
  double operator()(const DriveFigures& figures) const { return of_(figures); }
  bool is_count() const { return is_count_; }

 private:
  template <class Of> static double call(const DriveFigures& figures) {
    const auto value = Of{}(figures);
    if constexpr (std::is_arithmetic_v<std::remove_cv_t<decltype(value)>>)
      return static_cast<double>(value);
    else
      return value ? static_cast<double>(*value) : kNone;
  }
  double (*of_)(const DriveFigures&);
  bool is_count_ = false;
};

// Another unit for people than for programs.
struct Scale {
  double factor = 1.0;
  std::string_view unit = "";
};

enum class ShownIn : std::uint8_t { kBoth, kTable, kPage };

// How people see it: in the table of `run`, and on the report's page. Without a label they do not.
struct Shown {
  std::string_view label = "";  // without the unit, which follows in brackets
  int decimals = 0;
  Scale scale{};
  ShownIn place = ShownIn::kBoth;
  bool is_rare = false;           // 0 in a sound drive: shown if it is not 0 in some drive
  bool has_interval = false;      // on the page, over repeated drives
  std::string_view line = "";     // the table's label, with units, where rows behind it join its line
  std::string_view join = "";     // joins the line of the row before, behind this separator
  std::string_view absent = "";   // a driven vehicle's cell without a value; its line is there all the same
  std::string_view trouble = "";  // a count of this means that something went wrong: "missed deadline"

 private:
  template <class Value> constexpr Shown with(Value Shown::*member, Value value) const {
    Shown changed = *this;
    changed.*member = value;
    return changed;
  }

 public:
  constexpr Shown in(Scale unit) const { return with(&Shown::scale, unit); }
  constexpr Shown only(ShownIn there) const { return with(&Shown::place, there); }
  constexpr Shown rare() const { return with(&Shown::is_rare, true); }
  constexpr Shown repeated() const { return with(&Shown::has_interval, true); }
  constexpr Shown begins(std::string_view text) const { return with(&Shown::line, text); }
  constexpr Shown joins(std::string_view separator) const { return with(&Shown::join, separator); }
  constexpr Shown or_else(std::string_view text) const { return with(&Shown::absent, text); }
  constexpr Shown means(std::string_view what) const { return with(&Shown::trouble, what); }
};

struct Measure {
  std::string_view name;  // in experiments; empty: they have no such measure
  std::string_view path;  // a JSON pointer into a strategy's part of summary.json; empty: it is not there
  std::string_view unit;  // the value's unit; empty for shares, counts and normalised squares
  Getter of;
  std::string_view meaning;    // in lower case, without a full stop
  std::string_view if_missed;  // how it takes an object that the image misses; only with a name
  Shown shown{};
  When when = When::kAlways;
  bool is_event = false;  // 0 or 1 in a drive: its mean is a share of drives (experiments/results/share.h)
};

enum class Subject : std::uint8_t { kErrors, kLists, kTracking, kCluster, kDriving };
inline constexpr Subject kSubjects[] = {Subject::kErrors, Subject::kLists, Subject::kTracking, Subject::kCluster,
                                        Subject::kDriving};

// In the order of the table. All, or those of a subject.
std::span<const Measure> measures();
std::span<const Measure> measures(Subject subject);

const Measure* find_measure(std::string_view name);  // null if experiments have no such measure
// Returns the row with such a path. One that no row has is our bug.
const Measure& measure_at(std::string_view path);

// Returns whether a change is best told as a share of the value before. So it is for errors, distances and ages, which have
// a unit and cannot be negative. It is not for shares, counts and normalised squares, nor for an error minus an expected one.
bool is_ratio_scale(const Measure& measure);

// Returns the label with the unit that people see.
std::string label_of(const Measure& measure);

}  // namespace ttf::evaluation::measures
