// Makes the seeds of every fuzz target, from shipped files and by our encoders, so that they need not be
// stored.
//   fuzz_seeds FOLDER       FOLDER/<target>/<seed>, and FOLDER/<target>.dict where words help
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "bus/wire/flexray_frame.h"
#include "core/check.h"
#include "core/random.h"
#include "experiments/results/store.h"
#include "recording/capture/packet.h"
#include "recording/exports/pcapng_writer.h"
#include "recording/log/writer.h"
#include "recording/mcap/reader.h"
#include "schedules/file/loader.h"
#include "sim/processes/turn.h"
#include "tests/fuzz/harness.h"
#include "tests/recording/osi/written_trace.h"
#include "tests/recording/record_text.h"
#include "tests/schedules/exchange/fibex/fibex_example.h"

namespace {

using namespace ttf;
namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  TTF_CHECK(file << bytes, "{} cannot be written", path.string());
}

template <class Int> void put(std::string& out, Int value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string drawn_bytes(std::uint32_t index, std::size_t count) {
  RandomStream random({.seed = 7, .purpose = Purpose::kTest, .entity = 0, .index = index});
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(random.bits());
  return bytes;
}

bool of_a_name(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}

// Keys and how often each occurs.
std::map<std::string, int> keys_of(const std::string& yaml) {
  std::map<std::string, int> keys;
  std::string word;
  for (const char c : yaml) {
    if (c == ':' && !word.empty()) ++keys[word];
    word = of_a_name(c) ? word + c : "";
  }
  return keys;
}

void write_dictionary(const fs::path& path, const std::set<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += "\"" + word + "\"\n";
  write(path, text);
}

// Text targets get the files themselves. Edit targets get two seeds for each key: one sets it to a plausible
// value, one drops it.
void yaml_seeds(const fs::path& folder, const std::string& what, const fs::path& shipped_in,
                const std::vector<std::string>& names) {
  const std::array<std::string, 8> values{"0", "1", "-1", "1023", "5 ms", "1e300", "true", "[1, 2]"};
  std::set<std::string> words{"0",    "1",    "-1",     "65535", "2147483647", "1e308", "nan", "0.5",
                              "1 ns", "5 ms", "3600 s", "true",  "false",      "[",     "]",   "{",
                              "}",    "- ",   "+ ",     "AB",    "&a",         "*a"};
  std::size_t next = 0;
  std::set<std::string> known;
  for (const std::string& name : names) {
    const bool may_extend = *shipped_in.begin() == "schedules";
    const std::string text = may_extend
                                 ? fuzz::shipped_cluster((shipped_in.lexically_relative("schedules") / name).string())
                                 : fuzz::shipped((shipped_in / (name + ".yaml")).string());
    write(folder / (what + "_text") / name, text);
    write(folder / (what + "_edits") / name, name + "\n");
    for (const auto& [key, times] : keys_of(text)) {
      words.insert(key);
      if (!known.insert(key).second) continue;
      const std::string edits = folder / (what + "_edits") / (name + "_" + key);
      write(edits, name + "\n" + key + " 0 " + values[next++ % values.size()] + "\n");
      write(edits + "_dropped", name + "\n- " + key + " " + std::to_string(times / 2) + "\n");
    }
  }
  write_dictionary(folder / (what + "_text.dict"), words);
  write_dictionary(folder / (what + "_edits.dict"), words);
}

// The files written by hand, a small one, and the names that FIBEX gives things.
void fibex_seeds(const fs::path& folder) {
  const std::string powertrain = schedules::exchange::fibex::kPowertrain,
                    objects = schedules::exchange::fibex::kObjects;
  write(folder / "fibex_text/powertrain", powertrain);
  write(folder / "fibex_text/objects", objects);
  write(folder / "fibex_text/empty", "<fx:FIBEX><fx:ELEMENTS/></fx:FIBEX>");
  std::set<std::string> words{"<!--", "-->",   "<![CDATA[", "]]>",   "&#10;", "&lt;", "/>",    "ID-REF=\\x22",
                              "true", "false", "-1",        "1e308", "2047",  "64",   "0.0125"};
  std::string name;
  for (const char c : powertrain + objects) {
    const bool of_it = of_a_name(c) || c == ':' || c == '-';
    if (!of_it && name.find(':') != std::string::npos && name.size() > 4) words.insert("<" + name + ">");
    name = of_it ? name + c : "";
  }
  write_dictionary(folder / "fibex_text.dict", words);
}

void recorded_seeds(const fs::path& folder) {
  write(folder / "recorded/laser_radar",
        "L\t4.6\t0.3\t1477010443000000\t4.7\t0.2\t5\t0.1\t0\t0\n"
        "R\t8.46\t0.0287\t-3.04\t1477010443050000\t8.6\t0.25\t-3.0\t0\t0.01\t0.006\n");
  std::string scans = "frame, azimuth_rad, range_m, intensity\n";
  for (int frame = 0; frame < 2; ++frame)
    for (int i = 0; i < 40; ++i)
      scans += std::to_string(frame) + "," + std::to_string(0.01 * i) + "," + std::to_string(10 + i / 10) + ",0.5\n";
  write(folder / "recorded/scans", scans);
  write_dictionary(folder / "recorded.dict", {"L\\x09", "R\\x09", "frame", "e308", "nan", "-", "\\x0d\\x0a", "#"});
}

void observation_seeds(const fs::path& folder) {
  std::string cars = "time,arrival,sensor,x,y,heading,length,width,class,score,z,height\n";
  std::string radar = "time,sensor,range,bearing,range_rate,cov_11,cov_12,cov_22,cov_13,cov_23,cov_33\n";
  for (int i = 0; i < 8; ++i) {
    const std::string time = "0." + std::to_string(i);
    for (const char* car : {"1", "3"})
      cars += time + "," + time + (i % 3 == 0 ? "9" : "1") + "," + (i % 2 == 0 ? "lidar" : "camera") + "," + car +
              std::to_string(i) + ".5,-2,0.1,4.4,1.8," + (i % 4 == 0 ? "\"van, white\"" : "car") + ",0.8,0.7,1.5\n";
    radar += time + ",radar,2" + std::to_string(i) + ",0.1,10,0.09,0.001,0.0004,0,0,0.04\n";
  }
  write(folder / "observations/cars", cars);
  write(folder / "observations/radar", radar);
  write(folder / "observations/bearings",
        "\xef\xbb\xbftime,sensor,range,bearing\r\n0,a,5,0.1\r\n0,a,9,-3\r\n# end\r\n");
  write_dictionary(
      folder / "observations.dict",
      {"time",   "arrival",      "sensor", "x",           "y",          "range",  "bearing", "range_rate",
       "cov_11", "cov_12",       "cov_22", "cov_13",      "cov_23",     "cov_33", "heading", "sigma_heading",
       "length", "sigma_length", "width",  "sigma_width", "z",          "height", "class",   "score",
       "gt_",    "e308",         "nan",    "-",           "\\x0d\\x0a", "#",      "\\x22"});
}

// The first byte chooses the table's shape (signals_fuzz.cc).
void signal_seeds(const fs::path& folder) {
  write(folder / "signals/nodes", "2" + fuzz::shipped("examples/packing/signals.csv"));
  write(folder / "signals/places",
        "2signal,node,period_ms,release_ms,deadline_ms,bits,slot,first_cycle,bit_offset,channel\n"
        "a,n,5,0,5,15,1,0,2,A\n\"b, c\",n,40,10,29.5,8,1,2,17,A\nd,m,320,,,4,2,60,0,A\n");
  write(folder / "signals/bus", std::string("2") + schedules::exchange::fibex::kPowertrain);
  write(folder / "signals/variants", "2" + fuzz::shipped("examples/packing/variants.csv"));
  write_dictionary(folder / "signals.dict",
                   {"signal", "node", "period_ms", "release_ms", "deadline_ms", "bits", "variants", "|", "slot",
                    "first_cycle", "bit_offset", "channel", "160", "AB", "\\x22"});
}

void frame_seeds(const fs::path& folder) {
  for (const std::size_t payload : {0u, 16u, 254u}) {
    bus::wire::FrameHeader header;
    header.sync = header.startup = payload == 16;
    header.null_frame = payload == 0;
    header.frame_id = static_cast<std::uint16_t>(payload + 1);
    header.cycle = 5;
    std::array<std::byte, bus::wire::kMaxFrameBytes> frame{};
    const std::vector<std::byte> bytes(payload, std::byte{0x5a});
    const std::size_t size = bus::wire::encode_frame(header, schedules::model::Channel::kA, bytes, frame);
    for (const char how : {'\0', '\2'})
      write(folder / "frame" / ("payload_" + std::to_string(payload) + (how != 0 ? "_right" : "")),
            how + std::string(reinterpret_cast<const char*>(frame.data()), size));
  }
}

// Frames whole and in fragments, right and wrong, and follow-ups; some with a byte changed, some CAN frames
// twice.
void flexray_on_can_seeds(const fs::path& folder) {
  for (std::uint32_t i = 0; i < 24; ++i) {
    std::string input(1, static_cast<char>(i & 1));
    for (std::uint32_t k = 0; k < 6; ++k) {
      const std::uint32_t kind = (i + k) % 4;
      const bool changed = (i + k) % 5 == 0, follow_up = kind == 0 && i % 2 == 1;
      input += static_cast<char>(kind | (changed ? 4 : 0) | (follow_up ? 8 : 0));
      const std::uint16_t size = kind == 0 ? 64 : static_cast<std::uint16_t>((i * 6 + k) * 37 % 255);
      if (kind == 3) {
        put(input, static_cast<std::uint16_t>(k));
      } else if (follow_up) {
        input += drawn_bytes(700 + i * 6 + k, 8);
      } else {
        put(input, static_cast<std::uint16_t>(70 + i));
        if (kind == 0) input += '\1';
        if (kind == 0) put(input, static_cast<std::uint8_t>(size));
        if (kind != 0) put(input, size);
        input += drawn_bytes(400 + i * 6 + k, kind == 0 ? size : size + 8u);
      }
      if (changed) input += drawn_bytes(600 + i, 5);
    }
    write(folder / "flexray_on_can" / ("drawn_" + std::to_string(i)), input);
  }
}

// Drawn arrivals at a working node: every byte is an act or its argument.
void live_seeds(const fs::path& folder) {
  for (std::uint32_t i = 0; i < 16; ++i)
    write(folder / "live" / ("drawn_" + std::to_string(i)), drawn_bytes(800 + i, 200 + 150 * i));
}

// A schedule's frames as pcapng and, from the same packets, as pcap; short enough to edit. A turn with every
// act, and an empty one.
void turn_seeds(const fs::path& folder) {
  const schedules::model::Cluster cluster =
      schedules::file::parse_cluster(fuzz::shipped_cluster("closed_loop_synchronised"), "closed_loop");
  std::array<std::byte, bus::wire::kMaxFrameBytes> room{};
  bus::wire::FrameHeader header;
  header.frame_id = 3;
  const std::array<std::byte, 4> payload{std::byte{1}, std::byte{2}};
  const std::size_t size = bus::wire::encode_frame(header, schedules::model::Channel::kA, payload, room);
  const std::span<const std::byte> frame = std::span<const std::byte>(room).first(size);
  const SensorId sensor{0};
  const auto add = [&](const std::string& name, NodeId node, const std::vector<sim::processes::Act>& acts) {
    sim::processes::TurnWriter writer;
    for (const sim::processes::Act& act : acts) writer.add(act);
    const auto bytes = writer.finish({node, 1, Microticks{400}, {Microticks{900}, Microticks{}, Microticks{5}}});
    write(folder / "turn" / name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  };
  const bus::ports::Transmission signal{
      schedules::model::Channel::kA, bus::ports::Signal::kFrame, Microticks{400}, Microticks{500}, 3, frame};
  bus::ports::Transmission symbol = signal;
  symbol.signal = bus::ports::Signal::kWakeup;
  symbol.bytes = {};
  add("silent", NodeId{0}, {});
  add("host", cluster.sensor(sensor).host, {signal, symbol, sim::processes::TriggerAct{sensor}});
  add("device", cluster.sensor(sensor).device,
      {sim::processes::StrobeAct{sensor, 7}, sim::processes::CanAct{0, {0x20, false, frame.first(8)}}});
  add("actuator", cluster.find_node("actuator").value(), {nodes::host::Actuation{TrueTime{7'000'000}, -3.25, 0.125}});
}

void capture_seeds(const fs::path& folder) {
  for (const int first_slot : {1, 20})
    for (const bool nanoseconds : {false, true}) {
      const std::array interfaces{
          recording::exports::CaptureInterface{recording::capture::LinkType::kCan, "laser_can"},
          recording::exports::CaptureInterface{recording::capture::LinkType::kFlexRay, "FlexRay"}};
      std::string pcapng, pcap;
      recording::exports::CaptureWriter writer(pcapng, interfaces, "a run");
      put(pcap, nanoseconds ? 0xa1b23c4du : 0xa1b2c3d4u);
      for (const std::uint32_t field : {0x00040002u, 0u, 0u, 65535u, 210u}) put(pcap, field);
      for (int i = 0; i < 24; ++i) {
        bus::wire::FrameHeader header;
        header.frame_id = static_cast<std::uint16_t>(first_slot + i % 3);
        header.cycle = static_cast<std::uint8_t>(i / 6);
        header.sync = header.startup = header.frame_id <= 5;
        const auto channel = static_cast<schedules::model::Channel>(i / 3 % 2);
        std::array<std::byte, bus::wire::kMaxFrameBytes> frame{};
        const std::array<std::byte, 56> payload{};
        const std::size_t size = bus::wire::encode_frame(header, channel, payload, frame);
        std::string packet;
        recording::capture::put_flexray_packet(
            packet, channel, recording::capture::check_flexray_frame(channel, std::span(frame).first(size)));
        const std::int64_t at = i / 6 * 5'000'000 + header.frame_id * 84'000;
        writer.packet(1, at, packet, i % 6 == 0 ? "measurement laser 12" : "");
        for (const std::int64_t field :
             {std::int64_t{0}, at / (nanoseconds ? 1 : 1000), static_cast<std::int64_t>(packet.size()),
              static_cast<std::int64_t>(packet.size())})
          put(pcap, static_cast<std::uint32_t>(field));
        pcap += packet;
      }
      const std::string name = "slot_" + std::to_string(first_slot) + (nanoseconds ? "_ns" : "_us");
      write(folder / "capture" / (name + "_ng"), pcapng);
      write(folder / "capture" / name, pcap);
    }
}

// Acts and fragments are any bytes; drawn ones of different lengths reach most of it.
void drawn_seeds(const fs::path& folder) {
  for (std::uint32_t i = 0; i < 40; ++i) {
    const std::string name = "drawn_" + std::to_string(i);
    std::string list = drawn_bytes(i, 2 + 70 * (i % 8));
    for (std::size_t at = 2; at < list.size(); at += 60) list[at] = static_cast<char>(list[at] | 1);
    write(folder / "list" / name, list);
    write(folder / "steps" / name, drawn_bytes(100 + i, 200 + 300 * (i % 6)));
    write(folder / "window" / name, std::to_string(i * 0.125) + "\n" + std::to_string(i * i));
  }
  // Lists of the sensors, then every node's tasks in turn: the whole way.
  for (const char cluster : {'\0', '\1'})
    for (const char strategy : {'\0', '\1', '\2'}) {
      std::string acts{cluster, strategy};
      for (std::uint32_t round = 0; round < 6; ++round) {
        for (std::uint16_t pdu = 0; pdu < 5; ++pdu) {
          acts += '\1';
          put(acts, pdu);
          put(acts, static_cast<std::uint8_t>(round));
          put(acts, std::uint16_t{6});
          acts += drawn_bytes(300 + round * 8 + pdu, 4 + 6 * 12 * 4);
        }
        for (std::uint8_t task = 0; task < 24; ++task) {
          acts += '\2';
          put(acts, task);
          put(acts, std::uint16_t{5000});
          put(acts, std::uint16_t{20000});
        }
      }
      write(folder / "steps" / ("way_" + std::to_string(cluster) + std::to_string(strategy)), acts);
    }
}

// A car that comes and goes, seen from the ground or from a host vehicle, as GroundTruth and as SensorView.
void osi_seeds(const fs::path& folder) {
  std::vector<osi3::GroundTruth> truths = recording::osi::steady(4);
  osi3::BaseMoving& base = *recording::osi::add_object(truths[1], 7, 20.0, -3.0, 3.1).mutable_base();
  base.mutable_velocity()->set_x(5.0);
  base.mutable_acceleration()->set_x(-1.0);
  base.mutable_orientation_rate()->set_yaw(0.1);
  write(folder / "osi/ground", recording::osi::framed(truths));
  std::vector<osi3::SensorView> views;
  for (osi3::GroundTruth& truth : truths) {
    recording::osi::add_object(truth, 3, 50.0, 0.0)
        .mutable_vehicle_attributes()
        ->mutable_bbcenter_to_rear()
        ->set_x(-1.4);
    truth.mutable_host_vehicle_id()->set_value(3);
    *views.emplace_back().mutable_global_ground_truth() = truth;
  }
  write(folder / "osi/host", recording::osi::framed(truths));
  write(folder / "osi/view", recording::osi::framed(views));
  const fs::path scratch = folder / "osi/channel";
  recording::mcap::McapWriter writer(scratch.string(), "", "");
  writer.add_schema(1, "osi3.GroundTruth", "protobuf", "");
  writer.add_channel(1, 1, "truth", "protobuf");
  for (const osi3::GroundTruth& truth : truths) writer.add_message(1, 0, 0, truth.SerializeAsString());
  writer.close();
}

class Payloads final : public recording::mcap::McapHandler {
 public:
  void on_metadata(std::string_view, const std::vector<std::pair<std::string, std::string>>&) override {}
  void on_attachment(std::string_view, std::string_view, std::string_view) override {}
  bool on_message(std::uint16_t channel, std::uint64_t, std::string_view payload) override {
    if (payload.size() > 0xffff) return true;
    put(messages, static_cast<std::uint8_t>(channel));
    put(messages, static_cast<std::uint16_t>(payload.size()));
    messages += payload;
    return true;
  }
  std::string messages;
};

std::string log_with(const fs::path& scratch, recording::Values values, int first_kind, int last_kind, int rounds) {
  {
    recording::log::LogManifest manifest;
    manifest.node_names = {"laser", "fusion"};
    manifest.task_names = {{"scan"}, {"fuse", "image"}};
    manifest.sensor_names = {"laser"};
    recording::log::LogWriter writer(scratch.string(), manifest);
    writer.attach("a.yaml", "application/yaml", "name: a\n");
    for (int i = 0; i < rounds; ++i)
      for (int kind = first_kind; kind <= last_kind; ++kind)
        recording::emit(writer, kind, values, static_cast<std::uint32_t>(i), std::int64_t{i} * 10'000'000);
    writer.close();
  }
  std::ifstream file(scratch, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  file.close();
  fs::remove(scratch);
  return bytes;
}

void log_seeds(const fs::path& folder) {
  using recording::Values;
  fs::create_directories(folder / "log");
  const fs::path scratch = folder / "scratch.mcap";
  const auto add = [&](const std::string& name, Values values, int first, int last, int rounds) {
    const std::string log = log_with(scratch, values, first, last, rounds);
    write(folder / "log" / name, log);
    Payloads payloads;
    recording::mcap::walk_mcap(log, payloads);
    std::string window;
    put(window, std::uint64_t{0});
    put(window, std::uint32_t{100'000});
    put(window, std::uint32_t{5'000});
    put(window, std::uint8_t{1});
    write(folder / "diagram" / name, window + payloads.messages);
    write(folder / "trace" / name, payloads.messages);
  };
  constexpr int kKinds = recording::records::kKindCount;
  add("empty", Values::kZero, 1, 0, 1);
  for (int kind = 1; kind <= kKinds; ++kind) {
    add("zero_" + std::to_string(kind), Values::kZero, kind, kind, 1);
    add("smallest_" + std::to_string(kind), Values::kSmallest, kind, kind, 1);
  }
  add("drawn", Values::kDrawn, 1, kKinds, 3);
}

// A small run's and a small experiment's results for the report.
void result_seeds(const fs::path& folder) {
  const auto interval = [](const std::string& mean, const std::string& more) {
    return R"({"count": 3, "mean": )" + mean + R"(, "half_width": 0.5)" + more + "}";
  };
  const std::string difference = ", \"difference\": " + interval("-0.25", "");
  const auto point = [&](int number, const std::string& noise) {
    return R"({"point": )" + std::to_string(number) + R"(, "axes": {"noise": ")" + noise +
           R"(", "road": "dry"}, "paradigms": {"adva": {"error": )" + interval("1", "") + R"(, "age": )" +
           interval("null", "") + R"(}, "tt": {"error": )" + interval("0.75", difference) + R"(, "age": )" +
           interval("3", difference) + "}}}";
  };
  const std::string begin = R"({"experiment": "e", "file": "e.yaml", "question": "<q>?", "seed": 1, "confidence": 0.95,
"runs": 12, "failed": 1, "baseline": "adva", "answer": "one\ntwo\n",
"measures": {"error": {"unit": "m", "meaning": "how far"}, "age": {"unit": "", "meaning": ""}},
"points": [)";
  const std::string ends = R"(], "crossings": [{"paradigm": "tt", "axis": "noise", "at": 3.5, "others": "road dry",
"certain": false}], "expectations": [{"expected": "less", "holds": false, "where_not": ["noise 1", 2]}]})";
  const std::string change = interval("-0.5", R"(, "percent": {"mean": -40, "low": -45, "high": null})");
  const std::string along = R"(, "compared_axis": "noise", "interactions": [{"measure": "error", "by": "ratio",
"axis": "noise", "from": "1 m", "to": "100 m", "lowers": "tt", "more_than": "adva", "points": [{"axes": {"road": "dry"},
"first": )" + change + R"(, "second": )" +
                            change + R"(, "interaction": )" +
                            interval("-0.1", R"(, "p": 0.04, "stays_certain": true)") + "}]}]}";
  write(folder / "answer/along", begin + point(0, "1 m") + "," + point(1, "100 m") + "]" + along);
  write(folder / "answer/grid", begin + point(0, "1 m") + "," + point(1, "100 m") + ends);
  write(folder / "answer/labels", begin + point(0, "slow") + ends);
  write_dictionary(
      folder / "answer.dict",
      {"experiment", "file",         "question",      "answer",    "baseline",      "seed",      "runs",
       "failed",     "confidence",   "points",        "axes",      "paradigms",     "count",     "mean",
       "half_width", "difference",   "measures",      "unit",      "meaning",       "crossings", "expectations",
       "where_not",  "interactions", "compared_axis", "percent",   "stays_certain", "null",      "true",
       "1e308",      "-1",           "\\\\u0000",     "</script>", "<img>",         "{}",        "[]",
       "nan",        " ms"});

  const std::string drive = R"({"strategy": "tt", "log": "out/tt.mcap", "rmse_truth": {"position_m": 0.1,
"velocity_mps": 0.7}, "nees": {"mean": 1.2, "band_95": [3.1, 5]}, "age_when_used": {"mean_ms": 60, "worst_ms": 100},
"observations": {"received": 111, "lost": 1}, "uses": 37, "objects": {"compared": 37, "missed": 2}, "slot_problems": 3,
"deadlines_missed": 1, "flexray_load": 0.29})";
  const std::string run = R"({"scenario": "drive", "seed": 7, "duration_s": 3, "strategies": [)";
  write(folder / "run_summary/one", run + drive + "]}");
  write(folder / "run_summary/three", run + drive + ",{\"strategy\": \"<b>\"}," + drive + "]}");
  write_dictionary(folder / "run_summary.dict", {"scenario",
                                                 "seed",
                                                 "duration_s",
                                                 "strategies",
                                                 "strategy",
                                                 "log",
                                                 "rmse_truth",
                                                 "position_m",
                                                 "velocity_mps",
                                                 "rmse_reference",
                                                 "nees",
                                                 "mean",
                                                 "band_95",
                                                 "age_when_used",
                                                 "mean_ms",
                                                 "worst_ms",
                                                 "observations",
                                                 "received",
                                                 "lost",
                                                 "objects",
                                                 "compared",
                                                 "missed",
                                                 "slot_problems",
                                                 "null",
                                                 "..",
                                                 "1e308",
                                                 "-1",
                                                 "</script>",
                                                 "{}",
                                                 "[]"});

  const std::string head = "point,noise,road,paradigm,measure,count,mean,half_width,difference,difference_half_width\n";
  std::string rows;
  for (const char* at : {"0,1 m,dry", "1,100 m,dry", "2,1 m,icy", "3,100 m,icy"})
    for (const char* of : {",adva,nees,3,1,0.5,,", ",tt,nees,3,2,,-1,0.5", ",adva,age,3,,,,", ",tt,age,3,4,1,2,1"})
      rows += std::string(at) + of + "\n";
  write(folder / "paper/grid", head + rows);
  write(folder / "paper/one",
        "point,paradigm,measure,count,mean,half_width,difference,difference_half_width\n"
        "0,\"a \"\"b\"\"\",nees,1,2,,,\n");
  write_dictionary(folder / "paper.dict", {"point", "paradigm", "measure", "count", "mean", "half_width", "difference",
                                           "difference_half_width", "nees", "e308", "nan", "-", "\\x22", "\\x60", "#",
                                           " ms", "\\x0d\\x0a", ",,"});

  const fs::path path = folder / "store/small";
  fs::create_directories(path.parent_path());
  experiments::results::Store store = experiments::results::Store::create(path, {"e", "id", "1", "name: e", {"m"}});
  store.add({{{0, 0, 0}, experiments::results::kDone, {1.0}},
             {{0, 0, 1}, experiments::results::kDone, {2.0}},
             {{0, 1, 0}, "went <wrong>", {2.5}},
             {{0, 1, 1}, experiments::results::kDone, {3.0}},
             {{7, 1, 9}, "of nobody", {4.0}}});
}

void task_set_seeds(const fs::path& folder) {
  for (const std::string name : {"braking", "let", "buses"})
    write(folder / "task_set" / name, fuzz::shipped("schedules/task_sets/" + name + ".csv"));
  write_dictionary(folder / "task_set.dict",
                   {"processor", "bus",          "task",  "message",    "chain",  "preemptive", "non_preemptive",
                    "can",       "can_extended", "table", "implicit",   "let",    "event",      " > ",
                    "1000 s",    "1 us",         "1 ns",  "999.983 ms", "500000", "10000",      "dynamic",
                    "tdma",      "turn",         "start", "1/4",        "30/s"});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const fs::path folder = argv[1];
  fs::remove_all(folder);
  yaml_seeds(folder, "cluster", "schedules",
             {"paper_synchronised", "paper_unsynchronised", "laser_radar", "laser_radar_synchronised", "flexray_demo",
              "paper_free_flexray"});
  yaml_seeds(
      folder, "plan", "schedules/plans",
      {"paper_laser", "paper", "paper_payload", "paper_short_scans", "paper_sixty_cycles", "paper_two_lasers_radar"});
  yaml_seeds(folder, "scenario", "scenarios",
             {"paper_scenario1", "paper_scenario2", "laser_radar_recorded", "faulty_bus", "cold_start"});
  fibex_seeds(folder);
  recorded_seeds(folder);
  osi_seeds(folder);
  observation_seeds(folder);
  signal_seeds(folder);
  frame_seeds(folder);
  turn_seeds(folder);
  flexray_on_can_seeds(folder);
  live_seeds(folder);
  capture_seeds(folder);
  drawn_seeds(folder);
  task_set_seeds(folder);
  log_seeds(folder);
  result_seeds(folder);
  return 0;
}
