// vlaprobe why
#include <fmt/format.h>

#include "runtime/base/json.h"
#include "runtime/base/say.h"
#include "runtime/cli/full/verbs.h"
#include "runtime/rejudge/explain.h"

namespace probe::cli {
namespace {

struct WhyArguments {
  std::string dir, task, metric;
  int episode = 0;
  std::optional<int> seed;
  bool json = false;
};

void print_json(const rejudge::EpisodeWhy& why) {
  Json json = {
      {"task", why.task}, {"episode", why.episode}, {"seed", why.seed}, {"steps", why.steps}};
  json["invalid"] = why.invalid ? Json(*why.invalid) : nullptr;
  json["metrics"] = Json::array();
  for (const rejudge::MetricWhy& metric : why.metrics) {
    Json entry = {{"metric", metric.name},     {"value", metric.value}, {"shown", metric.shown},
                  {"readout", metric.readout}, {"step", metric.step},   {"when", metric.when},
                  {"file", metric.file},       {"line", metric.line}};
    if (metric.is_bool) entry["value"] = metric.value != 0;
    entry["conditions"] = Json::array();
    for (const rejudge::Condition& c : metric.conditions) {
      entry["conditions"].push_back({{"file", c.file},
                                     {"line", c.line},
                                     {"text", c.text},
                                     {"bodies", c.bodies},
                                     {"measured", c.measured},
                                     {"truth", c.is_number ? Json(nullptr) : Json(c.truth)},
                                     {"decides", c.decides},
                                     {"alike", c.alike}});
    }
    json["metrics"].push_back(std::move(entry));
  }
  put("{}\n", json.dump(1));
}

void print_metric(const rejudge::MetricWhy& metric) {
  put("{} = {} {} ({})\n", metric.name, metric.shown, metric.when, metric.readout);
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
    if (!c.file.empty() && (file == nullptr || *file != c.file)) put("  {}\n", c.file);
    file = &c.file;
    // What did not decide stands without the mark.
    put("{:>6} {} {:<{}}  {:<{}}  {}{}\n", c.line > 0 ? std::to_string(c.line) : "",
        c.decides ? '>' : '|', left(c), text_width, c.measured, measured_width,
        c.is_number ? "" : (c.truth ? "true" : "false"),
        c.alike > 0 ? fmt::format("  and {} alike", c.alike) : "");
  }
}

int why_verb(const WhyArguments& arguments) {
  const auto why = rejudge::why(arguments.dir, arguments.task, arguments.episode, arguments.seed,
                                arguments.metric);
  if (!why) return report(why.failure());
  if (arguments.json) {
    print_json(*why);
    return kFine;
  }
  put("{} episode {} seed {}, {} steps\n", why->task, why->episode, why->seed, why->steps);
  if (why->invalid) put("invalid: {}\n", *why->invalid);
  for (const rejudge::MetricWhy& metric : why->metrics) {
    put("\n");
    print_metric(metric);
  }
  return kFine;
}

}  // namespace

void add_why(Verb app, int& exit) {
  auto arguments = std::make_shared<WhyArguments>();
  Verb verb =
      app.add_subcommand("why", "a verdict explained: source lines with the measured numbers");
  verb.footer(
      "lines marked > are those that made the metric what it is\n"
      "example: vlaprobe why runs/expert carrot_on_plate 3 --metric success");
  verb.add_option("DIR", arguments->dir, "results folder").required();
  verb.add_option("TASK", arguments->task, "task name").required();
  verb.add_option("EPISODE", arguments->episode, "start, from 0").required();
  verb.add_option("SEED", arguments->seed, "seed (default: the lowest stored)");
  verb.add_option("--metric", arguments->metric, "this one alone");
  verb.add_flag("--json", arguments->json, "as a JSON object");
  verb.callback([arguments, &exit] { exit = why_verb(*arguments); });
}

}  // namespace probe::cli
