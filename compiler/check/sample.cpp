// P0706: a suite that runs variants without the baselines they are compared with, because a
// `sample` drew the one and not the other, or was of variants alone.
#include <algorithm>
#include <vector>

#include "compiler/check/check.h"

namespace probe::sema {
namespace {

constexpr std::size_t kNamed = 3;

std::string counted(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

// What is lacking of one sample.
struct Lacking {
  std::vector<TaskId> baselines;
  std::size_t tasks = 0, episodes = 0;
  Lacking(const Model& model, const Suite& suite, const Span& sample) {
    for (const CutComparison& cut : suite.cuts) {
      if (cut.sample != sample) continue;
      const TaskId baseline = model.tasks[cut.task].baseline;
      ++tasks;
      episodes += cut.episodes;
      if (std::find(baselines.begin(), baselines.end(), baseline) == baselines.end())
        baselines.push_back(baseline);
    }
  }
  std::string names(const Model& model) const {
    std::string names;
    for (std::size_t i = 0; i < baselines.size() && i < kNamed; ++i)
      names += (i == 0 ? "" : ", ") + model.tasks[baselines[i]].name;
    return names + (baselines.size() > kNamed ? ", ..." : "");
  }
};

}  // namespace

void check_samples(const Model& model, Reporter& reporter) {
  for (const Suite& suite : model.suites) {
    std::vector<Span> said;
    for (const CutComparison& first : suite.cuts) {
      if (std::find(said.begin(), said.end(), first.sample) != said.end()) continue;
      said.push_back(first.sample);
      const Lacking lacking(model, suite, first.sample);
      const bool is_one = (lacking.episodes > 0 ? lacking.episodes : lacking.tasks) == 1;
      const Task& variant = model.tasks[first.task];
      const About about(reporter, suite.span);
      Diagnostic& told = reporter.report(
          Code::P0706, first.sample,
          "suite `" + suite.name + "` runs " +
              (lacking.episodes > 0 ? counted(lacking.episodes, "episode") + " of " +
                                          counted(lacking.tasks, "variant")
                                    : counted(lacking.tasks, "variant")) +
              " of this sample without what " + (is_one ? "it is" : "they are") + " compared with");
      told.point("`" + variant.name + "` without `" + model.tasks[variant.baseline].name + "`")
          .label(suite.span, "run here")
          .help(lacking.episodes > 0
                    ? "end it with `with baselines`: the same starts of " + lacking.names(model)
                    : "add the baselines, `| { " + lacking.names(model) +
                          " }`, or draw from `variants of` what the suite has");
    }
  }
}

}  // namespace probe::sema
