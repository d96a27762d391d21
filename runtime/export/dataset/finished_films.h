// Demonstrations whose pictures are drawn and packed, on the disk while an export goes on: one that
// was killed goes on with them. A file each, by the trace's hash; one that was not written whole,
// or is damaged, is as if it were not there.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/export/dataset/demonstration.h"
#include "runtime/export/dataset/layout.h"

namespace probe::dataset {

struct Finished {
  std::vector<Step> steps;
  std::unique_ptr<Film> film;
};

// Any thread's.
class FinishedFilms {
 public:
  // `dir` is there, and holds films of this layout alone, which lives as long.
  FinishedFilms(std::string dir, const Layout& layout) : dir_(std::move(dir)), layout_(layout) {}

  // Of a trace of so many steps.
  std::optional<Finished> find(const std::string& trace_sha256, std::size_t steps) const;
  Status keep(const std::string& trace_sha256, const Finished& finished) const;

 private:
  std::string dir_;
  const Layout& layout_;
};

}  // namespace probe::dataset
