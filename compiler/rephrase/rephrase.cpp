#include "compiler/rephrase/rephrase.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "compiler/rephrase/draw.h"
#include "compiler/rephrase/likeness.h"

namespace probe::rephrase {
namespace {

// Behind `tasks` all others that can be run and have the instruction of one of them.
void add_same_instructions(const sema::Model& model, std::vector<sema::TaskId>& tasks) {
  std::set<std::string> instructions;
  for (const sema::TaskId id : tasks) instructions.insert(model.tasks[id].prompt);
  const std::set<sema::TaskId> chosen(tasks.begin(), tasks.end());
  for (std::size_t i = 0; i < model.tasks.size(); ++i) {
    const sema::TaskId id = model.tasks.id(i);
    const sema::Task& task = model.tasks[id];
    if (!task.abstract && task.complete && instructions.contains(task.prompt) &&
        !chosen.contains(id))
      tasks.push_back(id);
  }
}

// Leaves what is proved of every task that has the same instruction; how many others were there, by
// task.
std::vector<std::uint64_t> keep_common(const sema::Model& model,
                                       std::span<const sema::TaskId> tasks,
                                       std::vector<Proved>& all) {
  std::map<std::string, std::size_t> with;                               // by instruction: tasks
  std::map<std::pair<std::string, std::string>, std::size_t> proved_of;  // and wording: tasks
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::string& instruction = model.tasks[tasks[i]].prompt;
    ++with[instruction];
    for (const Wording& wording : all[i].wordings) ++proved_of[{instruction, wording.text}];
  }
  std::vector<std::uint64_t> dropped;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::string& instruction = model.tasks[tasks[i]].prompt;
    dropped.push_back(std::erase_if(all[i].wordings, [&](const Wording& wording) {
      return proved_of[{instruction, wording.text}] < with[instruction];
    }));
  }
  return dropped;
}

// Of each wording its number, and the smallest are kept: tasks with one instruction keep the same.
std::uint64_t cap(std::vector<Wording>& wordings, const std::string& instruction,
                  const Options& options) {
  if (wordings.size() <= options.per_task) return 0;
  std::vector<std::pair<std::uint64_t, std::size_t>> drawn;
  for (std::size_t i = 0; i < wordings.size(); ++i)
    drawn.emplace_back(draw("keep", options.seed, instruction, wordings[i].text), i);
  std::sort(drawn.begin(), drawn.end());
  drawn.resize(options.per_task);
  std::vector<std::size_t> kept;
  for (const auto& number : drawn) kept.push_back(number.second);
  std::sort(kept.begin(), kept.end());
  const std::uint64_t dropped = wordings.size() - kept.size();
  std::vector<Wording> some;
  for (const std::size_t i : kept) some.push_back(std::move(wordings[i]));
  wordings = std::move(some);
  return dropped;
}

void weigh(TaskWordings& of_task, const Options& options) {
  if (of_task.train == 0) return;
  const auto count = static_cast<double>(of_task.train);
  of_task.original_probability = options.keep_original.value_or(1 / (count + 1));
  for (Line& line : of_task.lines) {
    if (!line.is_held_out) line.probability = (1 - of_task.original_probability) / count;
  }
}

}  // namespace

Rephrased rephrase(const sema::Model& model, std::span<const sema::TaskId> tasks,
                   const std::vector<Evaluation>& not_in, const Options& options) {
  const Evaluations evaluations(not_in);
  std::set<std::string> instructions;  // as likeness() has them
  for (const sema::Task& task : model.tasks) {
    if (!task.abstract && task.complete) instructions.insert(likeness(task.prompt));
  }
  Prover prover(model, options.asset_root);
  // A wording for an instruction holds for all tasks of the text that have it, asked for or not.
  std::vector<sema::TaskId> proved_for(tasks.begin(), tasks.end());
  if (options.by_instruction) add_same_instructions(model, proved_for);
  std::vector<Proved> of_tasks;
  for (const sema::TaskId id : proved_for)
    of_tasks.push_back(prover.prove(model.tasks[id], options.seed));
  std::vector<std::uint64_t> of_some(tasks.size(), 0);
  if (options.by_instruction) of_some = keep_common(model, proved_for, of_tasks);

  Rephrased all;
  all.by_instruction = options.by_instruction;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const sema::TaskId id = tasks[i];
    const sema::Task& task = model.tasks[id];
    Proved& proved = of_tasks[i];
    TaskWordings& of_task = all.tasks.emplace_back();
    of_task.task = id;
    of_task.candidates = proved.candidates;
    of_task.refused = proved.refused;
    of_task.same_words = proved.same_words;
    of_task.not_drawn = proved.not_drawn;
    of_task.of_some_tasks = of_some[i];
    if (options.drop_leaks) {
      of_task.leaks = std::erase_if(proved.wordings, [&](const Wording& wording) {
        return evaluations.find(wording.text).has_value();
      });
    }
    of_task.over_cap = cap(proved.wordings, task.prompt, options);
    for (Wording& wording : proved.wordings) {
      if (!options.drop_leaks) {
        if (auto leak = evaluations.find(wording.text)) {
          ++of_task.leaks;
          all.leaks.push_back({id, wording.text, *std::move(leak)});
        }
      }
      const std::string core = likeness(wording.text);
      const bool is_held_out = !instructions.contains(core) &&
                               draw_share("split", options.seed, core) < options.held_out;
      ++(is_held_out ? of_task.held_out : of_task.train);
      of_task.lines.push_back({std::move(wording), is_held_out, 0});
    }
    weigh(of_task, options);
  }
  return all;
}

}  // namespace probe::rephrase
