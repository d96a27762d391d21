// Stored traces for people with other tools: JSON lines, or one HDF5 file. README.md lists the
// names. Nothing reads these back; the trace files are the record.
#pragma once

#include <functional>
#include <string>

#include "runtime/base/result.h"
#include "runtime/store/results.h"
#include "runtime/store/trace.h"

namespace probe::exporting {

struct ExportOptions {
  std::string tasks = "*";  // glob over task names
  enum class Form { kByEnding, kJsonLines, kHdf5 } form = Form::kByEnding;
};

struct ExportReport {
  int episodes = 0;
  int steps = 0;
  std::vector<std::string> refused;  // a sentence for each row that its trace does not bear
};

// Writes `path` whole or not at all; unless a form is asked for, its ending decides: .jsonl, or .h5
// or .hdf5. Rows
// that their traces do not bear are left out and named. Fails with kUsage for another ending or
// when no stored episode matches.
Result<ExportReport> export_run(const std::string& dir, const std::string& path,
                                const ExportOptions& options = {});

// One form of output; episodes come in the stored order.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual Status episode(const store::ResultRow& row, const store::Trace& trace) = 0;
  virtual Status finish() = 0;
};

Result<std::unique_ptr<Sink>> open_json_lines(const std::string& path);
Result<std::unique_ptr<Sink>> open_hdf5(const std::string& path);

}  // namespace probe::exporting
