#include "cli/supervision/launch_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <stdexcept>

#include "core/errors.h"
#include "tests/cli/supervision/launch_fixture.h"
#include "tests/support/refusals.h"

namespace ttf::cli::supervision {
namespace {

using nlohmann::json;

class Folder : public Launching {
 protected:
  // After the beginning of 2026.
  static WallInstant at(std::int64_t ms) { return WallInstant(std::chrono::milliseconds(1'767'225'600'000 + ms)); }
  json manifest() const { return json::parse(contents(path("run/manifest.json"))); }
};

TEST_F(Folder, SaysFromTheStartWhatItIs) {
  LaunchFolder run(path("run"), {{"scenario", "s.yaml"}, {"seed", 7}}, at(1));
  const json first = manifest();
  EXPECT_EQ(first["scenario"], "s.yaml");
  EXPECT_EQ(first["seed"], 7);
  EXPECT_EQ(first["state"], "starting");
  EXPECT_EQ(first["began"], "2026-01-01T00:00:00.001Z");
  EXPECT_TRUE(first["ended"].is_null());
  EXPECT_TRUE(first["exit_code"].is_null());
}

TEST_F(Folder, ListsEveryProcess) {
  LaunchFolder run(path("run"), {{"seed", 7}}, at(0));
  const auto fusion = run.add_node({"fusion", "restart", {"ttfusion", "node", "fusion"}});
  const auto lost = run.add_node({"lost", "optional", {"nothing"}});
  run.process_began(fusion, 100, at(10));
  run.process_ended(fusion, {true, 9}, at(20));
  run.process_began(fusion, 101, at(30));
  run.process_ended(lost, {false, 127}, at(40), "nothing: cannot be started");
  run.state("running");
  run.write();
  const json half = manifest();
  EXPECT_EQ(half["state"], "running");
  EXPECT_EQ(half["nodes"][0]["command"], (json{"ttfusion", "node", "fusion"}));
  EXPECT_EQ(half["nodes"][0]["policy"], "restart");
  EXPECT_EQ(half["nodes"][0]["log"], "fusion.mcap");
  EXPECT_EQ(half["nodes"][0]["output"], "fusion.txt");
  const json killed{{"pid", 100},
                    {"began", "2026-01-01T00:00:00.010Z"},
                    {"ended", "2026-01-01T00:00:00.020Z"},
                    {"exit", nullptr},
                    {"signal", 9}};
  EXPECT_EQ(half["nodes"][0]["processes"][0], killed);
  EXPECT_TRUE(half["nodes"][0]["processes"][1]["ended"].is_null());
  EXPECT_TRUE(half["nodes"][1]["processes"][0]["pid"].is_null());
  EXPECT_EQ(half["nodes"][1]["processes"][0]["exit"], 127);
  EXPECT_EQ(half["nodes"][1]["processes"][0]["why"], "nothing: cannot be started");
  run.process_ended(fusion, {false, 0}, at(50));
  run.finish(3, "because", at(60));
  const json whole = manifest();
  EXPECT_EQ(whole["state"], "ended");
  EXPECT_EQ(whole["exit_code"], 3);
  EXPECT_EQ(whole["why"], "because");
  EXPECT_EQ(whole["ended"], "2026-01-01T00:00:00.060Z");
  EXPECT_EQ(whole["nodes"][0]["processes"][1]["exit"], 0);
  EXPECT_FALSE(std::filesystem::exists(path("run/manifest.json.new")));
}

TEST_F(Folder, KeepsOutputAsItIs) {
  LaunchFolder run(path("run"), json::object(), at(0));
  const auto node = run.add_node({"a", "required", {"a"}});
  run.output(node, std::string_view("\x00\x1b\xff", 3));
  run.output(node, "more\r\n");
  EXPECT_EQ(contents(path("run/a.txt")), std::string("\x00\x1b\xffmore\r\n", 9));
}

TEST_F(Folder, IsLeftByNoName) {
  EXPECT_EQ(file_stem("laser_pre-2.b"), "laser_pre-2.b");
  EXPECT_EQ(file_stem("../x"), "%2E.%2Fx");
  EXPECT_EQ(file_stem(".."), "%2E%2E");
  EXPECT_EQ(file_stem("a%2Fb"), "a%252Fb");
  EXPECT_EQ(file_stem("a b\n"), "a%20b%0A");
  EXPECT_EQ(file_stem("\xc3\xbc"), "%C3%BC");
  EXPECT_EQ(file_stem(""), "%");
}

TEST_F(Folder, TakesNamesThatAreNoText) {
  LaunchFolder run(path("run"), json::object(), at(0));
  run.add_node({"\xff", "required", {"\xfe"}});
  run.write();
  EXPECT_EQ(manifest()["nodes"][0]["output"], "%FF.txt");
}

TEST_F(Folder, ListsItsProcesses) {
  EXPECT_FALSE(earlier_launch(path("run")));
  {
    LaunchFolder run(path("run"), {{"strategy", "adva"}}, at(0));
    run.add_node({"a/b", "required", {"a"}});
    run.add_node({"c", "required", {"c"}});
    run.finish(0, "", at(1));
  }
  const auto earlier = earlier_launch(path("run"));
  ASSERT_TRUE(earlier);
  EXPECT_EQ(earlier->strategy, "adva");
  EXPECT_EQ(earlier->nodes, (std::vector<std::string>{"a/b", "c"}));
  // Manifests that no launch wrote.
  for (const char* const other : {"", "{", "[]", "7", "{}", R"({"nodes": 3})"}) {
    std::ofstream(path("run/manifest.json")) << other;
    EXPECT_FALSE(earlier_launch(path("run"))) << other;
  }
  std::ofstream(path("run/manifest.json")) << R"({"strategy": 3, "nodes": [1, {"name": 2}, {"name": "d"}]})";
  const auto odd = earlier_launch(path("run"));
  ASSERT_TRUE(odd);
  EXPECT_EQ(odd->strategy, "");
  EXPECT_EQ(odd->nodes, std::vector<std::string>{"d"});
  // File names contain it.
  std::ofstream(path("run/manifest.json")) << R"({"strategy": "../elsewhere/buff", "nodes": []})";
  EXPECT_EQ(earlier_launch(path("run"))->strategy, "");
}

TEST_F(Folder, RemovesPlainFilesOnly) {
  const LaunchFolder run(path("run"), json::object(), at(0));
  std::ofstream(path("run/truth.mcap")) << "old";
  std::filesystem::create_directory(path("run/summary.json"));
  for (const char* const name : {"truth.mcap", "summary.json", "nothing"}) EXPECT_NO_THROW(run.remove(name));
  EXPECT_FALSE(std::filesystem::exists(path("run/truth.mcap")));
  EXPECT_TRUE(std::filesystem::is_directory(path("run/summary.json")));
}

TEST_F(Folder, SaysWhyItCannotBe) {
  std::ofstream(path("file")) << "x";
  try {
    LaunchFolder run(path("file/run"), json::object(), at(0));
    FAIL() << "a folder within a file";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(dynamic_cast<const InputError*>(&error), nullptr) << "what cannot be written is no input";
    EXPECT_NE(std::string(error.what()).find("file/run: cannot be created: Not a directory"), std::string::npos)
        << error.what();
  }
}

TEST_F(Folder, IsOfOneLaunchAtATime) {
  const auto sentence_of = [&](const std::function<void()>& taken) -> std::string {
    return support::refusal_of([&] { taken(); });
  };
  const auto another = [&] { LaunchFolder(path("run"), {{"seed", 8}}, at(1)); };
  const auto look = [&] { FolderLock::refuse_if_held(path("run")); };
  EXPECT_EQ(sentence_of(look), "");
  EXPECT_FALSE(std::filesystem::exists(path("run")));
  const std::string expected = fmt::format(
      "command line: --out = {}: must be another folder: a running launch uses it, process {}", path("run"), getpid());
  {
    const LaunchFolder run(path("run"), {{"seed", 7}}, at(0));
    EXPECT_EQ(sentence_of(another), expected);
    EXPECT_EQ(sentence_of(look), expected);
    EXPECT_EQ(manifest()["seed"], 7) << "written over by who was refused";
  }
  // The remaining file has no meaning.
  EXPECT_TRUE(std::filesystem::exists(path("run/launch.lock")));
  EXPECT_EQ(sentence_of(look), "");
  EXPECT_EQ(sentence_of(another), "");
  EXPECT_EQ(manifest()["seed"], 8);
}

}  // namespace
}  // namespace ttf::cli::supervision
