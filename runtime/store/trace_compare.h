// A trace writer that writes nothing: it compares an episode, as it is repeated, with a stored
// trace.
#pragma once

#include <string>

#include "runtime/store/trace.h"

namespace probe::store {

class TraceComparer final : public TraceWriter {
 public:
  // `recorded` must live as long.
  explicit TraceComparer(const Trace& recorded) : recorded_(recorded) {}

  // Never fail; the first difference is kept.
  Status start(const TraceStart& start) override;
  Status step(const TraceStep& step) override;
  Result<Sha256> finish(const TraceEnd& end) override;

  // "step 12: q of `waist` is 0.25, recorded 0.5"; empty when all bits agree so far.
  const std::string& difference() const { return difference_; }
  int steps() const { return steps_; }

 private:
  const Trace& recorded_;
  std::string difference_;
  int steps_ = 0;
};

}  // namespace probe::store
