// vlaprobe coverage
#include "runtime/inspect/coverage.h"

#include "runtime/cli/plan_table.h"

namespace probe::cli {

void add_coverage(Verb app, int& exit) {
  add_plan_table(app, exit,
                 {.name = "coverage",
                  .about = "how many variants of each base task move each axis",
                  .footer = "of a .probe text also the phrases that no task uses\n"
                            "example: vlaprobe coverage suite/intact.probe",
                  .json = "as a JSON object",
                  .make =
                      [](const LoadedPlan& loaded, std::span<const std::uint32_t> tasks) {
                        auto coverage = inspect::coverage(*loaded.plan, tasks);
                        if (loaded.is_text) coverage["unused_phrases"] = loaded.unused_phrases;
                        return coverage;
                      },
                  .text = inspect::coverage_text});
}

}  // namespace probe::cli
