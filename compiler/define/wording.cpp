#include "compiler/define/wording.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "compiler/define/telling.h"
#include "compiler/model/same.h"
#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

// A word of an instruction, or the object that a slot stands for.
struct Word {
  std::string_view text;
  bool is_object = false;
  bool is_other = false;  // those of a set that were not said before
  bool operator==(const Word&) const = default;
};

using Pair = std::pair<std::string_view, std::string_view>;

// Where one of a pair is said and the other is not, another thing is asked for.
constexpr auto kOpposites = std::to_array<Pair>({{"left", "right"},
                                                 {"leftmost", "rightmost"},
                                                 {"leftward", "rightward"},
                                                 {"clockwise", "counterclockwise"},
                                                 {"clockwise", "anticlockwise"},
                                                 {"front", "behind"},
                                                 {"front", "back"},
                                                 {"nearest", "farthest"},
                                                 {"closest", "farthest"},
                                                 {"closest", "furthest"},
                                                 {"inside", "outside"},
                                                 {"open", "close"},
                                                 {"push", "pull"},
                                                 {"larger", "smaller"},
                                                 {"bigger", "smaller"}});

// These have other uses ("on top" of what is "at the bottom"), so they count only where the rest is
// the same, word by word.
constexpr auto kOppositesInPlace = std::to_array<Pair>(
    {{"above", "below"},  {"above", "under"},  {"over", "under"},  {"on", "under"},
     {"on", "below"},     {"on", "beside"},    {"on", "near"},     {"on", "behind"},
     {"onto", "under"},   {"in", "on"},        {"into", "onto"},   {"into", "behind"},
     {"on", "off"},       {"onto", "off"},     {"in", "out"},      {"to", "from"},
     {"up", "down"},      {"top", "bottom"},   {"upper", "lower"}, {"near", "far"},
     {"towards", "away"}, {"before", "after"}, {"first", "last"},  {"with", "without"},
     {"and", "or"}});

bool is_pair(const auto& pairs, std::string_view a, std::string_view b) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
  });
}

bool has(const std::vector<Word>& words, std::string_view text) {
  return std::any_of(words.begin(), words.end(),
                     [&](const Word& word) { return !word.is_object && word.text == text; });
}

// As they are written, but for articles.
std::vector<std::string> literal_words(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    std::string word = text.substr(at, end - at);
    if (!is_article(word)) words.push_back(std::move(word));
    at = end;
  }
  return words;
}

enum class Form { kWritten, kPlain };

// The words with their signs and in their case, or without, but for articles; `{the source}` is one
// of them, whatever words are chosen for it. Views into the model.
std::vector<Word> words_of(const Model& model, const Task& task, Form form) {
  const Template& say = model.templates[task.say];
  std::vector<Word> words;
  std::size_t most = 0;
  for (const Template::Part& part : say.parts) most += part.slot ? 2 : part.words.size();
  words.reserve(most);
  for (const Template::Part& part : say.parts) {
    if (part.slot) {
      // One that fills a role is that role, however the text names it.
      const SlotRef& slot = *part.slot;
      const bool has_role = slot.role != RoleId::kNone;
      const std::string& name = has_role ? slot.name.text : role_word(model, task, slot.name.text);
      const bool is_other = has_role && slot.count == syntax::SlotCount::kOther;
      words.push_back({name, true, is_other});
      // Words that count are words of their own. Of a set `{both goods}` and `{the goods}` are
      // other words for the same.
      if (slot.count == syntax::SlotCount::kBoth) words.push_back({"both"});
      if (slot.count == syntax::SlotCount::kAll) words.push_back({"all"});
      continue;
    }
    for (const Template::Word& word : part.words) {
      const std::string& text = form == Form::kPlain ? word.plain : word.text;
      if (!text.empty()) words.push_back({text});
    }
  }
  return words;
}

// A word in one case and without the signs around it.
std::string plain(std::string_view word) {
  constexpr std::string_view kSigns = ".,;:!?()\"'";
  const std::size_t begin = word.find_first_not_of(kSigns);
  if (begin == word.npos) return {};
  return fold_case(word.substr(begin, word.find_last_not_of(kSigns) + 1 - begin));
}

// A bit for each word of a pair of opposites: 2 i for the first of pair i, 2 i + 1 for the second.
using Sides = std::uint64_t;
static_assert(2 * kOpposites.size() <= 64);
constexpr Sides kFirst = 0x5555'5555'5555'5555u;

Sides sides_in(const std::vector<Word>& words) {
  static const std::unordered_map<std::string_view, Sides> known = [] {
    std::unordered_map<std::string_view, Sides> sides;
    for (std::size_t i = 0; i < kOpposites.size(); ++i) {
      sides[kOpposites[i].first] |= Sides{1} << (2 * i);
      sides[kOpposites[i].second] |= Sides{2} << (2 * i);
    }
    return sides;
  }();
  Sides sides = 0;
  for (const Word& word : words) {
    if (word.is_object) continue;
    if (const auto at = known.find(word.text); at != known.end()) sides |= at->second;
  }
  return sides;
}

bool says_the_opposite(const std::vector<Word>& a, const std::vector<Word>& b) {
  const auto first_alone = [](Sides sides) { return sides & ~(sides >> 1) & kFirst; };
  const auto second_alone = [](Sides sides) { return sides >> 1 & ~sides & kFirst; };
  const Sides here = sides_in(a), there = here == 0 ? 0 : sides_in(b);
  return ((first_alone(here) & second_alone(there)) | (second_alone(here) & first_alone(there))) != 0;
}

// The same words around other objects, or opposites in one place.
bool differs_in_place(const std::vector<Word>& a, const std::vector<Word>& b) {
  if (a.size() != b.size() || a == b) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i] || (a[i].is_object && b[i].is_object)) continue;
    if (a[i].is_object || b[i].is_object) return false;
    if (!is_pair(kOpposites, a[i].text, b[i].text) &&
        !is_pair(kOppositesInPlace, a[i].text, b[i].text))
      return false;
  }
  return true;
}

std::vector<Word> objects_in_order(const std::vector<Word>& words,
                                   const std::vector<Word>& also_in) {
  std::vector<Word> objects;
  for (const Word& word : words) {
    const bool is_shared = std::find(also_in.begin(), also_in.end(), word) != also_in.end();
    const bool is_new = std::find(objects.begin(), objects.end(), word) == objects.end();
    if (word.is_object && is_shared && is_new) objects.push_back(word);
  }
  return objects;
}

// Whether one says the other and a clause more, behind it or before: "put A in B", "put A in B and
// close C".
bool adds_clause(const std::vector<Word>& longer, const std::vector<Word>& shorter) {
  constexpr auto kJoins =
      std::to_array<std::string_view>({"and", "then", "before", "after", "afterwards"});
  const auto joins = [&](const Word& word) {
    return !word.is_object && std::ranges::find(kJoins, word.text) != kJoins.end();
  };
  if (shorter.empty() || longer.size() < shorter.size() + 2) return false;
  const std::span all(longer);
  const auto is_shorter = [&](std::span<const Word> words) {
    return std::ranges::equal(words, shorter);
  };
  return (is_shorter(all.first(shorter.size())) && joins(all[shorter.size()])) ||
         (is_shorter(all.last(shorter.size())) && joins(all[all.size() - shorter.size() - 1]));
}

bool names_more(const std::vector<Word>& a, const std::vector<Word>& b) {
  return std::ranges::any_of(a, [&](const Word& word) {
    return word.is_object && !word.is_other && std::ranges::find(b, word) == b.end();
  });
}

bool same_success(const Model& model, const Task& a, const Task& b) {
  const auto success = [](const Task& task) {
    return std::ranges::find(task.judged, "success", &Metric::name);
  };
  const auto here = success(a), there = success(b);
  if (here == a.judged.end() || there == b.judged.end()) return true;
  return here->readout == there->readout && same_expression(model, here->expr, there->expr);
}

// Whether one asks for more than the other: success is another one, and one has a clause more, or
// speaks of something that the other does not speak of.
bool asks_for_more(const Model& model, const Task& a, const Task& b) {
  if (a.say == b.say || same_success(model, a, b)) return false;
  const std::vector<Word> here = words_of(model, a, Form::kPlain),
                          there = words_of(model, b, Form::kPlain);
  return adds_clause(here, there) || adds_clause(there, here) || names_more(here, there) ||
         names_more(there, here);
}

// Two sequences that take their objects in another order.
bool goes_the_other_way(const std::vector<Word>& a, const std::vector<Word>& b) {
  const auto is_sequence = [](const std::vector<Word>& words) {
    return has(words, "then") || has(words, "first") || has(words, "afterwards");
  };
  return is_sequence(a) && is_sequence(b) && objects_in_order(a, b) != objects_in_order(b, a);
}

}  // namespace

std::vector<Template::Word> words_of(const std::string& literal) {
  std::vector<Template::Word> words;
  for (std::string& word : literal_words(literal)) {
    std::string folded = plain(word);
    words.push_back({std::move(word), std::move(folded)});
  }
  return words;
}

const std::string& role_word(const Model& model, const Task& task, const std::string& object) {
  for (std::size_t i = 0; i < model.roles.size(); ++i) {
    const std::vector<ObjectId> objects = task.objects_in(model.roles.id(i));
    if (objects.size() == 1 && model.objects[objects.front()].name == object)
      return model.roles[model.roles.id(i)].name;
  }
  return object;
}

std::string first_word(const std::vector<Template::Part>& parts) {
  if (parts.empty() || parts[0].slot) return {};
  const std::string& text = parts[0].literal;
  return plain(std::string_view(text).substr(0, text.find(' ')));
}

std::vector<std::string> sentence_of(const Template& say) {
  std::vector<std::string> words;
  for (const Template::Part& part : say.parts) {
    if (part.slot) {
      words.push_back((part.slot->avoid ? "{avoid " : "{") + part.slot->name.text + "}");
      continue;
    }
    for (const std::string& written : literal_words(part.literal)) {
      std::string word = plain(written);
      if (!word.empty() && !is_article(word)) words.push_back(std::move(word));
    }
  }
  return words;
}

std::string opposite_in(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& written : literal_words(text)) {
    const std::string word = plain(written);
    for (const std::string& own : words) {
      for (const std::string& part : literal_words(own)) {
        if (is_pair(kOpposites, word, part)) return word;
      }
    }
  }
  return {};
}

bool are_opposites(std::string_view a, std::string_view b) {
  const std::vector<std::string> here = literal_words(std::string(a)),
                                 there = literal_words(std::string(b));
  bool differs = false;
  const auto fits = [&](const std::string& one, const std::string& other) {
    const std::string p = plain(one), q = plain(other);
    differs = differs || p != q;
    return p == q || is_pair(kOpposites, p, q);
  };
  return std::ranges::equal(here, there, fits) && differs;
}

bool has_opposite(const std::vector<std::string>& words) {
  return std::ranges::any_of(words, [](const std::string& own) {
    const std::vector<std::string> parts = literal_words(own);
    return std::ranges::any_of(parts, [](const std::string& part) {
      return std::ranges::any_of(
          kOpposites, [&](const Pair& pair) { return pair.first == part || pair.second == part; });
    });
  });
}

bool has_negation(const Template& say) {
  return std::any_of(say.parts.begin(), say.parts.end(),
                     [](const Template::Part& part) { return part.slot && part.slot->avoid; });
}

bool has_negation(const Model& model, const Task& task) {
  return has_negation(model.templates[task.say]) ||
         std::any_of(task.later.begin(), task.later.end(), [&](const LaterSentence& later) {
           return has_negation(model.templates[later.say]);
         });
}

bool is_control(const Template& say) { return say.frame == "untold"; }

bool asks_otherwise(const Model& model, const Task& a, const Task& b) {
  // Other turns are asked for, or the same at another time.
  if (a.later.size() != b.later.size() || !same_turns(model, a, b)) return true;
  for (std::size_t i = 1; i < sentence_count(a); ++i) {
    if (asks_otherwise(model, telling(a, i), telling(b, i))) return true;
  }
  if (model.templates[a.say].frame != model.templates[b.say].frame) return true;
  return contradicts(model, a, b) || asks_for_more(model, a, b);
}

bool contradicts(const Model& model, const Task& a, const Task& b) {
  if (a.say == b.say) return false;
  const std::vector<Word> here = words_of(model, a, Form::kPlain),
                          there = words_of(model, b, Form::kPlain);
  return says_the_opposite(here, there) || differs_in_place(here, there) ||
         goes_the_other_way(here, there);
}

bool is_reworded(const Model& model, const Task& a, const Task& b) {
  return !asks_otherwise(model, a, b) && has_other_words(model, a, b);
}

bool has_other_words(const Model& model, const Task& a, const Task& b) {
  if (has_negation(model, a) != has_negation(model, b)) return false;
  const auto names_any = [](const Template& say) {
    return std::ranges::any_of(say.parts, [](const Template::Part& part) {
      return part.slot && part.slot->role == RoleId::kNone;
    });
  };
  const auto differ = [&](const Task& here, const Task& there) {
    if (here.say == there.say && !names_any(model.templates[here.say])) return false;
    return words_of(model, here, Form::kWritten) != words_of(model, there, Form::kWritten);
  };
  if (differ(a, b)) return true;
  for (std::size_t i = 1; i < sentence_count(a); ++i) {
    if (differ(telling(a, i), telling(b, i))) return true;
  }
  return false;
}

}  // namespace probe::sema
