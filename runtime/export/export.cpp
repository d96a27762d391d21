#include "runtime/export/export.h"

#include <memory>

#include "runtime/base/file.h"
#include "runtime/base/glob.h"
#include "runtime/store/episode_key.h"
#include "runtime/store/proof.h"
#include "runtime/store/run_plan.h"

namespace probe::exporting {
namespace {

Result<std::unique_ptr<Sink>> open_sink(const std::string& path, const std::string& temporary,
                                        ExportOptions::Form form) {
  using Form = ExportOptions::Form;
  if (form == Form::kByEnding && path.ends_with(".jsonl")) form = Form::kJsonLines;
  if (form == Form::kByEnding && (path.ends_with(".h5") || path.ends_with(".hdf5")))
    form = Form::kHdf5;
  if (form == Form::kJsonLines) return open_json_lines(temporary);
  if (form == Form::kHdf5) return open_hdf5(temporary);
  return Failure{Fault::kUsage, "traces are exported to a file ending in .jsonl, .h5 or .hdf5",
                 path};
}

Result<ExportReport> write_all(Sink& sink, const std::string& dir, const ExportOptions& options) {
  PROBE_ASSIGN(auto rows, store::read_results(dir));
  PROBE_ASSIGN(const plan::Plan plan, store::open_run_plan(dir));
  ExportReport report;
  for (store::ResultRow& row : rows) {
    if (!matches_glob(options.tasks, row.task)) continue;
    const auto trace = store::prove(plan, row);
    if (!trace) {
      report.refused.push_back(to_text(store::key_of(row)) +
                               " is left out: " + to_text(trace.failure()));
      continue;
    }
    store::add_task(plan, *trace, row);
    PROBE_TRY(sink.episode(row, *trace));
    ++report.episodes;
    report.steps += static_cast<int>(trace->steps.size());
  }
  if (report.episodes == 0 && !report.refused.empty()) {
    return Failure{Fault::kTrace, report.refused.front(), dir};
  }
  if (report.episodes == 0) {
    return Failure{Fault::kUsage, "no stored episode matches `" + options.tasks + "`", dir};
  }
  PROBE_TRY(sink.finish());
  return report;
}

}  // namespace

Result<ExportReport> export_run(const std::string& dir, const std::string& path,
                                const ExportOptions& options) {
  PendingFile pending(path);
  PROBE_ASSIGN(auto sink, open_sink(path, pending.temporary(), options.form));
  auto report = write_all(*sink, dir, options);
  sink.reset();
  if (report) PROBE_TRY(pending.keep());
  return report;
}

}  // namespace probe::exporting
