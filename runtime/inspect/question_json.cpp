#include "runtime/inspect/question_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <vector>

#include "runtime/inspect/wrap.h"
#include "runtime/plan/family_name.h"
#include "runtime/plan/ids.h"
#include "runtime/plan/questions.h"

namespace probe::inspect {
namespace {

constexpr std::size_t kLineWidth = 100;

Json family_head(const plan::Plan& plan, const plan::FamilyRecord& family) {
  return {{"set", plan.text(family.set)},
          {"name", plan.text(family.name)},
          {"form", plan::find_form(family.form)->word},
          {"moment", plan::find_moment(family.moment)->words}};
}

// What is right, in words; null when only a picture or an episode can tell.
Json right_of(const plan::Plan& plan, const plan::QuestionRecord& question) {
  const auto options = plan::slice_of(plan.options(), question.options);
  if (plan::truth_of(question) == plan::QuestionTruth::kMentions) {
    return fmt::format("{} to {}", plan.text(options[question.a].text),
                       plan.text(options[question.b].text));
  }
  if (question.right == plan::kNone) return {};
  switch (plan::form_of(plan.families()[question.family])) {
    case plan::QuestionForm::kChoice:
      return plan.text(options[question.right].text);
    case plan::QuestionForm::kYesNo:
      return question.right == 1 ? "yes" : "no";
    default:
      return question.right;
  }
}

Json option_of(const plan::Plan& plan, const plan::TaskRecord& task,
               const plan::OptionRecord& option) {
  Json words = Json::array();
  for (const plan::StringRef& word : plan::slice_of(plan.words(), option.words))
    words.push_back(plan.text(word));
  return {
      {"text", plan.text(option.text)},
      {"object",
       option.body == plan::kNone ? Json() : Json(plan.text(plan.bodies(task)[option.body].name))},
      {"words", std::move(words)},
      {"must_be_seen", (option.flags & plan::kMustBeSeen) != 0}};
}

std::string number_of(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace

Json list_questions(const plan::Plan& plan, std::span<const std::uint32_t> tasks) {
  struct Counts {
    std::set<std::uint32_t> tasks;
    std::size_t questions = 0, asked = 0;
    std::map<std::uint32_t, std::vector<std::string_view>> omitted;  // by reason
  };
  const std::set<std::uint32_t> wanted(tasks.begin(), tasks.end());
  std::map<std::uint32_t, Counts> counts;  // by family
  std::size_t questions = 0, asked = 0;
  for (const plan::QuestionRecord& question : plan.questions()) {
    if (!wanted.contains(question.task)) continue;
    const std::size_t starts = plan.tasks()[question.task].episodes.count;
    Counts& of = counts[question.family];
    of.tasks.insert(question.task);
    ++of.questions, ++questions;
    of.asked += starts, asked += starts;
  }
  for (const plan::OmissionRecord& omission : plan.omissions()) {
    if (wanted.contains(omission.task))
      counts[omission.family].omitted[omission.reason].push_back(
          plan.text(plan.tasks()[omission.task].name));
  }
  Json families = Json::array();
  for (const auto& [index, of] : counts) {
    const plan::FamilyRecord& family = plan.families()[index];
    Json json = family_head(plan, family);
    json["text"] = plan.text(family.text);
    json["tasks"] = of.tasks.size();
    json["questions"] = of.questions;
    json["asked"] = of.asked;
    json["pixels"] = family.pixels;
    json["omitted"] = Json::array();
    for (const auto& [reason, names] : of.omitted)
      json["omitted"].push_back({{"reason", plan::find_omission(reason)->says}, {"tasks", names}});
    families.push_back(std::move(json));
  }
  return {{"questions", questions}, {"asked", asked}, {"families", std::move(families)}};
}

std::string question_list_text(const Json& list) {
  std::size_t width = 0;
  const auto name_of = [](const Json& family) {
    return plan::family_name(family["set"].text(), family["name"].text());
  };
  for (const Json& family : list["families"]) width = std::max(width, name_of(family).size());
  std::string text;
  const auto out = std::back_inserter(text);
  for (const Json& family : list["families"]) {
    const bool at_end = family["moment"] == "at end";
    fmt::format_to(out, "{:<{}}  {:<6}  {}, {}, asked {} times{}\n", name_of(family), width,
                   family["form"].get<std::string>(),
                   number_of(family["tasks"].get<std::size_t>(), "task"),
                   number_of(family["questions"].get<std::size_t>(), "question"),
                   family["asked"].get<std::size_t>(), at_end ? " of recorded episodes" : "");
    for (const std::string& line :
         lines_of(family["text"].get<std::string>(), kLineWidth - width - 2))
      fmt::format_to(out, "{:<{}}  {}\n", "", width, line);
    for (const Json& omitted : family["omitted"]) {
      const Json& tasks = omitted["tasks"];
      fmt::format_to(out, "{:<{}}  not in {}: {}\n", "", width,
                     tasks.size() == 1 ? "`" + tasks[0].get<std::string>() + "`"
                                       : number_of(tasks.size(), "task"),
                     omitted["reason"].get<std::string>());
    }
  }
  return text;
}

Json questions_of(const plan::Plan& plan, std::uint32_t task) {
  Json all = Json::array();
  for (const plan::QuestionRecord& question : plan.questions()) {
    if (question.task != task) continue;
    Json json = family_head(plan, plan.families()[question.family]);
    json["text"] = plan.text(question.text);
    json["options"] = Json::array();
    for (const plan::OptionRecord& option : plan::slice_of(plan.options(), question.options))
      json["options"].push_back(option_of(plan, plan.tasks()[task], option));
    json["right"] = right_of(plan, question);
    json["proof"] = plan::find_truth(question.truth)->says;
    json["id"] = to_hex(plan::to_sha256(question.question_id));
    all.push_back(std::move(json));
  }
  return all;
}

Json omissions_of(const plan::Plan& plan, std::uint32_t task) {
  Json all = Json::array();
  for (const plan::OmissionRecord& omission : plan.omissions()) {
    if (omission.task != task) continue;
    const plan::FamilyRecord& family = plan.families()[omission.family];
    all.push_back({{"set", plan.text(family.set)},
                   {"name", plan.text(family.name)},
                   {"reason", plan::find_omission(omission.reason)->says}});
  }
  return all;
}

std::string questions_text(const Json& questions, const Json& omissions) {
  std::string text;
  const auto out = std::back_inserter(text);
  const auto indented = [&](const std::string& line) {
    for (const std::string& part : lines_of(line, kLineWidth - 4))
      fmt::format_to(out, "    {}\n", part);
  };
  for (const Json& question : questions) {
    fmt::format_to(out, "{}.{}, {}{}, {}\n", question["set"].get<std::string>(),
                   question["name"].get<std::string>(), question["form"].get<std::string>(),
                   question["moment"] == "at end" ? " at end" : "",
                   question["id"].get<std::string>().substr(0, 8));
    indented(question["text"].get<std::string>());
    const bool is_choice = question["form"] == "choice";
    std::string options;
    for (const Json& option : question["options"]) {
      const auto name = option["text"].get<std::string>();
      if (!is_choice) continue;
      options += (options.empty() ? "" : ", ") + std::string(question["right"] == name ? "*" : "") +
                 name + (option["object"].is_null() ? " (not there)" : "");
    }
    if (!options.empty()) indented(options);
    const Json& right = question["right"];
    const auto proof = question["proof"].get<std::string>();
    if (right.is_null()) {
      indented("the right answer is " + proof);
    } else {
      indented(fmt::format("right: {}, {}",
                           right.is_string() ? right.get<std::string>() : right.dump(), proof));
    }
  }
  for (const Json& omission : omissions) {
    fmt::format_to(out, "{}.{} is not asked: {}\n", omission["set"].get<std::string>(),
                   omission["name"].get<std::string>(), omission["reason"].get<std::string>());
  }
  return text;
}

namespace {

using Key = std::tuple<std::string_view, std::string_view, std::string_view>;  // set, family, task
using QuestionIds = std::map<Key, std::multiset<std::string>>;

QuestionIds ids_of(const plan::Plan& plan) {
  QuestionIds ids;
  for (const plan::QuestionRecord& question : plan.questions()) {
    const plan::FamilyRecord& family = plan.families()[question.family];
    ids[{plan.text(family.set), plan.text(family.name),
         plan.text(plan.tasks()[question.task].name)}]
        .insert(to_hex(plan::to_sha256(question.question_id)));
  }
  return ids;
}

}  // namespace

Json diff_questions(const plan::Plan& a, const plan::Plan& b) {
  const QuestionIds ours = ids_of(a), theirs = ids_of(b);
  if (ours.empty() && theirs.empty()) return {};
  struct Counts {
    std::size_t only_a = 0, only_b = 0, changed = 0;
  };
  Counts sum;
  std::size_t equal = 0;
  std::map<std::pair<std::string_view, std::string_view>, Counts> families;
  const auto note = [&](const Key& key, std::size_t Counts::*which) {
    ++(sum.*which);
    ++(families[{std::get<0>(key), std::get<1>(key)}].*which);
  };
  for (const auto& [key, ids] : ours) {
    const auto there = theirs.find(key);
    if (there == theirs.end()) {
      note(key, &Counts::only_a);
    } else if (there->second != ids) {
      note(key, &Counts::changed);
    } else {
      ++equal;
    }
  }
  for (const auto& [key, ids] : theirs) {
    if (!ours.contains(key)) note(key, &Counts::only_b);
  }
  Json changed = Json::array();
  for (const auto& [name, counts] : families) {
    changed.push_back({{"set", name.first},
                       {"name", name.second},
                       {"only_a", counts.only_a},
                       {"only_b", counts.only_b},
                       {"changed", counts.changed}});
  }
  return {{"only_a", sum.only_a},
          {"only_b", sum.only_b},
          {"changed", sum.changed},
          {"equal", equal},
          {"changed_families", std::move(changed)}};
}

std::string question_diff_text(const Json& diff) {
  if (diff.is_null()) return {};
  std::string text;
  const auto out = std::back_inserter(text);
  const auto number = [](const Json& json, const char* key) {
    return json[key].get<std::size_t>();
  };
  for (const Json& family : diff["changed_families"]) {
    fmt::format_to(out, "? {}: {} only in the first, {} only in the second, {} changed\n",
                   plan::family_name(family["set"].text(), family["name"].text()),
                   number(family, "only_a"), number(family, "only_b"), number(family, "changed"));
  }
  fmt::format_to(out,
                 "questions, by task and family: {} only in the first, {} only in the second, "
                 "{} changed, {} equal\n",
                 number(diff, "only_a"), number(diff, "only_b"), number(diff, "changed"),
                 number(diff, "equal"));
  return text;
}

}  // namespace probe::inspect
