#include "runtime/report/compare_folders.h"

#include <utility>

#include "runtime/report/knowledge.h"

namespace probe::report {

Result<ComparedFolders> compare_folders(const std::string& a, const std::string& b,
                                        const CompareFoldersOptions& options) {
  const std::vector<std::string> dirs = {a, b};
  PROBE_ASSIGN(Benchmark benchmark,
               load(dirs, {.sets = options.sets, .join = false, .prove = true}));
  if (benchmark.models.size() == 1 && benchmark.policies.size() == 1) {
    return Failure{Fault::kUsage,
                   "one folder holds a run and the other a model's answers: `vlaprobe "
                   "report A B` sets them beside each other",
                   b};
  }
  if (!benchmark.models.empty()) benchmark = models_as_policies(benchmark);
  if (benchmark.policies.size() < 2) {
    return Failure{Fault::kUsage, "is the same folder twice: there is nothing to compare", a};
  }
  PROBE_ASSIGN(Comparison comparison, compare(benchmark, 0, 1, {.metrics = options.metrics}));
  return ComparedFolders{std::move(benchmark), std::move(comparison)};
}

}  // namespace probe::report
