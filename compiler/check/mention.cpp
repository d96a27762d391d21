// P0404 for words that are written out: "put {source} on the towel" where no towel is. Reads
// English as far as it must: a name counts where a noun stands.
#include "compiler/check/mention.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "compiler/check/check.h"
#include "compiler/check/said.h"
#include "compiler/define/remembered.h"
#include "compiler/define/telling.h"
#include "compiler/define/wording.h"
#include "runtime/base/nouns.h"
#include "runtime/base/utf8.h"

namespace probe::sema {
namespace {

// What stands before a noun that is meant; what may follow it: may_follow_noun().
constexpr auto kBefore = std::to_array<std::string_view>(
    {"a",     "an",      "the",  "this",   "that",    "each",  "every",   "both",    "any",
     "no",    "in",      "into", "inside", "on",      "onto",  "to",      "towards", "from",
     "of",    "off",     "over", "under",  "above",   "below", "behind",  "beside",  "near",
     "with",  "without", "by",   "at",     "between", "and",   "or",      "not",     "than",
     "avoid", "up",      "down", "around", "against", "until", "another", "other"});

bool has(const auto& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// The words of a template; a slot is one empty word.
std::vector<Said::Word> words_of(const Template& say) {
  std::vector<Said::Word> words;
  for (const Template::Part& part : say.parts) {
    if (part.slot) {
      words.push_back({.text = {}, .of = {}, .ends = true});
      continue;
    }
    for (Said::Word& word : words_in(part.literal)) words.push_back(std::move(word));
  }
  if (!words.empty()) words.back().ends = true;
  return words;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end;
  }
  return parts;
}

using Names = std::map<std::vector<std::string>, std::vector<ObjectId>>;

const std::vector<std::string>* longest(const Names& called, const std::vector<Said::Word>& words,
                                        std::size_t from) {
  const std::vector<std::string>* found = nullptr;
  for (const auto& [name, objects] : called) {
    const std::size_t last = from + name.size() - 1;
    bool fits = last < words.size() && is_same_noun(words[last].text, name.back());
    for (std::size_t k = from; fits && k < last; ++k)
      fits = words[k].text == name[k - from] && !words[k].ends;
    if (!fits) continue;
    // The name itself before one that is in the plural.
    const auto rank = [&](const std::vector<std::string>& of) {
      return std::pair(of.size(), words[from + of.size() - 1].text == of.back());
    };
    if (found == nullptr || rank(name) > rank(*found)) found = &name;
  }
  return found;
}

// An object or the fixture of the scene may be meant: it has these words at the end of its own.
bool is_there(const Model& model, const Task& task, const std::vector<std::string>& name) {
  const auto ends_so = [&](std::string_view called) {
    const std::vector<std::string> own = split(fold_case(called));
    return own.size() >= name.size() &&
           std::equal(name.begin(), name.end() - 1,
                      own.end() - static_cast<std::ptrdiff_t>(name.size())) &&
           is_same_noun(name.back(), own.back());
  };
  if (const auto& fixture = model.scenes[task.scene].fixture) {
    // A folder of assets is all the name that a fixture has.
    std::string folder = fixture->text;
    std::replace(folder.begin(), folder.end(), '_', ' ');
    if (ends_so(folder)) return true;
  }
  const std::vector<ObjectId> objects = task.objects();
  return std::any_of(objects.begin(), objects.end(),
                     [&](ObjectId id) { return ends_so(model.objects[id].text.text); });
}

}  // namespace

Mentions::Mentions(const Model& model) : model_(model) {
  for (std::size_t i = 0; i < model.objects.size(); ++i) {
    const auto id = model.objects.id(i);
    if (model.objects[id].of) continue;
    const std::vector<std::string> name = split(fold_case(model.objects[id].text.text));
    if (!name.empty()) called_[name].push_back(id);
  }
}

std::vector<ObjectId> Mentions::in(const Template& say) const {
  std::vector<ObjectId> found;
  const std::vector<Said::Word> words = words_of(say);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_object_of_verb = i == 1;
    if (i == 0 || !(is_object_of_verb || has(kBefore, words[i - 1].text))) continue;
    const auto* name = longest(called_, words, i);
    if (name == nullptr) continue;
    const std::size_t last = i + name->size() - 1;
    const bool is_noun = words[last].ends || may_follow_noun(words[last + 1].text);
    const ObjectId first = called_.at(*name).front();
    if (is_noun && std::find(found.begin(), found.end(), first) == found.end())
      found.push_back(first);
    i = last;
  }
  return found;
}

const std::vector<ObjectId>& Mentions::in(TemplateId id) {
  const auto [at, is_new] = known_.try_emplace(id);
  if (is_new) at->second = in(model_.templates[id]);
  return at->second;
}

bool Mentions::is_absent(const Task& task, ObjectId named) const {
  return !is_there(model_, task, split(fold_case(model_.objects[named].text.text)));
}

void check_mentions(const Model& model, Reporter& reporter) {
  Mentions mentions(model);
  Silence silence(model, reporter, Silent::kMentions);
  const auto check = [&](const Task& task) {
    if (is_control(model.templates[task.say])) return;
    const About about(reporter, task.decl_span);
    for (const ObjectId named : mentions.in(task.say)) {
      if (!mentions.is_absent(task, named)) continue;
      const Object& object = model.objects[named];
      Diagnostic& absent =
          reporter.report(Situation::kAbsentWord, task.place(task.say_span),
                          "\"" + object.text.text +
                              "\" names an object that is not in the scene of `" + task.name + "`");
      absent.label(model.templates[task.say].span, "said here")
          .help("add `distractors " + object.name + "`, or write `{the " + object.name +
                "}` so that the words follow the object");
      // Only a warning can be silenced: a suite that was published like this says so.
      if (task.allow_absent) absent.severity = Severity::kWarning;
    }
  };
  for (const Task& task : model.tasks) {
    if (task.abstract || !task.complete || (task.keeps_absent && !task.allow_absent)) continue;
    if (silence.is_known(task)) continue;
    for_each_telling(task, check);
  }
}

}  // namespace probe::sema
