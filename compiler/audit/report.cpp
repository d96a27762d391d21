// An audit as text and as JSON.
#include <fmt/format.h>

#include <iterator>

#include "compiler/audit/audit.h"
#include "runtime/base/counted.h"
#include "runtime/base/json.h"

namespace probe::audit {
namespace {

constexpr std::size_t kNamed = 6;  // tasks of a rule that are named in the text; JSON has all

std::string list(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kNamed; ++i)
    text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kNamed) text += fmt::format(" and {} more", names.size() - kNamed);
  return text;
}

Json to_json(const std::map<std::string, std::size_t>& counts) {
  Json json = Json::object();
  for (const auto& [name, count] : counts) json[name] = count;
  return json;
}

Json to_json(const RobotFacts& robot) {
  Json json = {{"name", robot.name},       {"law", robot.law},     {"control_hz", robot.control_hz},
               {"fingers", robot.fingers}, {"tasks", robot.tasks}, {"starts", robot.starts}};
  if (robot.fingers > 0) json["grip"] = {{"closed", robot.grip_closed}, {"open", robot.grip_open}};
  json["objects"] = {{"nearest_m", robot.nearest}, {"farthest_m", robot.farthest}};
  json["reach"] = Json();
  if (robot.reach) json["reach"] = {{"near_m", robot.reach->near}, {"far_m", robot.reach->far}};
  json["axes"] = to_json(robot.axes);
  return json;
}

}  // namespace

std::string to_text(const Audit& audit) {
  std::string text;
  const auto out = std::back_inserter(text);
  std::size_t allowed = 0;
  const Finding* last = nullptr;
  for (const Finding& finding : audit.findings) {
    if (last == nullptr || last->kind != finding.kind) {
      fmt::format_to(out, "{}{}\n", last == nullptr ? "" : "\n", title(finding.kind));
    }
    last = &finding;
    fmt::format_to(out, "  {}\n", finding.message);
    if (!finding.place.file.empty()) {
      fmt::format_to(out, "    --> {}:{}:{}\n", finding.place.file, finding.place.line,
                     finding.place.column);
    }
    if (finding.baseline.empty() && !finding.tasks.empty())
      fmt::format_to(out, "    in {}\n", list(finding.tasks));
    if (finding.allowed) fmt::format_to(out, "    allowed: {}\n", *finding.allowed);
    allowed += finding.allowed ? 1 : 0;
  }
  if (!audit.unheld.empty()) {
    fmt::format_to(out, "{}words that nothing is held to\n", audit.findings.empty() ? "" : "\n");
    for (const Unheld& one : audit.unheld) {
      fmt::format_to(out, "  \"{}\": {}\n    --> {}:{}:{}\n    in {}\n", one.words, one.why,
                     one.place.file, one.place.line, one.place.column, list(one.tasks));
    }
    if (audit.findings.empty()) text += '\n';
  }
  if (!audit.unchecked.empty()) {
    fmt::format_to(out, "{}no sets, so not checked: {}\n", audit.findings.empty() ? "" : "\n",
                   fmt::join(audit.unchecked, ", "));
  }
  if (!audit.findings.empty()) text += '\n';
  for (const RobotFacts& robot : audit.robots) text += to_text(robot) + '\n';
  fmt::format_to(
      out,
      "looked at: all words of {} of {} are held to success; success of {} of {} was put to "
      "the test in made-up worlds{}\n",
      audit.held, counted(audit.heard, "task"), audit.tried, counted(audit.heard, "task"),
      audit.untried.empty()
          ? ""
          : ", not that of " + list(audit.untried) +
                ", where it is not known how several things come to be where they belong");
  if (audit.repeated > 0)
    fmt::format_to(out, "{} of {} repeat another start of the same task, to the last bit\n",
                   audit.repeated, counted(audit.starts, "start"));
  fmt::format_to(
      out, "suite `{}`, {}, {}: {}\n", audit.suite, counted(audit.tasks, "task"),
      counted(audit.comparisons, "comparison"),
      audit.findings.empty()
          ? "nothing irregular"
          : fmt::format("{} {}, {} of them allowed with a reason", audit.findings.size(),
                        audit.findings.size() == 1 ? "irregularity" : "irregularities", allowed));
  return text;
}

std::string to_json(const Audit& audit) {
  Json json = {{"suite", audit.suite},
               {"tasks", audit.tasks},
               {"comparisons", audit.comparisons},
               {"findings", Json::array()}};
  for (const Finding& finding : audit.findings) {
    Json entry = {{"kind", name(finding.kind)}};
    if (!finding.code.empty()) entry["code"] = finding.code;
    entry["tasks"] = finding.tasks;
    if (!finding.baseline.empty()) {
      entry["baseline"] = finding.baseline;
      entry["axes"] = finding.axes;
    }
    entry["message"] = finding.message;
    if (!finding.place.file.empty()) {
      entry["file"] = finding.place.file;
      entry["line"] = finding.place.line;
      entry["column"] = finding.place.column;
    }
    entry["allowed"] = finding.allowed ? Json(*finding.allowed) : Json();
    json["findings"].push_back(std::move(entry));
  }
  json["starts"] = audit.starts;
  json["repeated"] = audit.repeated;
  json["tried"] = audit.tried;
  json["untried"] = audit.untried;
  json["held"] = audit.held;
  json["heard"] = audit.heard;
  json["not_held"] = Json::array();
  for (const Unheld& one : audit.unheld) {
    json["not_held"].push_back({{"words", one.words},
                                {"why", one.why},
                                {"tasks", one.tasks},
                                {"file", one.place.file},
                                {"line", one.place.line},
                                {"column", one.place.column}});
  }
  for (const RobotFacts& robot : audit.robots) json["robots"].push_back(to_json(robot));
  if (!audit.unchecked.empty()) json["unchecked"] = audit.unchecked;
  return json.dump(2) + "\n";
}

}  // namespace probe::audit
