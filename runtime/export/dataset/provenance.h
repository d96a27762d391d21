// What a dataset says of where it is from, in files of ours beside the format's: README.md for
// people; vlaprobe/dataset.json and vlaprobe/demonstrations.jsonl for `vlaprobe export --check`,
// which holds each demonstration against its trace.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/export/dataset/demonstration.h"
#include "runtime/export/dataset/layout.h"
#include "runtime/export/dataset/source.h"

namespace probe::dataset {

inline constexpr const char* kDatasetPath = "vlaprobe/dataset.json";
inline constexpr const char* kDemonstrationsPath = "vlaprobe/demonstrations.jsonl";

class Provenance {
 public:
  // Fails (kIo, naming the file).
  static Result<std::unique_ptr<Provenance>> create(const std::string& dir);
  ~Provenance();
  Provenance(const Provenance&) = delete;
  Provenance& operator=(const Provenance&) = delete;

  // A line: task, episode, seed, run, trace's hash, instruction, wordings, metrics, steps; of a run
  // of `pushed:SIGMA` the steps in which the expert was pushed.
  Status add(const Demonstration& demonstration);

  struct Facts {
    const std::vector<Source>& sources;
    const Shape& shape;
    const DatasetOptions& options;
    std::string rephrase_sha256;  // of the table of wordings; empty: none
  };
  Status finish(const Facts& facts, const Contents& contents,
                const std::vector<std::string>& left_out);

 private:
  Provenance(std::string dir, std::FILE* lines, std::string path)
      : dir_(std::move(dir)), lines_(lines), path_(std::move(path)) {}
  std::string dir_;
  std::FILE* lines_;
  std::string path_;
};

}  // namespace probe::dataset
