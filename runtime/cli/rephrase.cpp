// vlaprobe rephrase
#include "compiler/rephrase/rephrase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <span>

#include "compiler/diag/text.h"
#include "compiler/emit/analyzed.h"
#include "compiler/emit/compile.h"
#include "compiler/rephrase/published.h"
#include "compiler/rephrase/table.h"
#include "runtime/assets/output_file.h"
#include "runtime/base/asset_root.h"
#include "runtime/base/file.h"
#include "runtime/base/glob.h"
#include "runtime/base/say.h"
#include "runtime/cli/compile.h"
#include "runtime/cli/load.h"
#include "runtime/compile/library.h"
#include "runtime/plan/later.h"
#include "runtime/plan/starts_hash.h"

namespace probe::cli {
namespace {

struct RephraseArguments {
  std::string file, suite, out, format = "vlaprobe", preset;
  std::vector<std::string> not_in;
  std::optional<std::uint32_t> per_task, seed;
  std::string held_out;  // empty: as the preset has it
  bool drop_leaks = false, json = false;
  AssetOptions assets;
};

// A text with its meaning, or the exit code after the reason was printed.
struct Analysed {
  std::optional<AnalyzedText> text;
  int exit = kFine;
};

Analysed analyse(const std::string& file, const AssetOptions& assets,
                 const std::string& suite = {}) {
  const auto root = find_asset_root(root_of(assets));
  if (!root) return {std::nullopt, report(root.failure())};
  const auto library = compile::find_library_folders(assets.library);
  if (!library) return {std::nullopt, report(library.failure())};
  auto text = analyze_text(std::span(&file, 1),
                           {.asset_root = *root, .suite = suite, .library_folders = *library});
  if (!text) return {std::nullopt, report(text.failure())};
  say_briefly(text->compilation, file);
  if (!text->compilation.ok) return {std::nullopt, kUser};
  // Moved, not copied: the tasks' starts are views into the model.
  return {std::move(text).value(), kFine};
}

// The concrete tasks of a text, or the members of one of its suites, that the pattern names.
std::vector<sema::TaskId> choose(const sema::Model& model, const std::string& suite,
                                 const std::string& pattern) {
  std::vector<sema::TaskId> all;
  std::string prefix;
  for (std::size_t i = 0; i < model.tasks.size(); ++i) all.push_back(model.tasks.id(i));
  for (const sema::Suite& known : model.suites) {
    if (suite.empty() || known.name != suite) continue;
    all = known.members;
    prefix = known.prefix;
  }
  std::erase_if(all, [&](sema::TaskId id) {
    const sema::Task& task = model.tasks[id];
    return task.abstract || !task.complete ||
           (!pattern.empty() && !matches_glob(pattern, task.name) &&
            !matches_glob(pattern, prefix + task.name));
  });
  return all;
}

// Texts and tables that were read.
void add_files(const Analysed& analysed, std::vector<std::string>& inputs) {
  const SourceSet& sources = analysed.text->compilation.sources;
  for (std::size_t i = 0; i < sources.size(); ++i)
    inputs.push_back(sources.file(FileId{static_cast<std::uint32_t>(i)}).name());
}

// Every instruction of a text or plan. `inputs` grows by the files that were read.
std::optional<rephrase::Evaluation> evaluation(const std::string& file, const AssetOptions& assets,
                                               std::vector<std::string>& inputs, int& exit) {
  rephrase::Evaluation all{file, {}};
  inputs.push_back(file);
  if (file.ends_with(".probe")) {
    const Analysed analysed = analyse(file, assets);
    exit = analysed.exit;
    if (!analysed.text) return std::nullopt;
    add_files(analysed, inputs);
    for (const sema::Task& task : analysed.text->model.tasks) {
      if (task.abstract || !task.complete) continue;
      all.instructions.push_back({task.prompt, task.name});
      for (const sema::LaterSentence& later : task.later)
        all.instructions.push_back({later.text, task.name});
    }
    return all;
  }
  const auto plan = plan::Plan::open(file);
  if (!plan) {
    exit = report(plan.failure());
    return std::nullopt;
  }
  for (std::uint32_t t = 0; t < plan->tasks().size(); ++t) {
    for (const std::string_view sentence : plan::sentences_of(plan->tables(), t))
      all.instructions.push_back(
          {std::string(sentence), std::string(plan->text(plan->tasks()[t].name))});
  }
  return all;
}

Result<rephrase::Options> options_of(const RephraseArguments& arguments) {
  rephrase::Options options;
  if (arguments.preset == "intact") {
    options.held_out = rephrase::kIntactHeldOut;
    options.per_task = rephrase::kIntactPerTask;
    options.keep_original = rephrase::kIntactKeepOriginal;
  }
  options.seed = arguments.seed.value_or(0);
  options.drop_leaks = arguments.drop_leaks;
  options.by_instruction = arguments.format == "intact";
  options.per_task = arguments.per_task.value_or(options.per_task);
  if (options.per_task < 1 || options.per_task > rephrase::kMostPerTask) {
    return Failure{Fault::kUsage,
                   fmt::format("expected 1 to {} wordings of a task", rephrase::kMostPerTask),
                   "--per-task"};
  }
  if (!arguments.held_out.empty()) {
    char* end = nullptr;
    options.held_out = std::strtod(arguments.held_out.c_str(), &end);
    if (*end != '\0' || !(options.held_out >= 0 && options.held_out <= 1)) {
      return Failure{Fault::kUsage,
                     fmt::format("`{}` is no share between 0 and 1", arguments.held_out),
                     "--held-out"};
    }
  }
  return options;
}

// In which starts the words of these tasks are proved: those of the plan that the text makes.
Result<std::map<std::string, Sha256>> starts_of(const RephraseArguments& arguments,
                                                const sema::Model& model,
                                                const std::vector<sema::TaskId>& tasks) {
  std::set<std::string, std::less<>> names;
  for (const sema::TaskId task : tasks) names.insert(std::string(model.tasks[task].name));
  PROBE_ASSIGN(const AssetRoot root, find_asset_root(root_of(arguments.assets)));
  PROBE_ASSIGN(const auto library, compile::find_library_folders(arguments.assets.library));
  PROBE_ASSIGN(auto built,
               build(std::span(&arguments.file, 1),
                     {.asset_root = root,
                      .library_folders = library,
                      .wants_task = [&](std::string_view task) { return names.contains(task); }}));
  if (!built.ok)
    return Failure{Fault::kUsage,
                   "makes no plan, so it is not known for which starts its words are proved:\n" +
                       render_text(built.diagnostics, built.sources),
                   arguments.file};
  PROBE_ASSIGN(const plan::Plan plan, plan::Plan::from_bytes(std::move(built.plan)));
  std::map<std::string, Sha256> starts;
  for (const plan::TaskRecord& task : plan.tasks())
    starts.emplace(plan.text(task.name), plan::starts_hash(plan, task));
  return starts;
}

// A file in the layout that was asked for, by its name's ending.
Result<std::string> contents(const RephraseArguments& arguments, const AnalyzedText& text,
                             const std::vector<sema::TaskId>& tasks,
                             const rephrase::Rephrased& all) {
  const auto is = [&](const char* ending) { return arguments.out.ends_with(ending); };
  if (arguments.format == "intact") {
    const bool is_pickle = is(".pkl");
    if (!is_pickle && !is(".json"))
      return Failure{Fault::kUsage, "the layout `intact` is .json or .pkl", arguments.out};
    const rephrase::Published published = rephrase::publish(text.model, all);
    say("{} instructions; left out are {} held-out wordings and {} with a full stop\n",
        published.wordings.size(), published.held_out, published.with_stops);
    for (const std::string& original : published.stopped_originals)
      say("left out is \"{}\": the layout separates wordings by full stops\n", original);
    return is_pickle ? to_published_pickle(published) : to_published_json(published);
  }
  if (!is(".jsonl") && !is(".csv"))
    return Failure{Fault::kUsage, "expected a name that ends in .jsonl or .csv", arguments.out};
  rephrase::MadeFrom made_from{rephrase::sources_hash(text.compilation.sources)};
  PROBE_ASSIGN(made_from.starts, starts_of(arguments, text.model, tasks));
  return is(".jsonl") ? rephrase::to_json_lines(text.model, all, made_from)
                      : rephrase::to_csv(text.model, all, made_from);
}

// Says which wordings are instructions of a suite; whether there are any.
bool says_leaks(const sema::Model& model, const rephrase::Rephrased& all) {
  constexpr std::size_t kShown = 20;
  for (std::size_t i = 0; i < std::min(kShown, all.leaks.size()); ++i) {
    const rephrase::FoundLeak& found = all.leaks[i];
    say("vlaprobe: \"{}\" of `{}` is {} of `{}` in {}{}\n", found.wording,
        model.tasks[found.task].name,
        found.leak.is_exact ? "the instruction"
                            : "but for case, articles, signs and order the instruction",
        found.leak.task, found.leak.suite,
        found.leak.is_exact ? "" : fmt::format(" (\"{}\")", found.leak.instruction));
  }
  if (all.leaks.size() > kShown) say("  and {} more\n", all.leaks.size() - kShown);
  if (all.leaks.empty()) return false;
  say("  nothing was written; --drop-leaks leaves them out\n");
  return true;
}

int rephrase_verb(const RephraseArguments& arguments) {
  auto options = options_of(arguments);
  if (!options) return report(options.failure());
  if (!arguments.file.ends_with(".probe")) {
    return report({Fault::kUsage, "expected .probe text: a plan has no templates and phrases",
                   arguments.file});
  }
  const Analysed analysed = analyse(arguments.file, arguments.assets, arguments.suite);
  if (!analysed.text) return analysed.exit;
  options->asset_root = analysed.text->compilation.asset_root;
  std::vector<std::string> inputs = {arguments.file};
  add_files(analysed, inputs);
  const sema::Model& model = analysed.text->model;
  const std::vector<sema::TaskId> tasks = choose(model, arguments.suite, arguments.assets.tasks);
  if (tasks.empty()) {
    return report({Fault::kUsage,
                   arguments.assets.tasks.empty()
                       ? "no task is declared here"
                       : "no task is called like `" + arguments.assets.tasks + "`",
                   arguments.file});
  }
  std::vector<rephrase::Evaluation> not_in;
  for (const std::string& file : arguments.not_in) {
    int exit = kFine;
    auto all = evaluation(file, arguments.assets, inputs, exit);
    if (!all) return exit;
    not_in.push_back(*std::move(all));
  }
  if (const auto fits = assets::check_output(arguments.out, inputs); !fits)
    return report(fits.failure());
  const rephrase::Rephrased all = rephrase::rephrase(model, tasks, not_in, *options);
  if (says_leaks(model, all)) return kUser;
  if (!arguments.out.empty()) {
    const auto text = contents(arguments, *analysed.text, tasks, all);
    if (!text) return report(text.failure());
    if (const auto written = write_file(arguments.out, std::as_bytes(std::span(*text))); !written)
      return report(written.failure());
  }
  const Json summary = rephrase::summary(model, all, *options);
  if (arguments.json) {
    put("{}\n", summary.dump(2));
  } else if (arguments.out.empty()) {
    put("{}", rephrase::summary_text(summary));
  } else {
    say("{}", rephrase::summary_text(summary));
  }
  return kFine;
}

}  // namespace

void add_rephrase(Verb app, int& exit) {
  auto arguments = std::make_shared<RephraseArguments>();
  const rephrase::Options defaults;
  Verb verb = app.add_subcommand(
      "rephrase", "other words for instructions, proved to mean the same, to train on");
  verb.footer(
      "example: vlaprobe rephrase suite/rephrase.probe --not-in suite/beyond.probe --drop-leaks -o "
      "words.jsonl");
  verb.add_option("F", arguments->file, ".probe text").required();
  verb.add_option("--tasks", arguments->assets.tasks, "only tasks whose names match this pattern");
  verb.add_option("--suite", arguments->suite, "only the members of this suite");
  verb.add_option("-o,--out", arguments->out, "file to write; without it counts alone are shown");
  verb.add_option("--format", arguments->format,
                  "vlaprobe: .jsonl or .csv; intact: .json or .pkl as paraphrases_oxe.pkl")
      .one_of({"vlaprobe", "intact"});
  verb.add_option(
          "--preset", arguments->preset,
          fmt::format("intact: {} wordings, none held out, the instruction in half of all draws",
                      rephrase::kIntactPerTask))
      .one_of({"intact"});
  verb.add_option("--per-task", arguments->per_task,
                  fmt::format("at most as many wordings of a task ({})", defaults.per_task));
  verb.add_option("--held-out", arguments->held_out,
                  fmt::format("share that is not to be trained on ({})", defaults.held_out));
  verb.add_option("--seed", arguments->seed, "of the split and of what a cap keeps (0)");
  verb.add_option("--not-in", arguments->not_in,
                  "text or plan none of whose instructions may be among the wordings; repeatable")
      .one_each();
  verb.add_flag("--drop-leaks", arguments->drop_leaks, "leave those out instead of failing");
  verb.add_flag("--json", arguments->json, "counts as a JSON object");
  add_asset_option(verb, arguments->assets);
  verb.refuse_empty_values();
  verb.callback([arguments, &exit] { exit = rephrase_verb(*arguments); });
}

}  // namespace probe::cli
