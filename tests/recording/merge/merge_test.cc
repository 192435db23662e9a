// Several logs as one: the order of records, matching logs, and the cost of damage.
#include "recording/merge/merge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/errors.h"
#include "core/file_bytes.h"
#include "core/random.h"
#include "recording/mcap/reader.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/merge/split_log.h"

namespace ttf::recording::merge {
namespace {

std::vector<std::string> lines_of(const MergedLogs& merged) {
  TextSink sink;
  merged.read(sink);
  return std::move(sink.lines);
}

// Logs in memory, from the records emitted into each.
using Emission = std::function<void(std::vector<ttf::recording::records::Sink*>&)>;
std::vector<StoredLog> logs_of(std::size_t count, const Emission& emission,
                               const log::LogManifest& manifest = log::sample_manifest()) {
  std::vector<std::unique_ptr<log::LogWriter>> writers;
  std::vector<records::Sink*> sinks;
  const auto path = [](std::size_t i) { return log::scratch("part" + std::to_string(i) + ".mcap"); };
  for (std::size_t i = 0; i < count; ++i) {
    writers.push_back(std::make_unique<log::LogWriter>(path(i), manifest));
    writers.back()->attach("cluster.yaml", "application/yaml", "name: paper\n");
    sinks.push_back(writers.back().get());
  }
  emission(sinks);
  std::vector<StoredLog> logs;
  for (std::size_t i = 0; i < count; ++i) {
    writers[i]->close();
    logs.emplace_back(read_file(path(i)), "part" + std::to_string(i) + ".mcap");
  }
  return logs;
}

// Records of all kinds, 40 within each 10 us, 20 ms apart. Many share an instant; within the 10 us they are
// unordered.
void emit_crowd(records::Sink& sink) {
  for (std::uint32_t i = 0; i < 4000; ++i)
    emit(sink, log::kind_of(i), Values::kDrawn, i, std::int64_t{i / 40} * 20'000'000 - 5'000);
}
Emission crowd() {
  return [](std::vector<records::Sink*>& sinks) {
    ByNode by_node(sinks);
    emit_crowd(by_node);
  };
}

struct MessageTimes final : mcap::McapHandler {
  std::vector<std::uint64_t> times;
  void on_metadata(std::string_view, const std::vector<std::pair<std::string, std::string>>&) override {}
  void on_attachment(std::string_view, std::string_view, std::string_view) override {}
  bool on_message(std::uint16_t, std::uint64_t log_time, std::string_view) override {
    times.push_back(log_time);
    return true;
  }
};

TEST(Merge, ManyLogsOrOneTheSequenceIsTheSame) {
  const MergedLogs whole(logs_of(1, crowd()));
  const std::vector<std::string> expected = lines_of(whole);
  TextSink written;
  emit_crowd(written);
  EXPECT_NE(expected, written.lines) << "in order already";
  EXPECT_EQ(std::multiset<std::string>(expected.begin(), expected.end()),
            std::multiset<std::string>(written.lines.begin(), written.lines.end()));
  for (const std::size_t count : {2u, 3u, 7u, 16u}) {
    const MergedLogs parts(logs_of(count, crowd()));
    EXPECT_EQ(lines_of(parts), expected) << count;
    EXPECT_EQ(lines_of(parts), expected) << count << ", once more";
    EXPECT_EQ(parts.content_hash().value(), whole.logs()[0].info().content_hash);
    EXPECT_EQ(parts.manifest(), log::sample_manifest());
    EXPECT_EQ(parts.warnings(), std::vector<std::string>{});
  }
}

TEST(Merge, TheOrderInWhichLogsAreGivenDoesNotMatter) {
  const std::vector<std::string> expected = lines_of(MergedLogs(logs_of(5, crowd())));
  for (const std::size_t turn : {1u, 3u}) {
    std::vector<StoredLog> logs = logs_of(5, crowd());
    std::rotate(logs.begin(), logs.begin() + static_cast<std::ptrdiff_t>(turn), logs.end());
    std::swap(logs[0], logs[1]);
    EXPECT_EQ(lines_of(MergedLogs(std::move(logs))), expected);
  }
}

TEST(Merge, AMergedLogIsTheSameFileWhateverItIsMergedOf) {
  const auto merged_bytes = [](std::vector<StoredLog> logs) {
    const std::string path = log::scratch("merged.mcap");
    write_merged(MergedLogs(std::move(logs)), path);
    return read_file(path);
  };
  const std::string whole = merged_bytes(logs_of(1, crowd()));
  EXPECT_TRUE(merged_bytes(logs_of(6, crowd())) == whole);
  std::vector<StoredLog> again;
  again.emplace_back(whole, "merged.mcap");
  EXPECT_TRUE(merged_bytes(std::move(again)) == whole) << "merging a merged log changes nothing";
  MessageTimes times;
  walk_mcap(whole, times);
  EXPECT_EQ(times.times.size(), 4000u);
  for (std::size_t i = 1; i < times.times.size(); ++i)
    EXPECT_GE(times.times[i] + 100, times.times[i - 1]) << "faults alone stand before their time";
  records::Sink nobody;
  const log::LogInfo info = log::read_log_bytes(whole, "merged.mcap", nobody);
  EXPECT_EQ(info.warning, "");
  EXPECT_EQ(info.attachments, (std::vector<log::Attachment>{{"cluster.yaml", "application/yaml", "name: paper\n"}}));
}

constexpr NodeId kA{0}, kB{1};
records::Stamp at(std::int64_t ns, NodeId node) { return {TrueTime{ns}, LocalTime{ns}, GlobalTime{ns}, node}; }

// All in one log, in its order; or A's records in one log and B's in another:
//   true time        -40        0              1000 ns
//   of the run                                 fault 0 ends, fault 1 begins and acts
//   of node A        power on   three states   power off: 3 ns earlier by its own clock
//   of node B                                  use of an image, and the truth then
TEST(Merge, AtOneInstantCausesStandBeforeEffectsAndANodesReportsInTheirOrder) {
  const auto emission = [](std::vector<records::Sink*>& sinks) {
    records::Sink& a = *sinks.front();
    records::Sink& b = *sinks.back();
    b.on(records::TruthState{TrueTime{1000}, ObjectId{7}, 0, 0, 0, 0, 0, 0, 0, 0, LocalTime{}, GlobalTime{}, kB});
    b.on(records::TruthState{TrueTime{1000}, ObjectId{3}, 0, 0, 0, 0, 0, 0, 0, 0, LocalTime{}, GlobalTime{}, kB});
    b.on(records::FeatureUsed{at(1000, kB), 1, GlobalTime{}, true, {}, false});
    a.on(records::PowerChanged{at(997, kA), false});
    a.on(records::FaultActivity{TrueTime{1000}, 1, records::FaultAct::kActs, kA, "crash", "it stops"});
    a.on(records::FaultActivity{TrueTime{1000}, 1, records::FaultAct::kBegins, kA, "crash", ""});
    a.on(records::FaultActivity{TrueTime{1000}, 0, records::FaultAct::kEnds, kA, "noise", ""});
    a.on(records::StateChanged{at(0, kA), records::PocKind::kConfig, records::PocKind::kReady, "config", "ready", "2nd",
                               ""});
    a.on(records::StateChanged{at(0, kA), records::PocKind::kReady, records::PocKind::kColdstartListen, "ready",
                               "listen", "3rd", ""});
    a.on(records::StateChanged{at(0, kA), records::PocKind::kColdstartListen, records::PocKind::kDefaultConfig,
                               "listen", "default", "1st again", ""});
    a.on(records::PowerChanged{at(-40, kA), true});
  };
  TextSink expected;
  expected.on(records::PowerChanged{at(-40, kA), true});
  expected.on(records::StateChanged{at(0, kA), records::PocKind::kConfig, records::PocKind::kReady, "config", "ready",
                                    "2nd", ""});
  expected.on(records::StateChanged{at(0, kA), records::PocKind::kReady, records::PocKind::kColdstartListen, "ready",
                                    "listen", "3rd", ""});
  expected.on(records::StateChanged{at(0, kA), records::PocKind::kColdstartListen, records::PocKind::kDefaultConfig,
                                    "listen", "default", "1st again", ""});
  expected.on(records::FaultActivity{TrueTime{1000}, 0, records::FaultAct::kEnds, kA, "noise", ""});
  expected.on(records::FaultActivity{TrueTime{1000}, 1, records::FaultAct::kBegins, kA, "crash", ""});
  expected.on(records::FaultActivity{TrueTime{1000}, 1, records::FaultAct::kActs, kA, "crash", "it stops"});
  expected.on(records::PowerChanged{at(997, kA), false});
  expected.on(records::FeatureUsed{at(1000, kB), 1, GlobalTime{}, true, {}, false});
  expected.on(records::TruthState{TrueTime{1000}, ObjectId{7}, 0, 0, 0, 0, 0, 0, 0, 0, LocalTime{}, GlobalTime{}, kB});
  expected.on(records::TruthState{TrueTime{1000}, ObjectId{3}, 0, 0, 0, 0, 0, 0, 0, 0, LocalTime{}, GlobalTime{}, kB});
  for (const std::size_t count : {1u, 2u})
    EXPECT_EQ(lines_of(MergedLogs(logs_of(count, emission))), expected.lines) << count;
}

// A record reported 30 s after its time, behind a hundred chunks: no window is too small for it.
TEST(Merge, ARecordReportedMuchLaterStandsAtItsTime) {
  const auto emission = [](std::vector<records::Sink*>& sinks) {
    for (std::int64_t i = 0; i < 300; ++i)
      sinks.front()->on(records::PowerChanged{at(i * 100'000'000, kA), i % 2 == 0});
    records::ReferenceFix fix;
    fix.measured_true = TrueTime{150'000'000};
    sinks.back()->on(fix);
  };
  for (const std::size_t count : {1u, 2u}) {
    const MergedLogs merged(logs_of(count, emission));
    EXPECT_GT(merged.logs()[0].chunks().size(), 99u);
    const std::vector<std::string> lines = lines_of(merged);
    ASSERT_EQ(lines.size(), 301u);
    EXPECT_EQ(lines[2].substr(0, 10), "/reference");
  }
}

std::string refused(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.findings().size() == 1 ? error.findings()[0].sentence() : "several findings";
  }
  return "";
}

std::vector<StoredLog> pair_with(const std::function<void(ttf::recording::log::LogManifest&)>& change) {
  std::vector<StoredLog> logs = logs_of(2, crowd());
  log::LogManifest manifest = log::sample_manifest();
  change(manifest);
  logs[1] = std::move(logs_of(2, crowd(), manifest)[1]);
  return logs;
}

TEST(Merge, LogsOfDifferentRunsAreRefusedByFileAndKey) {
  const auto sentence = [](const std::function<void(ttf::recording::log::LogManifest&)>& change) {
    return refused([&] { MergedLogs{pair_with(change)}; });
  };
  EXPECT_EQ(sentence([](log::LogManifest&) {}), "");
  EXPECT_EQ(sentence([](log::LogManifest& m) { m.seed = 4; }),
            "part1.mcap: seed = 4: must be 18446744073709551615 as in part0.mcap: only logs of one drive are merged");
  EXPECT_EQ(sentence([](log::LogManifest& m) { m.strategy = "adva"; }),
            "part1.mcap: strategy = adva: must be tt as in part0.mcap: only logs of one drive are merged");
  EXPECT_EQ(sentence([](log::LogManifest& m) { m.hashes[0].second = "00fe"; }),
            "part1.mcap: hash.cluster = 00fe: must be 00ff as in part0.mcap: only logs of one drive are merged");
  EXPECT_EQ(sentence([](log::LogManifest& m) { m.recording_name.clear(); }),
            "part1.mcap: recording: must be street.txt as in part0.mcap: only logs of one drive are merged");
  EXPECT_EQ(sentence([](log::LogManifest& m) { m.can_bus_names.push_back("third"); }),
            "part1.mcap: can_bus.2 = third: is not in part0.mcap: only logs of one drive are merged");
}

TEST(Merge, ByRunLogsOfEachRunComeTogether) {
  std::vector<StoredLog> logs = pair_with([](log::LogManifest& m) { m.strategy = "adva"; });
  for (std::size_t i = 1; i < 3; ++i) {
    const std::string name = logs_of(3, crowd())[i].name();
    logs.emplace_back(read_file(log::scratch(name)), "more " + name);
  }
  const std::vector<MergedLogs> runs = merge_by_drive(std::move(logs));
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].manifest().strategy, "tt");
  ASSERT_EQ(runs[0].logs().size(), 3u);
  EXPECT_EQ(runs[0].logs()[2].name(), "more part2.mcap");
  EXPECT_EQ(runs[1].manifest().strategy, "adva");
  EXPECT_EQ(runs[1].logs().size(), 1u);
}

TEST(Merge, TheSameLogTwiceIsRefused) {
  const std::string kTwice =
      "copy.mcap: holds the same records as part1.mcap: give each log once, and a merged log without its parts";
  const auto copied = [](const std::string& bytes) {
    std::vector<StoredLog> logs = logs_of(2, crowd());
    logs.emplace_back(bytes.empty() ? read_file(log::scratch("part1.mcap")) : bytes, "copy.mcap");
    return logs;
  };
  EXPECT_EQ(refused([&] { MergedLogs{copied("")}; }), kTwice);
  // By its hash, a truncated copy is another log; its records give it away.
  const std::string cut = read_file(log::scratch("part1.mcap")).substr(0, 200'000);
  const MergedLogs merged(copied(cut));
  EXPECT_EQ(refused([&] { lines_of(merged); }), kTwice);
  EXPECT_EQ(refused([&] { write_merged(merged, log::scratch("none.mcap")); }), kTwice);
  EXPECT_FALSE(std::filesystem::exists(log::scratch("none.mcap")));
}

// A folder after merging its logs.
TEST(Merge, TheWholeAmongItsPartsIsPassedOver) {
  const std::string path = log::scratch("whole_among_parts.mcap");
  const MergedLogs parts(logs_of(3, crowd()));
  write_merged(parts, path);
  for (const std::size_t place : {0u, 2u, 3u}) {
    std::vector<StoredLog> logs = logs_of(3, crowd());
    logs.emplace(logs.begin() + static_cast<std::ptrdiff_t>(place), read_file(path), "whole.mcap");
    const MergedLogs all(std::move(logs));
    ASSERT_EQ(all.logs().size(), 3u);
    EXPECT_EQ(all.warnings(),
              std::vector<std::string>{"whole.mcap: is ignored: it holds the records of the other 3 logs"});
    EXPECT_EQ(lines_of(all), lines_of(parts));
    EXPECT_EQ(all.content_hash().value(), parts.content_hash().value());
  }
  // With one part missing, the whole has more records than the parts together.
  std::vector<StoredLog> fewer = logs_of(3, crowd());
  fewer.back() = StoredLog(read_file(path), "whole.mcap");
  const MergedLogs overlapping(std::move(fewer));
  EXPECT_TRUE(overlapping.warnings().empty());
  TextSink sink;
  try {
    overlapping.read(sink);
    ADD_FAILURE() << "read twice";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("and a merged log without its parts"), std::string::npos) << error.what();
  }
}

TEST(Merge, NoLogIsWrittenOver) {
  const std::string path = log::scratch("whole.mcap");
  std::filesystem::copy_file((logs_of(1, crowd()), log::scratch("part0.mcap")), path);
  const std::string before = read_file(path);
  const MergedLogs merged(std::vector<std::string>{path});
  EXPECT_EQ(refused([&] { write_merged(merged, path); }), path + ": must differ from the merged logs");
  EXPECT_TRUE(read_file(path) == before);
  EXPECT_THROW(write_merged(merged, log::scratch("no/such/folder.mcap")), std::runtime_error);
}

// Damage in one log costs only records of that log, and is reported with its name.
TEST(Merge, ADamagedLogLosesWhatWasDamagedAndTheOthersNothing) {
  constexpr std::size_t kDamaged = 1;
  const std::vector<StoredLog> sound = logs_of(3, crowd());
  std::vector<std::string> bytes;
  for (std::size_t i = 0; i < 3; ++i) bytes.push_back(read_file(log::scratch("part" + std::to_string(i) + ".mcap")));
  const auto merged = [&](const std::string& damaged) {
    std::vector<StoredLog> logs;
    for (std::size_t i = 0; i < 3; ++i)
      logs.emplace_back(i == kDamaged ? damaged : bytes[i], "part" + std::to_string(i) + ".mcap");
    return MergedLogs(std::move(logs));
  };
  const std::vector<std::string> whole = lines_of(merged(bytes[kDamaged]));
  TextSink own_lines;
  log::read_log_bytes(bytes[kDamaged], "", own_lines);
  const std::multiset<std::string> own(own_lines.lines.begin(), own_lines.lines.end());

  int lost_some = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 2});
    std::string damaged = bytes[kDamaged];
    const auto place = static_cast<std::size_t>(stream.integer(8, static_cast<std::int64_t>(damaged.size()) - 1));
    switch (seed % 4) {
      case 0: damaged[place] = static_cast<char>(damaged[place] ^ static_cast<char>(stream.integer(1, 255))); break;
      case 1: damaged.erase(place, static_cast<std::size_t>(stream.integer(1, 40'000))); break;
      case 2: damaged.insert(place, static_cast<std::size_t>(stream.integer(1, 40)), '\xff'); break;
      default: damaged.resize(place);
    }
    const MergedLogs result = merged(damaged);
    const std::vector<std::string> warnings = result.warnings();
    ASSERT_EQ(warnings.size(), 1u) << seed;
    EXPECT_EQ(warnings[0].substr(0, 12), "part1.mcap: ") << seed;
    EXPECT_EQ(result.manifest(), log::sample_manifest()) << seed;
    // The whole without some lines of the damaged log, in the same order.
    const std::vector<std::string> lines = lines_of(result);
    lost_some += lines.size() < whole.size() ? 1 : 0;
    auto line = lines.begin();
    for (const std::string& expected : whole) {
      if (line != lines.end() && *line == expected)
        ++line;
      else
        ASSERT_TRUE(own.contains(expected)) << "seed " << seed << ": a record of another log is missing: " << expected;
    }
    ASSERT_EQ(line, lines.end()) << "seed " << seed << ": a record that was not there, or not there: " << *line;
  }
  EXPECT_GT(lost_some, 100);
}

TEST(Merge, ALogWithoutManifestBelongsToTheOthers) {
  std::vector<StoredLog> logs = logs_of(2, crowd());
  std::string torn = read_file(log::scratch("part0.mcap"));
  const std::size_t manifest = torn.find("leading car");
  torn[manifest] = 'L';
  logs[0] = StoredLog(torn, "part0.mcap");
  const MergedLogs merged(std::move(logs));
  EXPECT_EQ(merged.manifest(), log::sample_manifest()) << "the sound one";
  EXPECT_EQ(merged.warnings(),
            std::vector<std::string>{"part0.mcap: bytes outside the chunks are damaged (checksum of the data section); "
                                     "all records are read\n"
                                     "part0.mcap: the manifest is damaged: names and seed may be wrong"});
  EXPECT_EQ(lines_of(merged), lines_of(MergedLogs(logs_of(2, crowd()))));
}

}  // namespace
}  // namespace ttf::recording::merge
