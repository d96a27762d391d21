// vlaprobe why
#include <fmt/format.h>

#include <algorithm>

#include "runtime/ask/answers.h"
#include "runtime/ask/vouch.h"
#include "runtime/ask/why_answer.h"
#include "runtime/base/json.h"
#include "runtime/base/printable.h"
#include "runtime/base/put_words.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/rejudge/explain.h"
#include "runtime/rejudge/explain_json.h"
#include "runtime/store/not_attempted.h"

namespace probe::cli {
namespace {

struct WhyArguments {
  std::string dir, task, metric, question;
  int episode = 0;
  std::optional<int> seed;
  bool json = false;
};

void print_metric(const rejudge::MetricWhy& metric) {
  put_words("{} = {} {} ({})\n", metric.name, metric.shown, metric.when, metric.readout);
  const auto left = [](const rejudge::Condition& c) {
    return c.bodies.empty() ? c.text : c.text + "  [" + c.bodies + "]";
  };
  std::size_t text_width = 0, measured_width = 0;
  for (const rejudge::Condition& c : metric.conditions) {
    text_width = std::max(text_width, left(c).size());
    measured_width = std::max(measured_width, c.measured.size());
  }
  const std::string* file = nullptr;
  for (const rejudge::Condition& c : metric.conditions) {
    if (!c.file.empty() && (file == nullptr || *file != c.file)) put_words("  {}\n", c.file);
    file = &c.file;
    // What did not decide stands without the mark.
    put_words("{:>6} {} {:<{}}  {:<{}}  {}{}\n", c.line > 0 ? std::to_string(c.line) : "",
              c.decides ? '>' : '|', left(c), text_width, c.measured, measured_width,
              c.is_number ? "" : (c.truth ? "true" : "false"),
              c.alike > 0 ? fmt::format("  and {} alike", c.alike) : "");
  }
}

// What a model wrote is shown as text, in one line, whatever it holds.
std::string shown(const std::string& text) {
  constexpr std::size_t kLongest = 200;
  return printable(text, kLongest);
}

void print_answer(const ask::AnswerRow& row) {
  std::string which = fmt::format("{} {}", ask::word_of(row.arm), row.rotation);
  if (row.seed != -1) which += fmt::format(", seed {}", row.seed);
  const std::string verdict = row.invalid  ? "invalid: " + shown(*row.invalid)
                              : !row.right ? std::string("neither right nor wrong is stored")
                              : *row.right ? "right"
                                           : "wrong, right is " + shown(row.expected);
  put_words("  {:<14} \"{}\"  {}{}{}: {}\n", which, shown(row.raw),
            row.reader == ask::kReaderVersion ? "" : "read anew as ",
            ask::word_of(row.reading.verdict),
            row.reading.rule.empty() ? "" : " by \"" + shown(row.reading.rule) + "\"", verdict);
}

int why_answers_verb(const WhyArguments& arguments) {
  const auto why = ask::why_answers(arguments.dir, arguments.task, arguments.episode,
                                    arguments.seed, arguments.question);
  if (!why) return report(why.failure());
  bool is_borne = true;
  for (const ask::AnswerWhy& question : why->questions)
    is_borne = is_borne && std::ranges::none_of(question.answers, ask::is_unvouched);
  const int exit = is_borne ? kFine : kOutside;
  if (arguments.json) {
    put("{}\n", ask::to_json(*why).dump(1));
    return exit;
  }
  put_words("{} episode {}, \"{}\", asked of {}\n", why->task, why->episode, why->prompt,
            shown(why->model));
  const auto print_place = [](const char* what, const std::optional<ask::Written>& place) {
    if (place) put_words("  {:<14} {}:{}: {}\n", what, place->file, place->line, place->text);
  };
  for (const ask::AnswerWhy& question : why->questions) {
    put_words("\n{}: {}\n", question.question, question.text);
    print_place("asked at", question.asked_at);
    put_words("  {:<14} {}\n", "the truth is", question.truth);
    print_place("right is", question.right_at);
    for (const std::string& reason : question.left_out) put_words("  not asked: {}\n", reason);
    for (const ask::AnswerRow& row : question.answers) print_answer(row);
    if (question.answers.empty() && question.left_out.empty()) put_words("  not answered yet\n");
  }
  return exit;
}

int why_verb(const WhyArguments& arguments) {
  const bool is_asked = ask::holds_answers(arguments.dir);
  if (!is_asked && !arguments.question.empty()) {
    return report(
        Failure{Fault::kUsage, "holds a run, which has metrics and no questions", arguments.dir});
  }
  if (is_asked && !arguments.metric.empty()) {
    return report(Failure{Fault::kUsage, "holds answers, which have questions and no metrics",
                          arguments.dir});
  }
  if (is_asked) return why_answers_verb(arguments);
  const auto why = rejudge::why(arguments.dir, arguments.task, arguments.episode, arguments.seed,
                                arguments.metric);
  if (!why) return report(why.failure());
  if (arguments.json) {
    put("{}\n", rejudge::to_json(*why).dump(1));
    return kFine;
  }
  put_words("{} episode {} seed {}, {} steps\n", why->task, why->episode, why->seed, why->steps);
  if (why->invalid)
    put_words("{}{}\n", store::is_not_attempted(*why->invalid) ? "" : "invalid: ", *why->invalid);
  if (why->remark) put_words("the policy says: {}\n", shown(*why->remark));
  for (const rejudge::ClaimWhy& claim : why->claims) {
    std::string denoted;
    for (const std::string& object : claim.denoted)
      denoted += (denoted.empty() ? "" : " and ") + object;
    put_words("\"{}\" is {}: in the settled start it denotes {}\n", claim.text, claim.object,
              denoted.empty() ? "nothing" : denoted);
  }
  // Of what was not attempted there is nothing to judge.
  if (why->steps == 0 && why->invalid && store::is_not_attempted(*why->invalid)) return kFine;
  for (const rejudge::MetricWhy& metric : why->metrics) {
    put_words("\n");
    print_metric(metric);
  }
  if (!why->metrics.empty()) say("`>`: it made the metric what it is; `|`: it did not\n");
  return kFine;
}

}  // namespace

void add_why(Verb app, int& exit) {
  auto arguments = std::make_shared<WhyArguments>();
  Verb verb =
      app.add_subcommand("why",
                         "a verdict explained: source lines with the measured numbers; an answer, "
                         "with what is right and how that is known");
  verb.footer(
      "lines marked > are those that made the metric what it is\n"
      "example: vlaprobe why runs/expert carrot_on_plate 3 --metric success\n"
      "         vlaprobe why answers/qwen carrot_on_plate 3 --question source");
  verb.add_option("DIR", arguments->dir, "results folder, of a run or of answers").required();
  verb.add_option("TASK", arguments->task, "task name").required();
  verb.add_option("EPISODE", arguments->episode, "start, from 0").required();
  verb.add_option("SEED", arguments->seed, "seed (default: the lowest stored)");
  verb.add_option("--metric", arguments->metric, "this one alone");
  verb.add_option("--question", arguments->question, "of a folder of answers: SET.NAME or NAME");
  verb.add_flag("--json", arguments->json, "as a JSON object");
  verb.callback([arguments, &exit] { exit = why_verb(*arguments); });
}

}  // namespace probe::cli
