// A reader of DBC files for tests, independent of the writer. It reads messages and signals, and decodes
// signals' bits by the format's rules. An unknown line fails the test.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/patterns.h"

namespace ttf::schedules::exchange {

struct DbcSignal {
  std::string name, unit, receivers;
  std::string multiplexed;  // "M": the multiplexor; "m4": present if that is 4; empty: always present
  bool is_signed = false;
  int start = 0, bits = 0;
  double factor = 0, offset = 0, low = 0, high = 0;

  // Big-endian: from the start bit towards bit 0 of its byte, then on from bit 7 of the next.
  std::uint64_t raw(std::span<const std::byte> data) const {
    std::uint64_t value = 0;
    int byte = start / 8, bit = start % 8;
    for (int i = 0; i < bits; ++i) {
      value = value << 1 | (static_cast<std::uint64_t>(data[static_cast<std::size_t>(byte)]) >> bit & 1);
      if (bit-- == 0) bit = 7, ++byte;
    }
    return value;
  }
  double physical(std::span<const std::byte> data) const {
    const std::uint64_t value = raw(data);
    const bool negative = is_signed && (value >> (bits - 1) & 1) != 0;
    const double beyond = negative ? static_cast<double>(std::uint64_t{1} << bits) : 0;
    return offset + factor * (static_cast<double>(value) - beyond);
  }
};

struct DbcMessage {
  std::string name, sender, comment;
  int length = 0;
  std::vector<DbcSignal> signals;
  std::map<std::string, std::string> attributes;

  const DbcSignal& signal(const std::string& wanted) const {
    for (const DbcSignal& one : signals)
      if (one.name == wanted) return one;
    ADD_FAILURE() << "no signal " << wanted << " in " << name;
    return signals.front();
  }
};

struct DbcFile {
  std::vector<std::string> nodes;
  std::map<std::uint32_t, DbcMessage> messages;
};

inline DbcFile read_dbc(const std::string& text) {
  static const std::string kName = "([A-Za-z_][A-Za-z0-9_]*)", kNumber = "(-?[0-9.]+(?:[eE][-+]?[0-9]+)?)";
  static const support::Pattern kMessage("BO_ ([0-9]+) " + kName + ": ([0-9]+) " + kName);
  static const support::Pattern kSignal(" SG_ " + kName + "(?: (M|m[0-9]+))? : ([0-9]+)\\|([0-9]+)@0([+-]) \\(" +
                                        kNumber + "," + kNumber + "\\) \\[" + kNumber + "\\|" + kNumber +
                                        "\\] \"([^\"]*)\" ([A-Za-z0-9_,]+)");
  static const support::Pattern kComment("CM_ BO_ ([0-9]+) \"([^\"]*)\";");
  static const support::Pattern kAttribute("BA_ \"([A-Za-z]+)\" BO_ ([0-9]+) (?:\"([^\"]*)\"|([0-9]+));");
  static const support::Pattern kNodes("BU_:((?: [A-Za-z_][A-Za-z0-9_]*)*)");
  static const support::Pattern kOther("|VERSION \"[^\"]*\"|NS_ :|BS_:|BA_DEF_ BO_ .*;|BA_DEF_DEF_ .*;|VAL_ .* ;");
  DbcFile file;
  DbcMessage* latest = nullptr;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::optional<support::Match> match;
    const auto is = [&](const support::Pattern& pattern) {
      return (match = support::whole_match(line, pattern)).has_value();
    };
    const auto part = [&](std::size_t i) -> const std::string& { return (*match)[i]; };
    const auto number = [&](std::size_t i) { return std::stoul(part(i)); };
    const auto real = [&](std::size_t i) { return std::stod(part(i)); };
    if (is(kMessage)) {
      const auto identifier = static_cast<std::uint32_t>(number(1));
      EXPECT_EQ(file.messages.count(identifier), 0u) << line;
      latest = &file.messages[identifier];
      latest->name = part(2);
      latest->length = static_cast<int>(number(3));
      latest->sender = part(4);
    } else if (is(kSignal) && latest != nullptr) {
      for (const DbcSignal& other : latest->signals) EXPECT_NE(other.name, part(1)) << line;
      latest->signals.push_back({.name = part(1),
                                 .unit = part(10),
                                 .receivers = part(11),
                                 .multiplexed = part(2),
                                 .is_signed = part(5) == "-",
                                 .start = static_cast<int>(number(3)),
                                 .bits = static_cast<int>(number(4)),
                                 .factor = real(6),
                                 .offset = real(7),
                                 .low = real(8),
                                 .high = real(9)});
    } else if (is(kComment)) {
      file.messages.at(static_cast<std::uint32_t>(number(1))).comment = part(2);
    } else if (is(kAttribute)) {
      file.messages.at(static_cast<std::uint32_t>(number(2))).attributes[part(1)] = part(3) + part(4);
    } else if (is(kNodes)) {
      std::istringstream names(part(1));
      for (std::string name; names >> name;) file.nodes.push_back(name);
    } else {
      EXPECT_TRUE(is(kOther)) << line;
    }
  }
  return file;
}

}  // namespace ttf::schedules::exchange
