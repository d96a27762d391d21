#include "runtime/inspect/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <map>
#include <vector>

#include "runtime/inspect/axes.h"
#include "runtime/plan/axis_names.h"

namespace probe::inspect {
namespace {

using Json = nlohmann::ordered_json;

struct Row {
  std::size_t variants = 0, confounded = 0;
  std::array<std::size_t, 12> axes{};

  void add(std::uint32_t mask) {
    ++variants;
    confounded += std::popcount(mask) > 1 ? 1 : 0;
    for (std::size_t i = 0; i < axes.size(); ++i)
      axes[i] += (mask & static_cast<std::uint32_t>(plan::kAxisNames[i].axis)) != 0 ? 1 : 0;
  }
  Json to_json() const {
    Json json = {{"variants", variants}, {"confounded", confounded}, {"axes", Json::object()}};
    for (std::size_t i = 0; i < axes.size(); ++i)
      json["axes"][std::string(plan::kAxisNames[i].name)] = axes[i];
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
    used[task.source][kSource] = true;
    used[task.target][kTarget] = true;
    for (const plan::BodyRecord& body : plan.bodies(task).subspan(2, task.distractors))
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

// "language.action" stands in two lines, "language" above "action".
struct Heading {
  std::string group, leaf;
  std::size_t width = 0;
};

Heading heading_of(const std::string& axis) {
  const std::size_t dot = axis.find('.');
  Heading heading;
  heading.group = dot == std::string::npos ? "" : axis.substr(0, dot);
  heading.leaf = dot == std::string::npos ? axis : axis.substr(dot + 1);
  heading.width = std::max(heading.group.size(), heading.leaf.size());
  return heading;
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
    Row& row = rows[base_of(plan, task)];
    if (plan.tasks()[task].baseline == plan::kNone) continue;
    row.add(plan.tasks()[task].axes);
    total.add(plan.tasks()[task].axes);
  }
  Json json = {{"axes", Json::array()}, {"bases", Json::array()}};
  for (const plan::AxisName& axis : plan::kAxisNames) json["axes"].push_back(axis.name);
  std::size_t empty = 0;
  for (const auto& [base, row] : rows) {
    Json entry = {{"task", plan.text(plan.tasks()[base].name)}};
    entry.update(row.to_json());
    json["bases"].push_back(std::move(entry));
    empty += static_cast<std::size_t>(std::count(row.axes.begin(), row.axes.end(), 0u));
  }
  json["total"] = total.to_json();
  json["empty"] = empty;
  json["cells"] = rows.size() * plan::kAxisNames.size();
  json["objects"] = unused_objects(plan, tasks);
  return json;
}

std::string coverage_text(const Json& coverage) {
  std::vector<Heading> headings;
  for (const Json& axis : coverage["axes"]) headings.push_back(heading_of(axis.get<std::string>()));
  std::size_t width = 5;  // "total"
  for (const Json& base : coverage["bases"])
    width = std::max(width, base["task"].get_ref<const std::string&>().size());

  std::string text;
  const auto out = std::back_inserter(text);
  std::string group;
  fmt::format_to(out, "{:<{}}", "", width);
  for (const Heading& heading : headings) {
    fmt::format_to(out, "  {:>{}}", heading.group == group ? "" : heading.group, heading.width);
    group = heading.group;
  }
  fmt::format_to(out, "\n{:<{}}", "base", width);
  for (const Heading& heading : headings)
    fmt::format_to(out, "  {:>{}}", heading.leaf, heading.width);
  text += "  variants  confounded\n";
  const auto row = [&](const std::string& name, const Json& counts) {
    fmt::format_to(out, "{:<{}}", name, width);
    std::size_t column = 0;
    for (const Json& number : counts["axes"]) {
      const std::string shown = number == 0 ? "." : number.dump();
      fmt::format_to(out, "  {:>{}}", shown, headings[column++].width);
    }
    fmt::format_to(out, "  {:>8}  {:>10}\n", counts["variants"].get<std::size_t>(),
                   counts["confounded"].get<std::size_t>());
  };
  for (const Json& base : coverage["bases"]) row(base["task"].get<std::string>(), base);
  row("total", coverage["total"]);
  fmt::format_to(out, "\n{} of {} cells are empty\n", coverage["empty"].get<std::size_t>(),
                 coverage["cells"].get<std::size_t>());
  const Json& objects = coverage["objects"];
  fmt::format_to(out, "objects never a source: {}\n", joined(objects["never_source"]));
  fmt::format_to(out, "objects never a target: {}\n", joined(objects["never_target"]));
  fmt::format_to(out, "objects never a distractor: {}\n", joined(objects["never_distractor"]));
  return text;
}

}  // namespace probe::inspect
