// P0706: a suite that runs variants without the baselines they are compared with, because a
// `sample` drew the one and not the other, or was of variants alone.
#include <algorithm>
#include <vector>

#include "compiler/check/check.h"

namespace probe::sema {

void check_samples(const Model& model, Reporter& reporter) {
  constexpr std::size_t kNamed = 3;
  for (const Suite& suite : model.suites) {
    std::vector<Span> said;
    for (const CutComparison& first : suite.cuts) {
      if (std::find(said.begin(), said.end(), first.sample) != said.end()) continue;
      said.push_back(first.sample);
      std::vector<TaskId> lacking;  // baselines
      std::size_t count = 0;
      for (const CutComparison& cut : suite.cuts) {
        const TaskId baseline = model.tasks[cut.task].baseline;
        if (cut.sample != first.sample) continue;
        ++count;
        if (std::find(lacking.begin(), lacking.end(), baseline) == lacking.end())
          lacking.push_back(baseline);
      }
      std::string names;
      for (std::size_t i = 0; i < lacking.size() && i < kNamed; ++i)
        names += (i == 0 ? "" : ", ") + model.tasks[lacking[i]].name;
      if (lacking.size() > kNamed) names += ", ...";
      const Task& variant = model.tasks[first.task];
      const About about(reporter, suite.span);
      reporter
          .report(Code::P0706, first.sample,
                  "suite `" + suite.name + "` runs " + std::to_string(count) +
                      (count == 1 ? " variant" : " variants") + " of this sample without what " +
                      (count == 1 ? "it is" : "they are") + " compared with")
          .point("`" + variant.name + "` without `" + model.tasks[variant.baseline].name + "`")
          .label(suite.span, "run here")
          .help("add the baselines, `| { " + names +
                " }`, or draw from `variants of` what the suite has");
    }
  }
}

}  // namespace probe::sema
