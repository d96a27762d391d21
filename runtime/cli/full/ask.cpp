// vlaprobe ask
#include "runtime/ask/ask.h"

#include <fmt/format.h>

#include <chrono>

#include "runtime/base/clock.h"
#include "runtime/base/json.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/ask_options.h"
#include "runtime/cli/full/drawn_line.h"
#include "runtime/cli/full/progress.h"
#include "runtime/cli/full/verbs.h"

namespace probe::cli {
namespace {

// A line that is redrawn on a terminal, one now and then elsewhere, and one for each answer that
// went wrong.
class AskPrinter {
 public:
  void operator()(const ask::AskProgress& progress) {
    if (progress.row != nullptr) add(*progress.row);
    const double now = seconds_since(begun_);
    const bool is_last = progress.done + progress.skipped >= progress.total;
    if (const auto columns = DrawnLine::columns()) {
      constexpr double kRedrawEvery = 0.1;  // s
      if (now - told_ < kRedrawEvery && !is_last) return;
      told_ = now;
      std::string line = text(progress, now);
      line.resize(std::min(line.size(), *columns - 1));
      line_.draw(line);
      return;
    }
    constexpr double kOften = 10, kSeldom = 60, kOftenFor = 120;  // s, as `run` says it in a log
    if (told_ >= 0 && now - told_ < (now < kOftenFor ? kOften : kSeldom)) return;
    told_ = now;
    say("{}\n", text(progress, now));
  }
  void clear() { line_.clear(); }

 private:
  void add(const ask::AnswerRow& row) {
    if (!row.invalid) {
      ++valid_;
      if (*row.right) ++right_;
      return;
    }
    ++invalid_;
    constexpr int kToldOneByOne = 20;
    if (invalid_ > kToldOneByOne) return;
    line_.clear();
    say("invalid: {} episode {}, {}.{}: {}\n", row.task, row.episode, row.set, row.family,
        *row.invalid);
  }

  std::string text(const ask::AskProgress& progress, double now) const {
    std::string line =
        fmt::format("{}/{} answers", progress.done + progress.skipped, progress.total);
    if (progress.skipped > 0) line += fmt::format(" ({} were there or left out)", progress.skipped);
    if (invalid_ > 0) line += fmt::format(", {} invalid", invalid_);
    if (valid_ > 0) line += fmt::format(", {} of {} right", right_, valid_);
    const std::int64_t left = progress.total - progress.done - progress.skipped;
    if (left > 0 && progress.done > 0) {
      line += ", " +
              duration_text(now / static_cast<double>(progress.done) * static_cast<double>(left)) +
              " left";
    }
    return line;
  }

  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  double told_ = -1;
  std::int64_t valid_ = 0, right_ = 0, invalid_ = 0;
  DrawnLine line_;
};

void print_ask_summary(const ask::AskSummary& summary) {
  for (const std::string& note : summary.notes) say("note: {}\n", note);
  if (summary.out.empty()) return;
  say("{} answers in {}: {} asked now, {} were there or left out, {} invalid\n", summary.total,
      summary.out, summary.done, summary.skipped, summary.invalid);
  if (summary.left_out > 0) {
    say("{} were left out now: their pictures do not show what is asked; `vlaprobe results {}` "
        "says why\n",
        summary.left_out, summary.out);
  }
  if (summary.done == 0) return;
  say("{} of {} right; {}\n", summary.right, summary.done - summary.invalid,
      ask::to_text(summary.call));
  if (summary.call.retried > 0)
    say("{} attempts that the server spoiled were made again\n", summary.call.retried);
}

Json summary_json(const ask::AskSummary& summary) {
  return {{"out", summary.out},           {"total", summary.total},     {"done", summary.done},
          {"skipped", summary.skipped},   {"invalid", summary.invalid}, {"right", summary.right},
          {"left_out", summary.left_out}, {"notes", summary.notes}};
}

int ask_verb(const AskArguments& arguments) {
  auto options = ask_options(arguments);
  if (!options) return report(options.failure());
  // Before the text is compiled, which may take a while.
  if (auto traits = ask::model_traits(options->model, options->accepts_any_certificate); !traits)
    return report(traits.failure());
  const LoadedPlan loaded = load_asked(arguments, *options);
  if (!loaded.plan) return loaded.exit;
  if (options->accepts_any_certificate) warn_of_insecure(options->model);
  AskPrinter printer;
  options->progress = [&](const ask::AskProgress& progress) { printer(progress); };
  const auto summary = ask::ask(*loaded.plan, *options);
  printer.clear();
  if (!summary) return report(summary.failure());
  print_ask_summary(*summary);
  if (arguments.json) put("{}\n", summary_json(*summary).dump(1));
  return summary->invalid > 0 ? kOutside : kFine;
}

}  // namespace

void add_ask(Verb app, int& exit) {
  auto arguments = std::make_shared<AskArguments>();
  Verb verb = app.add_subcommand("ask", "put a plan's questions to a model that sees and reads");
  verb.footer(more_ask_options(SharedWords::kAsk) +
              "example: vlaprobe ask suite/questions.probe -o answers/qwen --jobs 32 \\\n"
              "           --model 'openai://127.0.0.1:8000?model=Qwen2.5-VL-7B&size=448x336'");
  add_ask_options(verb, *arguments, SharedWords::kAsk);
  verb.add_option("--shard", arguments->shard, "I/N: this call's share; `merge` joins them");
  verb.add_flag("--json", arguments->json, "counts of this call as JSON");
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = ask_verb(*arguments); });
}

}  // namespace probe::cli
