#include "compiler/rephrase/actions.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "compiler/define/wording.h"
#include "compiler/rephrase/relations.h"

namespace probe::rephrase {
namespace {

// "put {source}, not {avoid carrot}, on {target}": the carrot is not what is to be moved.
constexpr std::string_view kInstead = "instead";

bool ends_with_words(std::span<const std::string> words, std::string_view ending) {
  std::size_t left = words.size();
  while (!ending.empty()) {
    const std::size_t space = ending.rfind(' ');
    const std::size_t begin = space == ending.npos ? 0 : space + 1;
    if (left == 0 || words[--left] != ending.substr(begin)) return false;
    ending = ending.substr(0, space == ending.npos ? 0 : space);
  }
  return true;
}

std::string_view relation_before(std::span<const std::string> words) {
  for (const Relation& relation : kRelations) {
    for (std::string_view left = relation.words; !left.empty();) {
      const std::size_t bar = std::min(left.find('|'), left.size());
      if (ends_with_words(words, left.substr(0, bar))) return relation.name;
      left.remove_prefix(std::min(bar + 1, left.size()));
    }
  }
  return {};
}

}  // namespace

Actions::Actions(const sema::Model& model) {
  constexpr std::string_view kAvoid = "{avoid ";
  std::map<std::string, std::set<std::string>> relations;  // by frame
  for (const sema::Template& say : model.templates) {
    Reading reading;
    reading.frame = say.frame;
    const std::vector<std::string> words = sema::sentence_of(say);
    std::set<std::string> own;
    std::string_view last_wanted;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::string& word = words[i];
      reading.sentence += (i == 0 ? "" : " ") + word;
      if (!word.starts_with('{')) continue;
      std::string relation(relation_before(std::span(words).first(i)));
      if (word.starts_with(kAvoid)) {
        if (relation.empty() && last_wanted == "{source}") relation = kInstead;
        reading.forbidden.push_back(
            {word.substr(kAvoid.size(), word.size() - kAvoid.size() - 1), std::move(relation)});
        continue;
      }
      last_wanted = word;
      if (!relation.empty()) own.insert(word == "{source}" ? "source " + relation : relation);
    }
    for (const std::string& relation : own)
      reading.relation += (reading.relation.empty() ? "" : " and ") + relation;
    if (!reading.relation.empty()) relations[reading.frame].insert(reading.relation);
    readings_.push_back(std::move(reading));
  }

  std::map<std::pair<std::string, std::string>, std::size_t> actions;
  std::map<std::string, std::size_t> first_with;  // by sentence that names its relation
  for (Reading& reading : readings_) {
    const bool is_explicit = !reading.relation.empty();
    const std::set<std::string>& known = relations[reading.frame];
    if (!is_explicit && known.size() == 1) reading.relation = *known.begin();
    const auto [at, is_new] =
        actions.try_emplace({reading.frame, reading.relation}, actions.size());
    if (is_new) joined_.push_back(at->second);
    reading.action = at->second;
    for (Forbidden& thing : reading.forbidden) {
      if (thing.second.empty()) thing.second = reading.relation;
    }
    if (!is_explicit) continue;
    const std::size_t first =
        first_with.try_emplace(reading.sentence, reading.action).first->second;
    joined_[root_of(first)] = root_of(reading.action);
  }
  for (const Reading& reading : readings_)
    actions_of_[reading.sentence].insert(root_of(reading.action));
}

std::size_t Actions::root_of(std::size_t action) const {
  while (joined_[action] != action) action = joined_[action];
  return action;
}

std::optional<Refusal> Actions::why_other(sema::TemplateId own, sema::TemplateId other) const {
  const Reading& said = readings_[static_cast<std::size_t>(own)];
  const Reading& words = readings_[static_cast<std::size_t>(other)];
  if (root_of(said.action) != root_of(words.action))
    return said.frame == words.frame ? Refusal::kRelation : Refusal::kFrame;
  if (actions_of_.at(words.sentence).size() > 1) return Refusal::kTwoActions;
  return std::nullopt;
}

std::vector<Forbidden> Actions::forbidden(sema::TemplateId id) const {
  return readings_[static_cast<std::size_t>(id)].forbidden;
}

}  // namespace probe::rephrase
