// A stored episode again, from its actions: its pictures, each the very one that the policy saw, or
// the reason why it is not. One thread's.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "runtime/base/result.h"
#include "runtime/plan/plan.h"
#include "runtime/policy/policy.h"
#include "runtime/stage/stage.h"
#include "runtime/store/trace.h"

namespace probe::dataset {

class Repeater {
 public:
  // `plan` lives as long; the assets are those of every task that is repeated.
  Repeater(const plan::Plan& plan, std::shared_ptr<const stage::SharedAssets> assets)
      : plan_(plan), assets_(std::move(assets)) {}

  // Called once a step, with what the policy was shown and told; valid until it returns.
  using See = std::function<Status(std::span<const stage::CameraFrame> frames,
                                   const policy::Observation& observation, std::size_t step)>;

  // The trace is one of the plan's (store::prove). Fails (kTrace, naming episode and step) when
  // start, picture or state are not the stored ones, bit for bit; and as the stage and `see` do.
  Status repeat(const store::Trace& trace, const See& see);

 private:
  const plan::Plan& plan_;
  std::shared_ptr<const stage::SharedAssets> assets_;
  std::unique_ptr<stage::Stage> stage_;  // of the last episode's task
};

}  // namespace probe::dataset
