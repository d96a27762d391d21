#include "compiler/check/clause_words.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "compiler/check/said.h"
#include "compiler/define/template.h"

namespace probe::sema {
namespace {

struct ClauseWord {
  std::vector<std::string> words;
  WordIs is;
};

// By the first word, the longest first.
const std::multimap<std::string, ClauseWord, std::less<>>& clause_words() {
  static const auto table = [] {
    std::vector<ClauseWord> all;
#define PROBE_CLAUSE_WORD(words, is) all.push_back({folded_words(words), WordIs::is});
#include "compiler/check/clause_words.def"
    std::stable_sort(all.begin(), all.end(), [](const ClauseWord& a, const ClauseWord& b) {
      return a.words.size() > b.words.size();
    });
    std::multimap<std::string, ClauseWord, std::less<>> by_first;
    for (ClauseWord& one : all) {
      std::string first = one.words.front();
      by_first.emplace(std::move(first), std::move(one));
    }
    return by_first;
  }();
  return table;
}

// The declared parts and the regions of a fixture.
Things things_of(const Model& model, FixtureId id) {
  Things found;
  for (const Fixture::Part& part : model.fixtures[id].parts) found.insert(part.thing);
  for (const Fixture::OwnRegion& region : model.fixtures[id].regions) found.insert(region.thing);
  found.erase(ObjectId::kNone);
  return found;
}

}  // namespace

// A sign that stands alone, as behind a slot, belongs to what it follows.
std::vector<ClauseWords::Token> ClauseWords::tokens_of(const Model& model, const Task& task) {
  std::vector<Token> tokens;
  const Template& say = model.templates[task.say];
  for (const Template::Part& part : say.parts) {
    if (part.slot) {
      const auto meant = meant_by(model, task, say, *part.slot);
      Token token;
      token.of = Things(meant.begin(), meant.end());
      token.is_slot = true;
      token.is_set = part.slot->role != RoleId::kNone && model.roles[part.slot->role].is_set;
      if (const auto fixture = fixture_of(model, *part.slot)) token.of = things_of(model, *fixture);
      for (const ObjectId id : token.of)
        token.shown += (token.shown.empty() ? "the " : " and the ") + model.objects[id].text.text;
      if (token.of.empty()) token.shown = part.slot->name.text;
      tokens.push_back(std::move(token));
      continue;
    }
    constexpr std::string_view kSigns = ".,;:!?()";
    const std::string& text = part.literal;
    if (!text.empty() && kSigns.find(text.front()) != kSigns.npos && !tokens.empty())
      tokens.back().ends = true;
    for (Said::Word& word : words_in(text)) {
      Token token;
      token.shown = word.text;
      token.text = std::move(word.text);
      token.ends = word.ends;
      tokens.push_back(std::move(token));
    }
  }
  return tokens;
}

ClauseWords::ClauseWords(const Model& model, const Task& task) : words_(tokens_of(model, task)) {}

ClauseWords::Match ClauseWords::match(std::size_t at) const {
  if (at >= words_.size() || words_[at].is_slot) return {};
  const auto [from, to] = clause_words().equal_range(words_[at].text);
  for (auto one = from; one != to; ++one) {
    const auto& wanted = one->second.words;
    std::size_t k = 1;
    while (k < wanted.size() && at + k < words_.size() && words_[at + k].text == wanted[k] &&
           !words_[at + k - 1].ends)
      ++k;
    if (k == wanted.size()) return {one->second.is, k};
  }
  return {};
}

bool ClauseWords::joins(WordIs is) {
  return is == WordIs::kJoins || is == WordIs::kAnd || is == WordIs::kOr;
}

std::vector<std::string> ClauseWords::texts(std::size_t at, std::size_t most) const {
  std::vector<std::string> found;
  for (; at < words_.size() && found.size() < most && !words_[at].is_slot; ++at) {
    found.push_back(words_[at].text);
    if (words_[at].ends) break;
  }
  return found;
}

std::string ClauseWords::shown(std::size_t from, std::size_t to) const {
  std::string text;
  for (std::size_t i = from; i < to && i < words_.size(); ++i)
    text += (i > from ? " " : "") + words_[i].shown;
  return text;
}

}  // namespace probe::sema
