// P1203: "the left can" written out in an instruction. What such words mean differs from start to
// start, and only a `spatial` phrase is proved in each. Reads English as far as it must: a word of
// places counts where it stands at a noun of the scene.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/check/check.h"
#include "compiler/check/said.h"
#include "compiler/define/telling.h"
#include "compiler/define/wording.h"
#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"
#include "runtime/base/words.h"

namespace probe::sema {
namespace {

struct PlaceWord {
  std::string_view word, relation;
};
constexpr auto kPlaceWords = std::to_array<PlaceWord>({
#define PROBE_PLACE_WORD(word, relation) {word, relation},
#include "compiler/check/place_words.def"
});

// What may stand between such a word and its noun is no word of these.
constexpr auto kBetween = std::to_array<std::string_view>(
    {"a",    "an",   "the",  "this", "that", "of",   "in",  "into", "on",  "onto", "to",
     "from", "off",  "over", "with", "by",   "at",   "and", "or",   "not", "up",   "down",
     "then", "side", "half", "edge", "end",  "part", "it",  "them", "is",  "as",   "hand"});
// Nouns of whatever there is.
constexpr auto kAnything = std::to_array<std::string_view>({"one", "object", "thing", "item"});

template <std::size_t N>
bool has(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// The objects and parts of a task that a noun may mean: by the last word of a name or a phrase, or
// by a value of an attribute.
std::vector<ObjectId> meant_by_noun(const Model& model, const Task& task, std::string_view noun) {
  std::vector<ObjectId> found;
  const auto ends_so = [&](const std::string& text) {
    const std::vector<std::string> words = folded_words(text);
    return !words.empty() && is_same_noun(noun, words.back());
  };
  for (const ObjectId id : nameable(model, task)) {
    const Object& object = model.objects[id];
    bool fits = has(kAnything, noun) || ends_so(object.text.text);
    for (const Phrase& phrase : object.phrases) fits = fits || ends_so(phrase.text.text);
    for (std::size_t i = 0; i < object.values.size(); ++i) {
      for (const std::uint32_t value : object.values[i])
        fits = fits || ends_so(model.attributes[model.attributes.id(i)].values[value]);
    }
    if (fits) found.push_back(id);
  }
  return found;
}

// Whether something is called so: "left knob" is no place where a part has that name.
bool is_name(const Model& model, const std::string& words) {
  const auto has_it = [&](const std::string& text) { return has_words(fold_case(text), words); };
  const auto is_called = [&](const Region& region) {
    std::string name = region.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    return has_it(name);
  };
  return std::any_of(model.objects.begin(), model.objects.end(),
                     [&](const Object& object) {
                       return has_it(object.text.text) ||
                              std::any_of(object.regions.begin(), object.regions.end(), is_called);
                     }) ||
         std::any_of(model.scenes.begin(), model.scenes.end(), [&](const Scene& scene) {
           return std::any_of(scene.surface_regions.begin(), scene.surface_regions.end(),
                              is_called) ||
                  std::any_of(scene.fixture_regions.begin(), scene.fixture_regions.end(),
                              is_called);
         });
}

bool has_place_word(const Template& say) {
  return std::any_of(say.parts.begin(), say.parts.end(), [](const Template::Part& part) {
    if (part.slot) return false;
    const std::string text = fold_case(part.literal);
    return std::any_of(kPlaceWords.begin(), kPlaceWords.end(),
                       [&](const PlaceWord& one) { return has_words(text, one.word); });
  });
}

struct Found {
  const PlaceWord* place = nullptr;
  std::string words;  // "left red can"
  std::vector<ObjectId> meant;
};

std::optional<Found> find_in(const Model& model, const Task& task, const Said& said) {
  const auto& words = said.words;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto place =
        std::find_if(kPlaceWords.begin(), kPlaceWords.end(),
                     [&](const PlaceWord& one) { return one.word == words[i].text; });
    if (place == kPlaceWords.end()) continue;
    // "put back the can" is no place, "put the back can" is.
    if (place->word == "back" && words[i - 1].text != "the") continue;
    // Of several nouns in a row the last one, as of "the left red block".
    std::string phrase = words[i].text;
    std::optional<Found> found;
    for (std::size_t k = i + 1; k < words.size() && k < i + 4; ++k) {
      const std::string& word = words[k].text;
      if (word.empty() || has(kBetween, word)) break;
      phrase += " " + word;
      std::vector<ObjectId> meant = meant_by_noun(model, task, word);
      if (meant.empty()) continue;
      found.reset();
      if (!is_name(model, phrase)) found = Found{&*place, phrase, std::move(meant)};
    }
    if (found) return found;
    const bool is_superlative = place->relation == "nearest" || place->relation == "farthest";
    if (!is_superlative || words[i - 1].text.empty()) continue;
    std::vector<ObjectId> meant = meant_by_noun(model, task, words[i - 1].text);
    if (!meant.empty())
      return Found{&*place, words[i - 1].text + " " + words[i].text, std::move(meant)};
  }
  return std::nullopt;
}

std::string_view role_name(const Model& model, const Task& task, ObjectId object) {
  for (std::size_t i = 0; i < model.roles.size(); ++i) {
    const std::vector<ObjectId> filled = task.objects_in(model.roles.id(i));
    if (filled.size() == 1 && filled.front() == object) return model.roles[model.roles.id(i)].name;
  }
  return {};
}

// What to write instead: a phrase that says it, or one to declare.
std::string advice(const Model& model, const Task& task, const Found& found) {
  for (const ObjectId id : found.meant) {
    const std::string_view role = role_name(model, task, id);
    if (role.empty()) continue;
    for (const Phrase& phrase : model.objects[id].phrases) {
      if (!phrase.is_spatial() || !has_words(fold_case(phrase.text.text), found.place->word))
        continue;
      return "`refer " + std::string(role) + " as " + phrase.name + "` and `{the " +
             std::string(role) + "}` say \"" + phrase.text.text + "\", proved in every start";
    }
  }
  std::string role = "ROLE", object = "what is meant";
  for (const ObjectId id : found.meant) {
    const std::string_view name = role_name(model, task, id);
    if (name.empty()) continue;
    role = name;
    object = "`" + model.objects[id].name + "`";
    break;
  }
  const std::string relation =
      found.place->relation.empty() ? "RELATION" : std::string(found.place->relation);
  return "give " + object + " a phrase that is proved in every start, `phrase by_place spatial \"" +
         found.words + "\" means .. and " + relation + "`, and say `{the " + role +
         "}` with `refer " + role + " as by_place`";
}

}  // namespace

void check_place_words(const Model& model, Reporter& reporter) {
  std::map<TemplateId, bool> known;  // whether its own words have one at all
  const auto check = [&](const Task& task) {
    const Template& say = model.templates[task.say];
    if (is_control(say)) return;
    const auto [may, is_new] = known.try_emplace(task.say, false);
    if (is_new) may->second = has_place_word(say);
    if (!may->second) return;
    const std::optional<Found> found = find_in(model, task, said_by(model, task));
    if (!found) return;
    const About about(reporter, task.decl_span);
    reporter
        .report(Code::P1203, task.place(task.say_span),
                "\"" + found->words + "\" says in `" + task.name +
                    "` which thing is meant by where it is, and nothing proves it")
        .label(say.span, "said here")
        .help(advice(model, task, *found));
  };
  for (const Task& task : model.tasks) {
    if (!task.abstract && task.complete) for_each_telling(task, check);
  }
}

}  // namespace probe::sema
