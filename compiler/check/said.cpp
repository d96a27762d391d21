#include "compiler/check/said.h"

#include <algorithm>
#include <array>

#include "compiler/define/template.h"
#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

// Whether a name begins at a word; its noun may be in the plural.
bool begins(const std::vector<std::string>& name, const std::vector<Said::Word>& words,
            std::size_t at) {
  if (name.empty() || at + name.size() > words.size()) return false;
  for (std::size_t k = 0; k + 1 < name.size(); ++k) {
    if (words[at + k].text != name[k]) return false;
  }
  const std::string& noun = words[at + name.size() - 1].text;
  return !noun.empty() && is_same_noun(noun, name.back());
}

}  // namespace

std::vector<Said::Word> words_in(std::string_view text) {
  constexpr std::string_view kSigns = ".,;:!?()\"'";
  std::vector<Said::Word> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    std::string_view word = text.substr(at, end - at);
    at = end;
    const std::size_t begin = word.find_first_not_of(kSigns);
    if (begin == word.npos) continue;
    const std::size_t last = word.find_last_not_of(kSigns);
    words.push_back({.text = fold_case(word.substr(begin, last + 1 - begin)),
                     .of = {},
                     .ends = last + 1 < word.size()});
  }
  return words;
}

bool may_follow_noun(std::string_view word) {
  constexpr auto kAfter = std::to_array<std::string_view>(
      {"in",      "into",  "inside", "on",      "onto",  "to",     "towards", "from",   "of",
       "off",     "over",  "under",  "above",   "below", "behind", "beside",  "near",   "with",
       "without", "by",    "at",     "between", "and",   "or",     "not",     "than",   "up",
       "down",    "then",  "first",  "before",  "after", "while",  "until",   "around", "against",
       "is",      "as",    "so",     "that",    "where", "when",   "instead", "please", "alone",
       "away",    "there", "but",    "should"});
  return std::find(kAfter.begin(), kAfter.end(), word) != kAfter.end();
}

std::vector<std::string> folded_words(std::string_view text) {
  std::vector<std::string> words;
  for (Said::Word& word : words_in(text)) words.push_back(std::move(word.text));
  return words;
}

std::vector<ObjectId> nameable(const Model& model, const Task& task) {
  std::vector<ObjectId> found = task.objects();
  for (const FixtureId id : model.scenes[task.scene].fixtures) {
    for (const Fixture::Part& part : model.fixtures[id].parts) {
      if (part.declared && part.thing != ObjectId::kNone) found.push_back(part.thing);
    }
  }
  return found;
}

std::optional<std::size_t> Said::first(ObjectId thing) const {
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].of.contains(thing)) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> Said::find(std::string_view written, std::size_t from) const {
  const std::vector<std::string> wanted = folded_words(written);
  for (std::size_t i = from; i + wanted.size() <= words.size(); ++i) {
    std::size_t k = 0;
    while (k < wanted.size() && words[i + k].text == wanted[k]) ++k;
    if (k == wanted.size()) return i;
  }
  return std::nullopt;
}

Said said_by(const Model& model, const Task& task) {
  Said said;
  const Template& say = model.templates[task.say];
  for (const Template::Part& part : say.parts) {
    if (part.slot) {
      const auto meant = meant_by(model, task, say, *part.slot);
      said.words.push_back({.text = {}, .of = Things(meant.begin(), meant.end()), .ends = false});
      continue;
    }
    for (Said::Word& word : words_in(part.literal)) said.words.push_back(std::move(word));
  }
  struct Nameable {
    ObjectId thing;
    std::vector<std::string> name;
  };
  std::vector<Nameable> called;
  for (const ObjectId id : nameable(model, task))
    called.push_back({id, folded_words(model.objects[id].text.text)});
  for (std::size_t i = 0; i < said.words.size(); ++i) {
    Things whole, ends;
    for (const auto& [thing, name] : called) {
      if (begins(name, said.words, i)) whole.insert(thing);
      if (!name.empty() && begins({name.back()}, said.words, i)) ends.insert(thing);
    }
    if (!whole.empty()) {
      said.words[i].of.merge(whole);
    } else if (ends.size() == 1) {
      said.words[i].of.merge(ends);
    }
  }
  return said;
}

}  // namespace probe::sema
