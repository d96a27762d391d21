#include "compiler/check/noun_words.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/check.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

// Words behind a noun that may say which one is meant.
bool says_which(std::string_view word) {
  constexpr auto kSaysMore = std::to_array<std::string_view>(
      {"of",   "from",   "on",      "in",     "at",   "under", "above",   "below",
       "with", "that",   "which",   "whose",  "to",   "near",  "nearest", "closest",
       "next", "beside", "between", "behind", "left", "right"});
  return std::find(kSaysMore.begin(), kSaysMore.end(), word) != kSaysMore.end();
}

// "Put the can on the plate": behind what is put stands where to, not which.
bool says_where_to(const std::vector<Said::Word>& words, std::size_t noun, std::size_t behind) {
  constexpr auto kPuts = std::to_array<std::string_view>(
      {"put", "place", "move", "set", "lay", "drop", "stack", "bring", "rest", "transfer"});
  constexpr auto kTo = std::to_array<std::string_view>({"on", "in", "to"});
  return noun == 2 && std::find(kPuts.begin(), kPuts.end(), words[0].text) != kPuts.end() &&
         std::find(kTo.begin(), kTo.end(), words[behind].text) != kTo.end();
}

std::vector<std::string> name_of(const Model& model, ObjectId id) {
  return folded_words(model.objects[id].text.text);
}

// Whether the names of two objects of the task end with one noun: "coke can", "pepsi can".
bool has_shared_noun(const Model& model, const Task& task) {
  std::set<std::string> nouns;
  const std::vector<ObjectId> there = task.objects();
  return !std::all_of(there.begin(), there.end(), [&](ObjectId id) {
    const std::vector<std::string> name = name_of(model, id);
    return name.empty() || nouns.insert(name.back()).second;
  });
}

// Only what is written out can leave open which is meant, and only "the": slots say themselves.
bool says_the(const Template& say) {
  return std::any_of(say.parts.begin(), say.parts.end(), [](const Template::Part& part) {
    return has_words(fold_case(part.literal), "the");
  });
}

struct Noun {
  std::size_t end = 0;  // of its words, in the instruction
  std::vector<ObjectId> called;
};

// The objects that "the ..." at these words may mean by their whole name or, where none is called
// so, by the noun at the end of it. The noun of something else ("the can opener") means none.
Noun noun_at(const Model& model, const Task& task, const std::vector<Said::Word>& words,
             std::size_t at) {
  Noun whole, last;
  last.end = at + 1;
  for (const ObjectId id : task.objects()) {
    const std::vector<std::string> name = name_of(model, id);
    if (name.empty()) continue;
    if (name.back() == words[at].text) last.called.push_back(id);
    const bool fits =
        at + name.size() <= words.size() &&
        std::equal(name.begin(), name.end(), words.begin() + static_cast<std::ptrdiff_t>(at),
                   [](const std::string& one, const Said::Word& word) { return one == word.text; });
    if (!fits || at + name.size() < whole.end) continue;
    if (at + name.size() > whole.end) whole = {at + name.size(), {}};
    whole.called.push_back(id);
  }
  if (!whole.called.empty()) return whole;
  const bool is_noun =
      words[at].ends || last.end == words.size() || may_follow_noun(words[last.end].text);
  return is_noun ? last : Noun{};
}

// Whether another word says which of them: "take the coke can and put the can on the plate".
bool is_told_apart(const std::vector<Said::Word>& words, const std::vector<ObjectId>& called) {
  return std::any_of(words.begin(), words.end(), [&](const Said::Word& word) {
    return word.of.size() == 1 &&
           std::find(called.begin(), called.end(), *word.of.begin()) != called.end();
  });
}

std::string names_of(const Model& model, const std::vector<ObjectId>& ids) {
  std::string names;
  for (const ObjectId id : ids)
    names += (names.empty() ? "`" : ", `") + model.objects[id].name + "`";
  return names;
}

// "put the can on the plate" where three are called so, or a coke can and a pepsi can stand: P0402,
// as of a phrase.
bool leaves_object_open(const Model& model, const Task& task, const Said& said,
                        Reporter& reporter) {
  if (!says_the(model.templates[task.say]) || !has_shared_noun(model, task)) return false;
  const auto& words = said.words;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].text.empty() || words[i - 1].text != "the") continue;
    const auto [next, called] = noun_at(model, task, words, i);
    if (called.size() < 2) continue;
    // "The can nearest to the plate", "the can that lies": P1203's, or told by more words.
    if (next < words.size() && !words[next - 1].ends && says_which(words[next].text) &&
        !says_where_to(words, i, next))
      continue;
    const bool is_whole = next > i + 1 || name_of(model, called.front()).size() == 1;
    if (!is_whole && is_told_apart(words, called)) continue;
    std::string name;
    for (std::size_t k = i; k < next; ++k) name += " " + words[k].text;
    report_of(reporter, Code::P0402, task, task.say_span,
              "\"the" + name + "\" denotes " + std::to_string(called.size()) + " objects in `" +
                  task.name + "`")
        .label(model.templates[task.say].span, "said here")
        .help("they are " + names_of(model, called) +
              ": say which by its whole name, or by a phrase of the one that is meant");
    return true;
  }
  return false;
}

// "open the drawer" where the scene has three: P0402, as of a phrase. Which one is meant may be
// said elsewhere, or behind it.
bool leaves_part_open(const Model& model, const Task& task, const Said& said, Reporter& reporter) {
  const auto& words = said.words;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& noun = words[i].text;
    if (noun.empty() || (i != 1 && words[i - 1].text != "the")) continue;
    if (i + 1 < words.size() && says_which(words[i + 1].text)) continue;
    std::vector<ObjectId> parts;
    for (const ObjectId id : nameable(model, task)) {
      const Object& thing = model.objects[id];
      const std::vector<std::string> name = folded_words(thing.text.text);
      if (thing.of && !name.empty() && name.back() == noun) parts.push_back(id);
    }
    if (parts.size() < 2) continue;
    if (is_told_apart(words, parts)) continue;
    report_of(reporter, Code::P0402, task, task.say_span,
              "\"" + noun + "\" denotes " + std::to_string(parts.size()) +
                  " parts of fixtures in `" + task.name + "`")
        .label(model.templates[task.say].span, "said here")
        .help("they are " + names_of(model, parts) + ": say \"" +
              model.objects[parts.front()].text.text +
              "\", or `{the target}` of a task that is about one");
    return true;
  }
  return false;
}

}  // namespace

bool has_nouns_of_several(const Model& model, const Task& task) {
  return !model.scenes[task.scene].fixtures.empty() ||
         (says_the(model.templates[task.say]) && has_shared_noun(model, task));
}

bool leaves_noun_open(const Model& model, const Task& task, const Said& said, Reporter& reporter) {
  const bool has_fixtures = !model.scenes[task.scene].fixtures.empty();
  return (has_fixtures && leaves_part_open(model, task, said, reporter)) ||
         leaves_object_open(model, task, said, reporter);
}

}  // namespace probe::sema
