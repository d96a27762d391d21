#include "runtime/inspect/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <map>
#include <vector>

#include "runtime/inspect/axes.h"
#include "runtime/inspect/wrap.h"
#include "runtime/plan/axes.h"
#include "runtime/plan/roles.h"

namespace probe::inspect {
namespace {

struct Row {
  std::size_t tasks = 0, variants = 0, confounded = 0;
  std::array<std::size_t, plan::kAxisTable.size()> axes{};
  std::array<std::size_t, plan::kNovelty.size()> ood{};

  void add_task(const plan::TaskRecord& task) {
    ++tasks;
    for (std::size_t i = 0; i < ood.size(); ++i) ood[i] += (task.ood >> i & 1u) != 0 ? 1 : 0;
    if (task.baseline == plan::kNone) return;
    ++variants;
    confounded += std::popcount(task.axes) > 1 ? 1 : 0;
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i] += plan::moves(task.axes, plan::kAxisTable[i].axis) ? 1 : 0;
  }
  Json to_json() const {
    Json json = {{"variants", variants}, {"confounded", confounded}, {"axes", Json::object()}};
    for (std::size_t i = 0; i < axes.size(); ++i)
      json["axes"][std::string(plan::kAxisTable[i].name)] = axes[i];
    json["tasks"] = tasks;
    for (std::size_t i = 0; i < ood.size(); ++i)
      json["ood"][std::string(plan::kNovelty[i])] = ood[i];
    return json;
  }
};

// The task without a baseline at the end of the chain; a verified plan has no cycles.
std::uint32_t base_of(const plan::Plan& plan, std::uint32_t task) {
  while (plan.tasks()[task].baseline != plan::kNone) task = plan.tasks()[task].baseline;
  return task;
}

Json unused_objects(const plan::Plan& plan, std::span<const std::uint32_t> tasks) {
  enum Use { kSource, kTarget, kDistractor };
  std::vector<std::array<bool, 3>> used(plan.objects().size());
  for (const std::uint32_t index : tasks) {
    const plan::TaskRecord& task = plan.tasks()[index];
    if (task.source != plan::kNone) used[task.source][kSource] = true;
    if (task.target != plan::kNone) used[task.target][kTarget] = true;
    const plan::Slice others = plan::roles_of(plan.tables(), task).distractors;
    for (const plan::BodyRecord& body : plan.bodies(task).subspan(others.first, others.count))
      used[body.index][kDistractor] = true;
  }
  const auto never = [&](Use use) {
    Json names = Json::array();
    for (std::size_t o = 0; o < used.size(); ++o) {
      if (!used[o][use]) names.push_back(plan.text(plan.objects()[o].name));
    }
    return names;
  };
  return {{"never_source", never(kSource)},
          {"never_target", never(kTarget)},
          {"never_distractor", never(kDistractor)}};
}

std::string joined(const Json& words) {
  std::string text;
  for (const Json& word : words) text += (text.empty() ? "" : ", ") + word.get<std::string>();
  return text.empty() ? "none" : text;
}

}  // namespace

Json coverage(const plan::Plan& plan, std::span<const std::uint32_t> tasks) {
  std::map<std::uint32_t, Row> rows;  // by base, in the order of the plan
  Row total;
  for (const std::uint32_t task : tasks) {
    rows[base_of(plan, task)].add_task(plan.tasks()[task]);
    total.add_task(plan.tasks()[task]);
  }
  Json json = {{"axes", Json::array()}, {"bases", Json::array()}};
  for (const plan::AxisInfo& axis : plan::kAxisTable) json["axes"].push_back(axis.name);
  std::size_t empty = 0;
  for (const auto& [base, row] : rows) {
    Json entry = {{"task", plan.text(plan.tasks()[base].name)}};
    entry.update(row.to_json());
    json["bases"].push_back(std::move(entry));
    empty += static_cast<std::size_t>(std::count(row.axes.begin(), row.axes.end(), 0u));
  }
  json["total"] = total.to_json();
  json["empty"] = empty;
  json["cells"] = rows.size() * plan::kAxisTable.size();
  json["objects"] = unused_objects(plan, tasks);
  return json;
}

namespace {

struct Column {
  std::string heading;
  const Json* counts;
};

std::string number(const Json& count) { return count == 0 ? "." : count.dump(); }

// One column a base, as many as fit on a screen.
void table(const Json& coverage, std::span<const Column> columns, std::string& text) {
  constexpr std::size_t kNameWidth = 20;  // "language.commonsense"
  const auto out = std::back_inserter(text);
  const auto line = [&](const std::string& name, const auto& cell) {
    fmt::format_to(out, "{:<{}}", name, kNameWidth);
    for (const Column& column : columns)
      fmt::format_to(out, "  {:>{}}", cell(column), column.heading.size());
    text += '\n';
  };
  line("", [](const Column& column) { return column.heading; });
  for (const Json& axis : coverage["axes"]) {
    const std::string name = axis.get<std::string>();
    line(name, [&](const Column& c) { return number((*c.counts)["axes"][name]); });
  }
  for (const char* name : {"variants", "confounded"})
    line(name, [&](const Column& c) { return number((*c.counts)[name]); });
  for (const std::string_view novelty : plan::kNovelty) {
    line(fmt::format("ood {}", novelty),
         [&](const Column& c) { return number((*c.counts)["ood"][std::string(novelty)]); });
  }
  line("tasks", [](const Column& c) { return number((*c.counts)["tasks"]); });
}

}  // namespace

std::string coverage_text(const Json& coverage) {
  constexpr std::size_t kScreen = 100, kNames = 20;
  std::vector<Column> columns;
  for (const Json& base : coverage["bases"])
    columns.push_back({base["task"].get<std::string>(), &base});
  columns.push_back({"total", &coverage["total"]});
  std::string text;
  for (std::size_t first = 0; first < columns.size();) {
    std::size_t width = kNames, count = 0;
    while (first + count < columns.size()) {
      width += 2 + columns[first + count].heading.size();
      if (count > 0 && width > kScreen) break;
      ++count;
    }
    if (first > 0) text += '\n';
    table(coverage, std::span(columns).subspan(first, count), text);
    first += count;
  }
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "\n{} of {} cells are empty\n", coverage["empty"].get<std::size_t>(),
                 coverage["cells"].get<std::size_t>());
  const Json& objects = coverage["objects"];
  const auto list = [&](const char* what, const Json& words) {
    text += wrapped(fmt::format("{}: {}", what, joined(words)), kScreen) + "\n";
  };
  list("objects never a source", objects["never_source"]);
  list("objects never a target", objects["never_target"]);
  list("objects never a distractor", objects["never_distractor"]);
  if (coverage.contains("unused_phrases"))
    list("phrases that no task uses", coverage["unused_phrases"]);
  return text;
}

}  // namespace probe::inspect
