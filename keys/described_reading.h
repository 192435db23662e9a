// One reading of a described file (StrictYaml::described): answers a loader's questions and notes them.
//
//   DescribedReading reading({{"startup.kind", std::int64_t{1}}});
//   load(StrictYaml::described(reading));
//   for (const auto& [path, map] : reading.maps()) ...   // the keys of each mapping that was asked for
//
// A question is a decision if its answer may change the next questions. Its name is the key's path, followed by "?" for
// has() and by "{}" for map_or_word(). A reading may be given answers by these names. The usual answers are true for
// has() and map_or_word(), the fallback, or else false, the first word and the least number.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/key_question.h"

namespace ttf::keys {

class DescribedReading final : public KeyAnswers {
 public:
  using Answers = std::map<std::string, KeyValue>;
  enum class Numbers : unsigned char { kUsual, kLeast, kLargest };  // for questions without an answer of their own

  struct Decision {
    std::string name;
    KeyQuestion question;
    KeyValue answer;
  };
  struct Map {
    std::vector<std::string> known;      // keys that were asked for, in that order
    std::vector<KeyQuestion> questions;  // the first one for the value of each key
  };

  explicit DescribedReading(Answers answers = {}, Numbers numbers = Numbers::kUsual);

  KeyValue answer(const KeyQuestion& question) override;

  const std::map<std::string, Map>& maps() const { return maps_; }  // by their path
  const std::vector<std::string>& order() const { return order_; }  // the maps' order, as they came
  // Only a reading with the usual numbers has any.
  const std::vector<Decision>& decisions() const { return decisions_; }

 private:
  KeyValue decide(const std::string& name, const KeyQuestion& question, KeyValue usual);
  KeyValue number(const KeyQuestion& question) const;

  Answers answers_;
  Numbers numbers_;
  std::map<std::string, Map> maps_;
  std::vector<std::string> order_;
  std::vector<Decision> decisions_;
  std::set<std::string> decided_;                    // their names
  std::set<std::string> required_;                   // paths of keys that were read without asking for them
  std::set<std::string> asked_for_;                  // paths of keys that has() was asked for
  std::map<std::string, std::string> chosen_words_;  // by path
};

}  // namespace ttf::keys
