#include "compiler/rephrase/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "runtime/base/csv.h"
#include "runtime/plan/axes.h"

namespace probe::rephrase {
namespace {

Json name_of(const sema::Phrase* phrase) { return phrase == nullptr ? Json() : Json(phrase->name); }

constexpr auto kColumns = std::to_array<std::string_view>(
    {"task", "original", "wording", "split", "probability", "original_probability", "template",
     "frame", "source_as", "target_as", "uses", "original_sha256", "wording_sha256",
     "made_from_sha256", "starts_sha256"});
using Cells = std::array<Json, kColumns.size()>;

Json uses_of(const Wording& wording) {
  Json uses = Json::array();
  for (const plan::AxisInfo& axis : plan::kAxisTable) {
    const auto is = [&](const sema::Phrase* phrase) {
      return phrase != nullptr && phrase->axis == axis.axis;
    };
    if (is(wording.source) || is(wording.target)) uses.push_back(axis.word());
  }
  return uses;
}

Cells cells_of(const sema::Model& model, const TaskWordings& of_task, const Line& line,
               const std::string& sources, const Json& starts) {
  const sema::Task& task = model.tasks[of_task.task];
  const sema::Template& say = model.templates[line.wording.say];
  return {task.name,
          task.prompt,
          line.wording.text,
          line.is_held_out ? "held_out" : "train",
          line.probability,
          of_task.original_probability,
          say.name.empty() ? Json() : Json(say.name),
          say.frame,
          name_of(line.wording.source),
          name_of(line.wording.target),
          uses_of(line.wording),
          to_hex(sha256(task.prompt)),
          to_hex(sha256(line.wording.text)),
          sources,
          starts};
}

template <typename Take>
void each_row(const sema::Model& model, const Rephrased& all, const MadeFrom& made_from,
              Take take) {
  const std::string sources = to_hex(made_from.sources);
  for (const TaskWordings& of_task : all.tasks) {
    const auto known = made_from.starts.find(std::string(model.tasks[of_task.task].name));
    const Json starts = known == made_from.starts.end() ? Json() : Json(to_hex(known->second));
    for (const Line& line : of_task.lines) take(cells_of(model, of_task, line, sources, starts));
  }
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return csv_cell(value.text());
  if (!value.is_array()) return value.dump();
  std::string joined;
  for (const Json& element : value) joined += (joined.empty() ? "" : " ") + element.text();
  return csv_cell(joined);
}

Json counts_of(const TaskWordings& of_task) {
  Json reasons = Json::object();
  for (const RefusalInfo& info : kRefusals) {
    if (const std::uint64_t count = of_task.refused[info.refusal]; count > 0)
      reasons[info.word] = count;
  }
  return {
      {"candidates", of_task.candidates},       {"train", of_task.train},
      {"held_out", of_task.held_out},           {"refused", std::move(reasons)},
      {"same_words", of_task.same_words},       {"leaks", of_task.leaks},
      {"of_some_tasks", of_task.of_some_tasks}, {"over_cap", of_task.over_cap + of_task.not_drawn}};
}

std::uint64_t sum_of(const Json& counts) {
  std::uint64_t sum = 0;
  for (const auto& count : counts.items()) sum += count.second.get<std::uint64_t>();
  return sum;
}

}  // namespace

std::string to_json_lines(const sema::Model& model, const Rephrased& all,
                          const MadeFrom& made_from) {
  std::string text;
  each_row(model, all, made_from, [&](const Cells& cells) {
    Json row = Json::object();
    for (std::size_t i = 0; i < cells.size(); ++i) row[kColumns[i]] = cells[i];
    text += row.dump() + "\n";
  });
  return text;
}

std::string to_csv(const sema::Model& model, const Rephrased& all, const MadeFrom& made_from) {
  std::string text;
  for (const std::string_view column : kColumns)
    text += (text.empty() ? "" : ",") + std::string(column);
  text += "\n";
  each_row(model, all, made_from, [&](const Cells& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) text += (i == 0 ? "" : ",") + cell_of(cells[i]);
    text += "\n";
  });
  return text;
}

Json summary(const sema::Model& model, const Rephrased& all, const Options& options) {
  TaskWordings sum;
  Json tasks = Json::array();
  std::size_t without = 0;
  for (const TaskWordings& of_task : all.tasks) {
    const sema::Task& task = model.tasks[of_task.task];
    Json row = {{"task", task.name}, {"original", task.prompt}};
    row.update(counts_of(of_task));
    tasks.push_back(std::move(row));
    without += of_task.lines.empty() ? 1 : 0;
    sum.candidates += of_task.candidates;
    sum.train += of_task.train;
    sum.held_out += of_task.held_out;
    sum.refused.add(of_task.refused);
    sum.same_words += of_task.same_words;
    sum.leaks += of_task.leaks;
    sum.of_some_tasks += of_task.of_some_tasks;
    sum.over_cap += of_task.over_cap;
    sum.not_drawn += of_task.not_drawn;
  }
  Json json = counts_of(sum);
  json["tasks_without"] = without;
  json["seed"] = options.seed;
  json["held_out_share"] = options.held_out;
  json["per_task"] = options.per_task;
  json["keep_original"] = options.keep_original ? Json(*options.keep_original) : Json();
  json["tasks"] = std::move(tasks);
  return json;
}

std::string summary_text(const Json& summary) {
  std::size_t width = 4;
  for (const Json& task : summary["tasks"]) width = std::max(width, task["task"].text().size());
  const auto row = [&](std::string_view name, const auto&... cells) {
    std::string line = fmt::format("{:<{}}", name, width);
    ((line += fmt::format(" {:>10}", cells)), ...);
    return line + "\n";
  };
  const auto counts = [&](std::string_view name, const Json& of) {
    const auto number = [&](const char* key) { return of[key].template get<std::uint64_t>(); };
    return row(name, number("train"), number("held_out"), number("candidates"),
               sum_of(of["refused"]), number("same_words"), number("leaks"), number("over_cap"));
  };
  std::string text =
      row("task", "train", "held out", "candidates", "refused", "same words", "leaks", "over cap");
  for (const Json& task : summary["tasks"]) text += counts(task["task"].text(), task);
  text += counts("all", summary);
  for (const RefusalInfo& info : kRefusals) {
    if (const Json* count = summary["refused"].find(info.word))
      text +=
          fmt::format("refused {:>8}  {}: {}\n", count->get<std::uint64_t>(), info.word, info.text);
  }
  return text;
}

Sha256 sources_hash(const SourceSet& sources) {
  Hasher hasher;
  for (std::size_t i = 0; i < sources.size(); ++i)
    hasher.text(sources.file(FileId{static_cast<std::uint32_t>(i)}).text());
  return hasher.finish();
}

}  // namespace probe::rephrase
