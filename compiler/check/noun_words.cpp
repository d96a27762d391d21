#include "compiler/check/noun_words.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/check.h"

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

// Whether two objects of the task have one name.
bool has_shared_name(const Model& model, const Task& task) {
  std::set<std::string_view> names;
  const std::vector<ObjectId> there = task.objects();
  return !std::all_of(there.begin(), there.end(), [&](ObjectId id) {
    return names.insert(model.objects[id].text.text).second;
  });
}

// "put the can on the plate" where three are called so: P0402, as of a phrase.
bool leaves_object_open(const Model& model, const Task& task, const Said& said,
                        Reporter& reporter) {
  if (!has_shared_name(model, task)) return false;
  const auto& words = said.words;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].text.empty() || words[i - 1].text != "the") continue;
    std::vector<ObjectId> called;
    for (const ObjectId id : task.objects()) {
      const std::vector<std::string> name = folded_words(model.objects[id].text.text);
      const bool is_called =
          !name.empty() && i + name.size() <= words.size() &&
          std::equal(
              name.begin(), name.end(), words.begin() + static_cast<std::ptrdiff_t>(i),
              [](const std::string& one, const Said::Word& word) { return one == word.text; });
      if (is_called) called.push_back(id);
    }
    if (called.size() < 2) continue;
    const std::string& name = model.objects[called.front()].text.text;
    // "The can nearest to the plate", "the can that lies": P1203's, or told by more words.
    const std::size_t next = i + folded_words(name).size();
    if (next < words.size() && says_which(words[next].text) && !says_where_to(words, i, next))
      continue;
    std::string names;
    for (const ObjectId id : called)
      names += (names.empty() ? "`" : ", `") + model.objects[id].name + "`";
    report_of(reporter, Code::P0402, task, task.say_span,
              "\"the " + name + "\" denotes " + std::to_string(called.size()) + " objects in `" +
                  task.name + "`")
        .label(model.templates[task.say].span, "said here")
        .help("they are " + names + ": say which by a phrase of the one that is meant");
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
    const bool is_told_apart = std::any_of(words.begin(), words.end(), [&](const Said::Word& word) {
      return word.of.size() == 1 &&
             std::find(parts.begin(), parts.end(), *word.of.begin()) != parts.end();
    });
    if (is_told_apart) continue;
    std::string names;
    for (const ObjectId id : parts)
      names += (names.empty() ? "`" : ", `") + model.objects[id].name + "`";
    report_of(reporter, Code::P0402, task, task.say_span,
              "\"" + noun + "\" denotes " + std::to_string(parts.size()) +
                  " parts of fixtures in `" + task.name + "`")
        .label(model.templates[task.say].span, "said here")
        .help("they are " + names + ": say \"" + model.objects[parts.front()].text.text +
              "\", or `{the target}` of a task that is about one");
    return true;
  }
  return false;
}

}  // namespace

bool has_nouns_of_several(const Model& model, const Task& task) {
  return !model.scenes[task.scene].fixtures.empty() || has_shared_name(model, task);
}

bool leaves_noun_open(const Model& model, const Task& task, const Said& said, Reporter& reporter) {
  const bool has_fixtures = !model.scenes[task.scene].fixtures.empty();
  return (has_fixtures && leaves_part_open(model, task, said, reporter)) ||
         leaves_object_open(model, task, said, reporter);
}

}  // namespace probe::sema
