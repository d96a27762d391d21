// Stage 2, second half: programs' slices, bodies, placements, tasks, episodes, sets, suites,
// sources.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "runtime/plan/isa.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_fields.h"

namespace probe::plan {
namespace {

constexpr std::uint32_t kAllAxes = (static_cast<std::uint32_t>(Axis::kLanguageParaphrase) << 1) - 1;
constexpr std::uint32_t kAllOod = 7;
// A day at 5 Hz is 432,000 steps; more is a unit slip.
constexpr std::uint32_t kMaxHorizon = 1'000'000;
constexpr double kMaxSettle = 60;  // s

class TaskCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() {
    PROBE_TRY(check_finite(t.constants));
    for (const StateRecord& record : t.states) PROBE_TRY(state(record));
    for (const MetricRecord& record : t.metrics) PROBE_TRY(metric(record));
    PROBE_TRY(programs());
    for (const BodyRecord& record : t.bodies) PROBE_TRY(body(record));
    for (const PlacementRecord& record : t.placements) PROBE_TRY(placement(record));
    PROBE_TRY(tasks());
    PROBE_TRY(lists());
    return sources();
  }

 private:
  Status state(const StateRecord& s) const {
    const OpInfo* op = s.kind < 256 ? find_op(static_cast<std::uint8_t>(s.kind)) : nullptr;
    if (op == nullptr || !op->is_monitor())
      return fail(Rule::kStateKind, &s.kind, fmt::format("{:#x} is not a monitor", s.kind));
    const bool counts = op->op == Op::kHOLD;
    if (counts && s.n == 0)
      return fail(Rule::kHoldLength, &s.n, "HOLD holds for at least one step");
    if (!counts && s.n != 0)
      return fail(Rule::kStateLength, &s.n, fmt::format("a state of {} has n = 0", op->name));
    return {};
  }

  Status metric(const MetricRecord& m) const {
    PROBE_TRY(check_word(m.name, "the name of a metric"));
    if (m.type != static_cast<std::uint32_t>(MetricType::kBool) &&
        m.type != static_cast<std::uint32_t>(MetricType::kReal)) {
      return fail(Rule::kMetricType, &m.type, fmt::format("metric type {} is not known", m.type));
    }
    if (m.readout < static_cast<std::uint32_t>(Readout::kAtEnd) ||
        m.readout > static_cast<std::uint32_t>(Readout::kMin)) {
      return fail(Rule::kReadout, &m.readout, fmt::format("readout {} is not known", m.readout));
    }
    return {};
  }

  // Code and states of programs follow one another, so that each instruction is checked once and no
  // work is shared out twice. Constants and metrics may be shared.
  Status programs() const {
    std::uint64_t code = 0, states = 0;
    for (const ProgramRecord& p : t.programs) {
      PROBE_TRY(check_slice(p.constants, t.constants.size(), "CNST"));
      PROBE_TRY(check_slice(p.states, t.states.size(), "STAT"));
      PROBE_TRY(check_slice(p.code, t.code.size(), "CODE"));
      PROBE_TRY(check_slice(p.metrics, t.metrics.size(), "METR"));
      if (p.constants.count > kMaxConstants) {
        return fail(Rule::kConstantCount, &p.constants,
                    fmt::format("a program has at most {} constants", kMaxConstants));
      }
      if (p.metrics.count > kMaxMetrics) {
        return fail(Rule::kMetricCount, &p.metrics,
                    fmt::format("a program has at most {} metrics", kMaxMetrics));
      }
      if (p.code.first != code)
        return fail(Rule::kCodeFollows, &p.code,
                    fmt::format("its code must begin at record {} of CODE", code));
      if (p.states.count > 0 && p.states.first != states) {
        return fail(Rule::kStatesFollow, &p.states,
                    fmt::format("its states must begin at record {} of STAT", states));
      }
      code += p.code.count;
      states += p.states.count;
      const auto metrics = slice_of(t.metrics, p.metrics);
      std::vector<std::string_view> names;
      for (const MetricRecord& m : metrics) names.push_back(t.text(m.name));
      std::ranges::sort(names);
      if (std::ranges::adjacent_find(names) != names.end()) {
        return fail(Rule::kMetricName, &p.metrics, "two metrics of a program have one name");
      }
    }
    if (code != t.code.size())
      return fail(Rule::kCodeOwned, &t.code[code], "an instruction belongs to a program");
    if (states != t.states.size())
      return fail(Rule::kStatesOwned, &t.states[states], "a state belongs to a program");
    return {};
  }

  Status body(const BodyRecord& b) const {
    PROBE_TRY(check_name(b.name, "the name of a body"));
    switch (static_cast<BodyKind>(b.kind)) {
      case BodyKind::kObject:
        return check_index(b.index, t.objects.size(), "OBJT");
      case BodyKind::kSurface:
      case BodyKind::kFixture:
        if (b.index != 0)
          return fail(Rule::kBodyIndex, &b.index, "surface and fixture have index 0");
        return {};
      case BodyKind::kLink:
        return {};
    }
    return fail(Rule::kBodyKind, &b.kind, fmt::format("body kind {} is not known", b.kind));
  }

  Status placement(const PlacementRecord& p) const {
    PROBE_TRY(check_index(p.object, t.objects.size(), "OBJT"));
    PROBE_TRY(check_zero(p.zero));
    PROBE_TRY(check_finite(p.position));
    return check_unit(p.rotation, "the rotation of a placement");
  }

  Status tasks() const {
    std::uint64_t episodes = 0;
    for (std::uint32_t i = 0; i < t.tasks.size(); ++i) {
      PROBE_TRY(task(t.tasks[i]));
      PROBE_TRY(task_views(t.tasks[i]));
      PROBE_TRY(task_bodies(t.tasks[i]));
      PROBE_TRY(task_episodes(i));
      episodes += t.tasks[i].episodes.count;
    }
    if (episodes != t.episodes.size()) {
      return fail(Rule::kEpisodesOwned, t.episodes.data(),
                  fmt::format("tasks name {} episodes, EPIS has {}", episodes, t.episodes.size()));
    }
    PROBE_TRY(check_unique_names(t.tasks, "tasks"));
    return baselines();
  }

  Status task(const TaskRecord& k) const {
    PROBE_TRY(check_word(k.name, "the name of a task"));
    PROBE_TRY(check_name(k.prompt, "an instruction"));
    PROBE_TRY(check_index(k.scene, t.scenes.size(), "SCNE"));
    PROBE_TRY(check_index(k.camera, t.cameras.size(), "CAMR"));
    PROBE_TRY(check_index(k.light, t.lights.size(), "LITE"));
    PROBE_TRY(check_index(k.program, t.programs.size(), "PROG"));
    PROBE_TRY(check_index(k.source, t.objects.size(), "OBJT"));
    PROBE_TRY(check_index(k.target, t.objects.size(), "OBJT"));
    if (k.horizon == 0 || k.horizon > kMaxHorizon) {
      return fail(Rule::kHorizon, &k.horizon,
                  fmt::format("a horizon has 1 to {} steps, not {}", kMaxHorizon, k.horizon));
    }
    if (k.baseline != kNone) PROBE_TRY(check_index(k.baseline, t.tasks.size(), "TASK"));
    if ((k.axes & ~kAllAxes) != 0)
      return fail(Rule::kAxes, &k.axes, fmt::format("axes {:#x} are not all known", k.axes));
    if (k.baseline == kNone && k.axes != 0)
      return fail(Rule::kAxesBaseline, &k.axes, "a task without a baseline differs on no axis");
    if ((k.ood & ~kAllOod) != 0)
      return fail(Rule::kOod, &k.ood, fmt::format("ood bits {:#x} are not all known", k.ood));
    PROBE_TRY(check_zero(k.zero));
    PROBE_TRY(check_text(k.allow));
    PROBE_TRY(check_not_negative(k.drop, "a drop"));
    PROBE_TRY(check_not_negative(k.settle, "a settling time"));
    if (k.settle > kMaxSettle)
      return fail(Rule::kSettle, &k.settle,
                  fmt::format("a settling time is at most {} s, not {}", kMaxSettle, k.settle));
    return check_zero(k.zero2);
  }

  Status task_views(const TaskRecord& k) const {
    PROBE_TRY(check_slice(k.views, t.views.size(), "VIEW"));
    if (k.views.count == 0) return {};
    if (k.views.count > kMaxViews) {
      return fail(Rule::kViewCount, &k.views,
                  fmt::format("a task has at most {} cameras, not {}", kMaxViews, k.views.count));
    }
    const auto views = slice_of(t.views, k.views);
    if (views[0].camera != k.camera || views[0].photo != t.scenes[k.scene].photo) {
      return fail(
          Rule::kViewFirst, &k.views,
          fmt::format("the first camera of task `{}` is not its own before its scene's photo",
                      t.text(k.name)));
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (t.text(views[i].name) != t.text(views[j].name)) continue;
        return fail(Rule::kViewName, &k.views,
                    fmt::format("two cameras of task `{}` are called `{}`", t.text(k.name),
                                t.text(views[i].name)));
      }
    }
    return {};
  }

  // Source, target, distractors, surface, fixture, fingers, other links: the order the judge's code
  // relies on.
  Status task_bodies(const TaskRecord& k) const {
    PROBE_TRY(check_slice(k.bodies, t.bodies.size(), "BODY"));
    const SceneRecord& scene = t.scenes[k.scene];
    const bool has_fixture = scene.fixture_collision != kNone;
    const std::uint64_t objects = 2 + std::uint64_t{k.distractors};
    const std::uint64_t first_link = objects + 1 + (has_fixture ? 1 : 0);
    if (k.bodies.count > kMaxBodies || k.bodies.count < first_link + 2) {
      return fail(Rule::kBodyCount, &k.bodies,
                  fmt::format("task `{}` has {} bodies; with its {} objects it needs {} to {}",
                              t.text(k.name), k.bodies.count, objects, first_link + 2, kMaxBodies));
    }
    const auto bodies = slice_of(t.bodies, k.bodies);
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      const BodyKind wanted = i < objects      ? BodyKind::kObject
                              : i == objects   ? BodyKind::kSurface
                              : i < first_link ? BodyKind::kFixture
                                               : BodyKind::kLink;
      if (bodies[i].kind != static_cast<std::uint32_t>(wanted)) {
        return fail(Rule::kBodyOrder, &bodies[i].kind,
                    fmt::format("body {} of task `{}` has kind {}, wanted is {}", i, t.text(k.name),
                                bodies[i].kind, static_cast<std::uint32_t>(wanted)));
      }
      if (wanted == BodyKind::kLink && bodies[i].index != i - first_link) {
        return fail(Rule::kLinkOrder, &bodies[i].index,
                    "links are numbered from 0, the fingers first");
      }
    }
    if (bodies[0].index != k.source)
      return fail(Rule::kSourceFirst, &bodies[0].index, "the first body is the source");
    if (bodies[1].index != k.target)
      return fail(Rule::kTargetSecond, &bodies[1].index, "the second body is the target");
    const RobotRecord& robot = t.robots[scene.robot];
    for (std::size_t f = 0; f < robot.fingers.size(); ++f) {
      const BodyRecord& finger = bodies[first_link + f];
      if (t.text(finger.name) != t.text(robot.fingers[f].link)) {
        return fail(Rule::kFingerName, &finger.name,
                    fmt::format("link {} is finger `{}`, not `{}`", f,
                                t.text(robot.fingers[f].link), t.text(finger.name)));
      }
    }
    return {};
  }

  Status task_episodes(std::uint32_t index) const {
    const TaskRecord& k = t.tasks[index];
    PROBE_TRY(check_slice(k.episodes, t.episodes.size(), "EPIS"));
    if (k.episodes.count == 0)
      return fail(Rule::kEpisodeCount, &k.episodes,
                  fmt::format("task `{}` has no episode", t.text(k.name)));
    const auto bodies = slice_of(t.bodies, k.bodies);
    std::uint32_t number = 0;
    for (const EpisodeRecord& e : slice_of(t.episodes, k.episodes)) {
      if (e.task != index) {
        return fail(
            Rule::kEpisodeTask, &e.task,
            fmt::format("an episode of task {} stands among those of task {}", e.task, index));
      }
      if (e.index != number)
        return fail(Rule::kEpisodeIndex, &e.index,
                    fmt::format("episode {} says it is episode {}", number, e.index));
      ++number;
      PROBE_TRY(check_zero(e.zero));
      PROBE_TRY(check_slice(e.placements, t.placements.size(), "PLAC"));
      if (e.placements.count != 2 + k.distractors) {
        return fail(Rule::kPlacementCount, &e.placements,
                    fmt::format("an episode places {} objects, its task has {}", e.placements.count,
                                2 + k.distractors));
      }
      for (std::uint32_t i = 0; i < e.placements.count; ++i) {
        const PlacementRecord& p = t.placements[e.placements.first + i];
        if (p.object != bodies[i].index) {
          return fail(Rule::kPlacementObject, &e.placements,
                      fmt::format("placement {} is of object {}, body {} is object {}", i, p.object,
                                  i, bodies[i].index));
        }
      }
    }
    return {};
  }

  Status baselines() const {
    enum class Mark : std::uint8_t { kNew, kOnPath, kDone };
    std::vector<Mark> marks(t.tasks.size(), Mark::kNew);
    for (std::uint32_t start = 0; start < t.tasks.size(); ++start) {
      std::uint32_t at = start;
      for (; at != kNone && marks[at] == Mark::kNew; at = t.tasks[at].baseline)
        marks[at] = Mark::kOnPath;
      if (at != kNone && marks[at] == Mark::kOnPath) {
        return fail(
            Rule::kBaselineCycle, &t.tasks[at].baseline,
            fmt::format("task `{}` is its own baseline in the end", t.text(t.tasks[at].name)));
      }
      for (at = start; at != kNone && marks[at] == Mark::kOnPath; at = t.tasks[at].baseline)
        marks[at] = Mark::kDone;
    }
    return {};
  }

  Status members(const Slice& slice) {
    PROBE_TRY(check_slice(slice, t.list.size(), "LIST"));
    PROBE_TRY(count_list(slice));
    std::unordered_set<std::uint32_t> seen;
    for (const std::uint32_t& task : slice_of(t.list, slice)) {
      PROBE_TRY(check_index(task, t.tasks.size(), "TASK"));
      if (!seen.insert(task).second) {
        return fail(Rule::kMemberTwice, &task,
                    fmt::format("task `{}` is a member twice", t.text(t.tasks[task].name)));
      }
    }
    return {};
  }

  Status count_list(const Slice& slice) {
    listed_ += slice.count;
    if (listed_ > t.list.size())
      return fail(Rule::kSharedList, &slice, "two records share entries of LIST");
    return {};
  }

  Status lists() {
    for (const RobotRecord& r : t.robots) PROBE_TRY(count_list(r.meshes));
    for (const SetRecord& s : t.sets) {
      PROBE_TRY(check_word(s.name, "the name of a set"));
      PROBE_TRY(members(s.members));
    }
    for (const SuiteRecord& s : t.suites) {
      PROBE_TRY(check_word(s.name, "the name of a suite"));
      PROBE_TRY(check_text(s.prefix));
      PROBE_TRY(check_text(s.trained_on));
      PROBE_TRY(members(s.members));
      PROBE_TRY(check_slice(s.seeds, t.list.size(), "LIST"));
      PROBE_TRY(count_list(s.seeds));
      PROBE_TRY(check_zero(s.zero));
    }
    PROBE_TRY(check_unique_names(t.sets, "sets"));
    return check_unique_names(t.suites, "suites");
  }

  Status sources() const {
    for (const TextRecord& text : t.texts) {
      if (std::uint64_t{text.path.offset} + text.path.length > t.text_bytes.size()) {
        return fail(Rule::kTextPath, &text.path, "the path of a text lies inside TXTB");
      }
      PROBE_TRY(check_slice(text.bytes, t.text_bytes.size(), "TXTB"));
    }
    const SpanRecord* previous = nullptr;
    for (const SpanRecord& s : t.spans) {
      const std::size_t sizes[] = {t.code.size(), t.tasks.size(), t.objects.size(),
                                   t.metrics.size()};
      if (s.what < 1 || s.what > std::size(sizes))
        return fail(Rule::kSpanKind, &s.what, fmt::format("span kind {} is not known", s.what));
      PROBE_TRY(check_index(s.index, sizes[s.what - 1], "what the span describes"));
      PROBE_TRY(check_index(s.text, t.texts.size(), "TEXT"));
      if (s.begin > s.end || s.end > t.texts[s.text].bytes.count) {
        return fail(Rule::kSpanRange, &s.begin,
                    fmt::format("bytes {} to {} are no part of a text of {}", s.begin, s.end,
                                t.texts[s.text].bytes.count));
      }
      if (previous != nullptr &&
          std::pair(previous->what, previous->index) > std::pair(s.what, s.index)) {
        return fail(Rule::kSpanOrder, &s, "spans ascend by what they describe");
      }
      previous = &s;
    }
    return {};
  }

  std::uint64_t listed_ = 0;  // entries of LIST that records named so far
};

}  // namespace

Status verify_tasks(std::span<const std::byte> bytes, const Tables& tables) {
  return TaskCheck(bytes, tables).run();
}

}  // namespace probe::plan
