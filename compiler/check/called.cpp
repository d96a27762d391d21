#include "compiler/check/called.h"

#include <algorithm>

#include "compiler/check/said.h"
#include "runtime/base/nouns.h"

namespace probe::sema {
namespace {

// "flat_stove_2": the number tells it from its copies.
std::vector<std::string> spelled_out(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  std::vector<std::string> words = folded_words(name);
  while (words.size() > 1 && words.back().find_first_not_of("0123456789") == std::string::npos)
    words.pop_back();
  return words;
}

Calling read(const Model& model, ObjectId id) {
  const Object& object = model.objects[id];
  Calling thing{id, {}, {}, {}};
  const Fixture* const fixture = object.of ? &model.fixtures[object.of->fixture] : nullptr;
  // A region without a name of its own is called as its part is, which may be another's.
  const bool has_name = fixture == nullptr || !object.of->region ||
                        !fixture->regions[*object.of->region].text.text.empty();
  if (has_name) {
    thing.names.push_back(folded_words(object.text.text));
    for (const Phrase& phrase : object.phrases)
      thing.names.push_back(folded_words(phrase.text.text));
  }
  if (fixture != nullptr) thing.names.push_back(spelled_out(fixture->name));
  for (std::size_t i = 0; i < object.values.size(); ++i) {
    for (const std::uint32_t value : object.values[i]) {
      for (std::string& word : folded_words(model.attributes[model.attributes.id(i)].values[value]))
        thing.adjectives.push_back(std::move(word));
    }
  }
  for (const auto& name : thing.names) {
    const auto end = std::find_if(name.begin(), name.end(), may_follow_noun);
    if (end == name.begin()) continue;
    thing.nouns.push_back(*(end - 1));
    thing.adjectives.insert(thing.adjectives.end(), name.begin(), end - 1);
  }
  return thing;
}

}  // namespace

const Calling& Callings::of(ObjectId thing) {
  const auto [at, is_new] = known_.try_emplace(thing);
  if (is_new) at->second = read(model_, thing);
  return at->second;
}

Called::Called(const Model& model, const Task& task, Callings& callings) : model_(model) {
  const auto add = [&](ObjectId id) { things_.push_back(&callings.of(id)); };
  for (const ObjectId id : task.objects()) add(id);
  for (const FixtureId id : model.scenes[task.scene].fixtures) {
    const Fixture& fixture = model.fixtures[id];
    for (const Fixture::Part& part : fixture.parts) {
      if (part.declared && part.thing != ObjectId::kNone) add(part.thing);
    }
    for (const Fixture::OwnRegion& region : fixture.regions) {
      if (region.thing != ObjectId::kNone) add(region.thing);
    }
  }
}

bool Called::is_name(const Calling& thing, const std::vector<std::string>& words,
                     std::size_t length) {
  return std::any_of(thing.names.begin(), thing.names.end(), [&](const auto& name) {
    return name.size() == length && std::equal(name.begin(), name.end() - 1, words.begin()) &&
           is_same_noun(words[length - 1], name.back());
  });
}

bool Called::is_noun(const Calling& thing, const std::vector<std::string>& words,
                     std::size_t length) {
  const bool has_noun =
      std::any_of(thing.nouns.begin(), thing.nouns.end(),
                  [&](const std::string& noun) { return is_same_noun(words[length - 1], noun); });
  return has_noun &&
         std::all_of(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(length) - 1,
                     [&](const std::string& word) {
                       return std::find(thing.adjectives.begin(), thing.adjectives.end(), word) !=
                              thing.adjectives.end();
                     });
}

Called::Found Called::find(const std::vector<std::string>& words) const {
  for (std::size_t length = words.size(); length > 0; --length) {
    Found whole{{}, length, false}, noun{{}, length, false};
    for (const Calling* thing : things_) {
      if (is_name(*thing, words, length)) whole.of.insert(thing->id);
      if (is_noun(*thing, words, length)) noun.of.insert(thing->id);
    }
    Found& found = whole.of.empty() ? noun : whole;
    if (found.of.empty()) continue;
    found.is_plural = std::none_of(things_.begin(), things_.end(), [&](const Calling* thing) {
      if (!found.of.contains(thing->id)) return false;
      // "Butter at the back" ends with no noun of its own.
      const bool is_called_so =
          std::any_of(thing->names.begin(), thing->names.end(), [&](const auto& name) {
            return name.size() == length && name.back() == words[length - 1];
          });
      return is_called_so || std::find(thing->nouns.begin(), thing->nouns.end(),
                                       words[length - 1]) != thing->nouns.end();
    });
    return found;
  }
  return {};
}

bool Called::has_part(const Things& of, ObjectId thing) const {
  const auto& mine = model_.objects[thing].of;
  return mine && std::any_of(of.begin(), of.end(), [&](ObjectId one) {
           const auto& other = model_.objects[one].of;
           return other && other->fixture == mine->fixture;
         });
}

std::optional<std::pair<std::string, std::string>> Called::other_than(
    const std::vector<std::string>& words, const Things& of) const {
  const std::string& word = words.front();
  for (const Object& object : model_.objects) {
    if (folded_words(object.text.text) == words) return std::nullopt;
  }
  std::optional<std::pair<std::string, std::string>> first;
  for (const ObjectId id : of) {
    const Object& object = model_.objects[id];
    // How a thing looks that was painted is said elsewhere.
    if (object.paint || object.texture) return std::nullopt;
    bool is_other = false;
    for (std::size_t i = 0; i < object.values.size(); ++i) {
      const Attribute& attribute = model_.attributes[model_.attributes.id(i)];
      const auto at = std::find(attribute.values.begin(), attribute.values.end(), word);
      if (at == attribute.values.end()) continue;
      const auto& own = object.values[i];
      const auto value = static_cast<std::uint32_t>(at - attribute.values.begin());
      if (own.empty() || std::find(own.begin(), own.end(), value) != own.end()) return std::nullopt;
      is_other = true;
      if (!first) first.emplace(attribute.name, attribute.values[own.front()]);
    }
    if (!is_other) return std::nullopt;
  }
  return first;
}

Things Called::with(std::string_view adjective, const Things& of) const {
  Things found;
  for (const Calling* thing : things_) {
    if (of.contains(thing->id) && std::find(thing->adjectives.begin(), thing->adjectives.end(),
                                            adjective) != thing->adjectives.end())
      found.insert(thing->id);
  }
  return found;
}

bool Called::is_adjective(std::string_view word) const {
  return std::any_of(things_.begin(), things_.end(), [&](const Calling* thing) {
    return std::find(thing->adjectives.begin(), thing->adjectives.end(), word) !=
           thing->adjectives.end();
  });
}

}  // namespace probe::sema
