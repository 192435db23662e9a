// Every key of every loader has a description, and every description a key. The committed pages and schemas are those
// that the program prints.
#include "keys/documents.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "core/file_bytes.h"
#include "core/file_kind.h"
#include "keys/render.h"
#include "keys/rows.h"
#include "keys/value_words.h"

namespace ttf::keys {
namespace {

const Outline& outline_of(const Document& document) {
  static std::map<std::string, Outline> found;
  if (!found.contains(document.kind)) found[document.kind] = outline(explore(document.load));
  return found[document.kind];
}

bool is_value(KeyType type) {
  return type != KeyType::kMap && type != KeyType::kMaps && type != KeyType::kNamedMaps && type != KeyType::kNamedTexts;
}

TEST(Documents, EveryKeyHasADescription) {
  for (const Document& document : documents())
    for (const Row& row : rows_of(document, outline_of(document)))
      EXPECT_NE(row.description, nullptr)
          << document.kind << ": describe " << row.path << " " << row.only_with << " in keys/describe_*.cc";
}

TEST(Documents, EveryDescriptionHasAKey) {
  std::set<const Description*> used;
  for (const Document& document : documents())
    for (const Row& row : rows_of(document, outline_of(document))) used.insert(row.description);
  for (const Document& document : documents())
    for (const Chapter& chapter : document.chapters)
      for (const Description& description : chapter.rows)
        EXPECT_TRUE(used.contains(&description)) << document.kind << ": no loader reads " << chapter.place << " "
                                                 << description.key << " " << description.when;
}

// `like` may supply a sensor's key, but not that of a node.
TEST(Documents, ARequiredKeyMayBeSupplied) {
  const auto& cluster =
      *std::find_if(documents().begin(), documents().end(), [](const auto& one) { return one.kind == "cluster"; });
  std::map<std::string, std::string> needs;
  for (const Row& row : rows_of(cluster, outline_of(cluster)))
    needs[row.path] = need_words(row.key, row.may_be_alike, "`");
  EXPECT_EQ(needs["sensors.NAME.kind"], "required without `like`");
  EXPECT_EQ(needs["pdus.NAME.header"], "required without `like`");
  EXPECT_EQ(needs["pdus.NAME.header[].name"], "required");
  EXPECT_EQ(needs["nodes.NAME.tasks"], "required");
  EXPECT_EQ(needs["sensors.NAME.like"], "optional");
}

TEST(Documents, AMeaningIsOneSentence) {
  for (const Document& document : documents())
    for (const Row& row : rows_of(document, outline_of(document))) {
      if (row.description == nullptr) continue;
      const std::string_view meaning = row.description->meaning;
      EXPECT_TRUE(meaning.ends_with('.')) << meaning;
      EXPECT_EQ(meaning.find(". "), std::string_view::npos) << meaning;
      EXPECT_LE(meaning.size(), 200u) << meaning;
    }
}

TEST(Documents, AKeyWithoutADefaultHasAnExample) {
  for (const Document& document : documents())
    for (const Row& row : rows_of(document, outline_of(document))) {
      if (row.description == nullptr || !is_value(row.key.question.type) || default_text(row.key)) continue;
      if (row.key.question.type == KeyType::kBoolean || !row.key.default_by.empty()) continue;
      EXPECT_FALSE(row.description->example.empty()) << document.kind << ": " << row.path << " " << row.only_with;
    }
}

// core/file_kind.h distinguishes kinds by keys; the loaders have the last word on them.
TEST(Documents, TheKindOfAFileFollowsFromItsOwnKeys) {
  const std::map<FileKind, std::string> kinds{{FileKind::kScenario, "scenario"},
                                              {FileKind::kCluster, "cluster"},
                                              {FileKind::kExperiment, "experiment"},
                                              {FileKind::kTrack, "track"},
                                              {FileKind::kFaults, "faults"}};
  ASSERT_EQ(kinds.size() + 1, documents().size()) << "a plan is a cluster file with one key more";
  std::map<std::string, std::set<std::string>> known;  // key, kinds
  std::set<std::string> of_plans;
  for (const Document& document : documents())
    for (const Case& one : outline_of(document).find("")->cases)
      for (const Key& key : one.keys)
        if (document.kind == "plan")
          of_plans.insert(key.question.key);
        else
          known[key.question.key].insert(document.kind);
  EXPECT_TRUE(of_plans.contains("plan"));
  EXPECT_FALSE(known.contains("plan"));
  for (const auto& [key, of] : known) EXPECT_EQ(of_plans.contains(key), of.contains("cluster")) << key;
  std::set<FileKind> reported;
  for (const auto& [key, of] : known) {
    // Beside a key that no kind has, only a kind's own keys identify it.
    const auto kind = kind_of(StrictYaml::parse(key + ": 1\nno_key: 1\n", "key.yaml"));
    if (!kind) continue;
    reported.insert(*kind);
    EXPECT_EQ(of, std::set{kinds.at(*kind)}) << key;
  }
  EXPECT_EQ(reported.size(), 4u) << "a fault list has no key of its own";
}

TEST(Documents, ShippedFilesAreOfTheirKind) {
  for (const auto& [folder, kind] :
       {std::pair{"scenarios", FileKind::kScenario}, std::pair{"schedules", FileKind::kCluster},
        std::pair{"schedules/plans", FileKind::kCluster}, std::pair{"experiments", FileKind::kExperiment},
        std::pair{"experiments/faults", FileKind::kFaults}})
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(TTF_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".yaml") {
        EXPECT_EQ(kind_of(StrictYaml::load(entry.path().string())), kind) << entry.path();
      }
}

void expect_committed(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(TTF_SOURCE_DIR) / file;
  ASSERT_TRUE(std::filesystem::exists(path)) << file << " is not there: tools/update_keys.sh writes it";
  EXPECT_EQ(read_file(path.string()), text) << file << " is another: tools/update_keys.sh writes it anew";
}

TEST(Documents, PagesAndSchemasAreThoseInTheTree) {
  // tests/cli/keys_command_test.sh compares those of summary.json.
  std::set<std::string> files{"README.md", "summary.md", "summary_faults.md", "summary.schema.json"};
  for (const Document& document : documents()) {
    for (const Page& page : markdown_pages(document, outline_of(document))) {
      expect_committed(std::filesystem::path("docs/keys") / page.file, page.text);
      files.insert(page.file);
    }
    expect_committed(std::filesystem::path("keys/schemas") / schema_file(document),
                     json_schema(document, outline_of(document)));
    files.insert(schema_file(document));
  }
  for (const char* folder : {"docs/keys", "keys/schemas"})
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(TTF_SOURCE_DIR) / folder)) {
      EXPECT_TRUE(files.contains(entry.path().filename().string())) << entry.path() << " belongs to no document";
      const std::string text = read_file(entry.path().string());
      if (entry.path().extension() == ".md") {
        EXPECT_LE(std::ranges::count(text, '\n'), static_cast<std::ptrdiff_t>(kMostLines)) << entry.path();
      }
    }
}

}  // namespace
}  // namespace ttf::keys
