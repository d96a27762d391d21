// Whatever a policy asks for: the largest numbers, limits of joints for a whole episode, shaking, a
// grasp that is wrenched about. A world stays finite, nothing is thrown and nothing goes through
// the table, or the episode is invalid with its reason; and it is the same once more.
//   campaign_policies FILE.. [--for SECONDS | --count N] [--from SEED] [--only SEED]
// A seed is one episode. Exit 0: no finding.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "runtime/plan/plan.h"
#include "runtime/run/policies.h"
#include "runtime/stage/assets.h"
#include "runtime/stage/stage.h"
#include "tests/campaigns/base.h"
#include "tests/campaigns/driver.h"

namespace {

using namespace probe;

constexpr const char* kName = "campaign_policies";

// No hand of these robots is as fast: what is pushed or let go of falls at most from the arm's
// reach.
constexpr double kMostSpeed = 15;  // m/s
constexpr double kSunk = 0.03;     // m below a surface that it stands on, with its middle

constexpr const char* kKinds[] = {
    "the largest numbers", "one way to the limits", "shaking", "any way",
    "down onto the table", "a wrenched grasp"};
constexpr std::size_t kKindCount = std::size(kKinds);

using campaign::Base;

class Hostile {
 public:
  explicit Hostile(std::mt19937_64& random, std::size_t kind) : random_(random), kind_(kind) {
    for (double& way : way_) way = below(2) == 0 ? 1 : -1;
  }
  policy::Action act(int step, std::size_t numbers) {
    policy::Action action = policy::Action::zeros(numbers);
    for (std::size_t i = 0; i < numbers; ++i) {
      const double way = way_[i % way_.size()];
      switch (kind_) {
        case 0:
          action[i] = (below(2) == 0 ? 1 : -1) *
                      // Beyond 1000 an action is none, and the episode ends.
                      (below(2000) == 0 ? std::numeric_limits<double>::max()
                                        : std::array{999.0, 100.0, 10.0, 1.0}[below(4)]);
          break;
        case 1:
          action[i] = way * 100;
          break;
        case 2:
          action[i] = (step % 2 == 0 ? way : -way) * 2;
          break;
        case 4:
          action[i] = i == 2 ? -1 : i + 1 == numbers ? (step / 4 % 2 == 0 ? 1 : -1) : 0.2 * unit();
          break;
        default:
          action[i] = 3 * unit();
      }
    }
    // What is held stays held while it is wrenched.
    if (kind_ == 5 && numbers > 0) action[numbers - 1] = -1;
    return action;
  }

 private:
  std::uint64_t below(std::uint64_t most) { return random_() % most; }
  double unit() { return std::ldexp(static_cast<double>(below(1 << 20)), -19) - 1; }
  std::mt19937_64& random_;
  std::size_t kind_;
  std::array<double, 32> way_{};
};

struct Outcome {
  Sha256 state;
  int steps = 0;
  std::string invalid, wrong;
};

// What must not be of what was just measured; empty: nothing.
std::string amiss(const plan::Plan& plan, const plan::TaskRecord& task, const vm::StepSample& now) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  const auto bodies = plan.bodies(task);
  for (std::size_t i = 0; i < now.bodies.size(); ++i) {
    const vm::BodySample& body = now.bodies[i];
    if (!body.position.allFinite() || !body.velocity.allFinite() || !body.spin.allFinite())
      return "body " + std::to_string(i) + " is not finite";
    if (i >= bodies.size() ||
        static_cast<plan::BodyKind>(bodies[i].kind) != plan::BodyKind::kObject)
      continue;
    const std::string name(plan.text(bodies[i].name));
    if (body.velocity.norm() > kMostSpeed)
      return name + " goes at " + std::to_string(body.velocity.norm()) + " m/s";
    const auto& [left, front, right, back] = scene.area;
    const bool is_over = body.position.x() > left + 0.02 && body.position.x() < right - 0.02 &&
                         body.position.y() > front + 0.02 && body.position.y() < back - 0.02;
    if (is_over && scene.fixture_collision == plan::kNone && scene.fixtures.count == 0 &&
        body.position.z() < scene.surface_z - kSunk)
      return name + " is " + std::to_string(scene.surface_z - body.position.z()) +
             " m below the table";
  }
  for (const vm::JointSample& joint : now.joints) {
    if (!std::isfinite(joint.position) || !std::isfinite(joint.rate))
      return "a joint is not finite";
  }
  for (const vm::ContactSample& contact : now.contacts) {
    if (!contact.push.allFinite()) return "an impulse is not finite";
  }
  return "";
}

Outcome play(const Base& base, std::uint32_t task, std::uint32_t start, std::size_t kind,
             std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Hostile hostile(random, kind);
  Outcome out;
  const auto whole = [&]() -> Status {
    PROBE_ASSIGN(const auto stage,
                 stage::Stage::create(base.plan, task, base.assets, {.pictures = false}));
    PROBE_TRY(stage->reset(start));
    policy::EpisodeStart first = stage->introduction();
    first.draw_seed = seed;
    PROBE_ASSIGN(const auto expert, run::make_policy("expert"));
    const bool has_skill = kind == 5 && expert->begin(first).ok();
    // Of osc_pose a number is a share of what one step may be; what is far beyond is no action.
    const plan::SceneRecord& scene = base.plan.scenes()[base.plan.tasks()[task].scene];
    const bool is_share = base.plan.robots()[scene.robot].control ==
                          static_cast<std::uint32_t>(plan::Control::kOscPose);
    const int wrench_from = 6 + static_cast<int>(random() % 14);
    const int most = std::min<int>(120, static_cast<int>(base.plan.tasks()[task].horizon));
    for (int step = 0; step < most; ++step) {
      PROBE_ASSIGN(const policy::Observation seen, stage->observe());
      policy::Action action;
      if (has_skill && step < wrench_from) {
        const auto acted = expert->act(seen);
        if (acted) action = *acted;
      }
      if (action.size() == 0) {
        action = hostile.act(step, stage->action_space().size());
        if (is_share && seed % 16 != 0) {
          for (double& number : action) number = std::clamp(number, -1.0, 1.0);
        }
      }
      PROBE_TRY(stage->step(action));
      out.steps = stage->steps();
      out.wrong = amiss(base.plan, base.plan.tasks()[task], stage->sample());
      if (!out.wrong.empty()) break;
    }
    out.state = stage->state_hash();
    return {};
  };
  const Status done = whole();
  if (!done.ok()) out.invalid = to_text(done.failure());
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const campaign::Options options = campaign::read_options(kName, argc, argv);
  const std::vector<Base> bases = campaign::bases_of(kName, options);
  return campaign::run(
      options, {},
      [&](campaign::Tally& tally) {
        std::mt19937_64 random(tally.seed);
        const Base& base = bases[random() % bases.size()];
        const auto task = static_cast<std::uint32_t>(random() % base.plan.tasks().size());
        const auto starts = base.plan.episodes(base.plan.tasks()[task]).size();
        const auto start = static_cast<std::uint32_t>(random() % std::max<std::size_t>(1, starts));
        const std::size_t kind = random() % kKindCount;
        const Outcome first = play(base, task, start, kind, tally.seed);
        ++tally.counts[2 * kind + (first.invalid.empty() ? 0 : 1)];
        const std::string what = std::string(base.plan.text(base.plan.tasks()[task].name)) +
                                 " start " + std::to_string(start) + ", " + kKinds[kind] +
                                 ", step " + std::to_string(first.steps) + ": ";
        if (options.count == 1) {
          std::printf("%s%s\n", what.c_str(), first.invalid.c_str());
          std::fflush(stdout);
        }
        if (!first.wrong.empty()) return tally.find(what + first.wrong);
        if (tally.seed % 8 != 0) return;
        const Outcome again = play(base, task, start, kind, tally.seed);
        if (again.state != first.state || again.invalid != first.invalid)
          tally.find(what + "differs when it is done again");
      },
      [](const campaign::Tally& tally) {
        for (std::size_t i = 0; i < kKindCount; ++i)
          std::printf(
              "%-22s %9llu episodes, %llu invalid with a reason\n", kKinds[i],
              static_cast<unsigned long long>(tally.counts[2 * i] + tally.counts[2 * i + 1]),
              static_cast<unsigned long long>(tally.counts[2 * i + 1]));
      });
}
