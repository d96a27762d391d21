// Policies of ours behind their handles.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "runtime/api/calls.h"
#include "runtime/api/handles.h"
#include "runtime/run/episode.h"
#include "runtime/run/policies.h"
#include "runtime/run/recorded.h"

struct vlaprobe_policy {
  probe::api::Use::Lock lock;
  std::unique_ptr<probe::policy::Policy> policy;
  std::shared_ptr<probe::api::World> world;  // of its episode; null before the first
  std::uint64_t turn = 0;                    // of that world: World::turn()
};

using namespace probe;
using api::call;
using api::Use;

namespace {

constexpr const char* kPolicy = "policy";

void end(vlaprobe_policy& policy) {
  if (policy.world) policy.policy->end({});
  policy.world.reset();
}

}  // namespace

extern "C" {

int32_t vlaprobe_policy_create(const char* text, vlaprobe_policy** policy, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{text, "text"}, {policy, "policy"}}));
    auto made = std::make_unique<vlaprobe_policy>();
    PROBE_ASSIGN(made->policy, run::make_policy(text, run::policy_context()));
    *policy = made.release();
    return {};
  });
}

void vlaprobe_policy_release(vlaprobe_policy* policy) {
  if (policy == nullptr || policy->lock.process != ::getpid()) return;
  call(nullptr, [&]() -> Status {
    end(*policy);
    return {};
  });
  delete policy;
}

int32_t vlaprobe_policy_begin(vlaprobe_policy* policy, const vlaprobe_stage* stage, int32_t seed,
                              vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{policy, "policy"}, {stage, "stage"}}));
    PROBE_ASSIGN(const Use use, Use::of(policy->lock, kPolicy));
    PROBE_ASSIGN(const Use stage_use, Use::of(const_cast<vlaprobe_stage*>(stage)->lock, "stage"));
    PROBE_TRY(stage->world->check_episode());
    end(*policy);
    const api::World& world = *stage->world;
    const plan::Plan& plan = world.plan().plan();
    const plan::EpisodeRecord& episode =
        plan.episodes(plan.tasks()[world.task()])[static_cast<std::size_t>(world.episode())];
    policy::EpisodeStart start = world.stage().introduction();
    start.seed = seed;
    start.draw_seed = run::draw_seed(seed, Sha256{episode.episode_id});
    policy->world = stage->world;
    policy->turn = world.turn();
    return policy->policy->begin(start);
  });
}

int32_t vlaprobe_policy_act(vlaprobe_policy* policy, vlaprobe_stage* stage, double* action,
                            size_t size, vlaprobe_error* error) {
  return call(error, [&]() -> Status {
    PROBE_TRY(api::needs({{policy, "policy"}, {stage, "stage"}, {action, "action"}}));
    PROBE_ASSIGN(const Use use, Use::of(policy->lock, kPolicy));
    PROBE_ASSIGN(const Use stage_use, Use::of(stage->lock, "stage"));
    if (policy->world != stage->world)
      return api::usage("the policy has begun no episode of this stage: begin comes first");
    if (policy->turn != stage->world->turn()) {
      return api::usage(
          "the stage was reset or restored since the policy began its episode, whose plan is of "
          "what was before: begin comes first");
    }
    if (const std::size_t wanted = stage->world->actions().space.size(); size != wanted) {
      return api::usage("an action has " + std::to_string(wanted) +
                        " numbers, and there is room for " + std::to_string(size));
    }
    PROBE_ASSIGN(const policy::Observation seen, stage->world->observe());
    stage->is_observed = stage->has_pictures;
    PROBE_ASSIGN(const policy::Action said, policy->policy->act(seen));
    if (said.size() != size)
      return Failure{Fault::kPolicy, "an action of " + std::to_string(said.size()) + " numbers",
                     ""};
    std::ranges::copy(said, action);
    return {};
  });
}
}
