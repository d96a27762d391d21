// Stage 2, last: what records say of one another, when each by itself is good: order, ownership,
// names, the bodies of tasks.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "runtime/plan/roles.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {
namespace {

class RelationCheck : FieldCheck {
 public:
  using FieldCheck::FieldCheck;

  Status run() {
    PROBE_TRY(check_unique_names(t.objects, "objects"));
    PROBE_TRY(programs());
    PROBE_TRY(tasks());
    PROBE_TRY(lists());
    return spans();
  }

 private:
  Status programs() const {
    std::uint64_t code = 0, states = 0;
    for (const ProgramRecord& p : t.programs) {
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
      int ends = 0;
      for (const MetricRecord& m : metrics) {
        names.push_back(t.text(m.name));
        if (m.readout != static_cast<std::uint32_t>(Readout::kEnds)) continue;
        if (m.type != static_cast<std::uint32_t>(MetricType::kBool) || ++ends > 1)
          return fail(Rule::kEndsOnce, &m.readout,
                      "at most one metric of a program ends an episode, and it is a truth");
      }
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

  Status tasks() const {
    std::uint64_t episodes = 0;
    for (std::uint32_t i = 0; i < t.tasks.size(); ++i) {
      PROBE_TRY(task_views(t.tasks[i]));
      PROBE_TRY(task_roles(t.tasks[i]));
      PROBE_TRY(task_bodies(t.tasks[i]));
      PROBE_TRY(task_things(t.tasks[i]));
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

  Status task_views(const TaskRecord& k) const {
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

  // Each role begins where the one before it ends, and what was placed comes behind the
  // distractors.
  Status task_roles(const TaskRecord& k) const {
    std::uint64_t next = (k.source == kNone ? 0 : 1) + (k.target == kNone ? 0 : 1);
    bool is_last = false;
    std::vector<std::string_view> names;
    bool is_thing = false, is_set = false;
    for (const RoleRecord& role : slice_of(t.roles, k.roles)) {
      const std::string_view name = t.text(role.name);
      // Parts of a set follow one another under its name; distractors have none.
      const bool goes_on = role.kind == static_cast<std::uint32_t>(RoleKind::kPartOfSet) &&
                           is_set && !names.empty() && names.back() == name;
      is_set = role.kind == static_cast<std::uint32_t>(RoleKind::kPartOfSet);
      if (!goes_on && !is_part_distractor(role)) names.push_back(name);
      if (is_of_thing(role)) {
        is_thing = true;
        continue;
      }
      if (is_thing)
        return fail(Rule::kRoleOrder, &k.roles,
                    fmt::format("role `{}` of task `{}` stands behind one of a part or region",
                                t.text(role.name), t.text(k.name)));
      const bool is_placed = role.kind == static_cast<std::uint32_t>(RoleKind::kPlaced);
      if (is_placed) next += k.distractors;
      if (is_last || role.first != next)
        return fail(Rule::kRoleOrder, &k.roles,
                    fmt::format("role `{}` of task `{}` begins at body {}, not {}",
                                t.text(role.name), t.text(k.name), role.first, next));
      next += role.count;
      is_last = is_placed;
    }
    std::ranges::sort(names);
    if (std::ranges::adjacent_find(names) != names.end())
      return fail(Rule::kRoleTwice, &k.roles,
                  fmt::format("two roles of task `{}` have one name", t.text(k.name)));
    return {};
  }

  // Wide enough for any counts; once the bodies are there it is TaskRoles::objects.
  std::uint64_t objects_of(const TaskRecord& k) const {
    std::uint64_t objects =
        std::uint64_t{k.distractors} + (k.source == kNone ? 0 : 1) + (k.target == kNone ? 0 : 1);
    for (const RoleRecord& role : slice_of(t.roles, k.roles))
      objects += is_of_thing(role) ? 0 : role.count;
    return objects;
  }

  Status task_bodies(const TaskRecord& k) const {
    const SceneRecord& scene = t.scenes[k.scene];
    const bool has_fixture = scene.fixture_collision != kNone;
    const std::uint64_t objects = objects_of(k);
    const std::uint64_t first_link = objects + 1 + (has_fixture ? 1 : 0);
    std::vector<std::uint32_t> parts;
    for (const std::uint32_t fixture : slice_of(t.list, scene.fixtures)) {
      const Slice& own = t.fixtures[fixture].parts;
      for (std::uint32_t i = 0; i < own.count; ++i) parts.push_back(own.first + i);
    }
    const std::vector<FingerRecord> fingers = fingers_of(t, t.robots[scene.robot]);
    const std::uint64_t least = first_link + fingers.size() + parts.size();
    if (k.bodies.count > kMaxBodies || k.bodies.count < least) {
      return fail(Rule::kBodyCount, &k.bodies,
                  fmt::format("task `{}` has {} bodies; with its {} objects it needs {} to {}",
                              t.text(k.name), k.bodies.count, objects, least, kMaxBodies));
    }
    const auto bodies = slice_of(t.bodies, k.bodies);
    const std::size_t first_part = bodies.size() - parts.size();
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      const BodyKind wanted = i < objects      ? BodyKind::kObject
                              : i == objects   ? BodyKind::kSurface
                              : i < first_link ? BodyKind::kFixture
                              : i < first_part ? BodyKind::kLink
                                               : BodyKind::kPart;
      if (bodies[i].kind != static_cast<std::uint32_t>(wanted)) {
        return fail(Rule::kBodyOrder, &bodies[i].kind,
                    fmt::format("body {} of task `{}` has kind {}, wanted is {}", i, t.text(k.name),
                                bodies[i].kind, static_cast<std::uint32_t>(wanted)));
      }
      if (wanted == BodyKind::kLink && bodies[i].index != i - first_link) {
        return fail(Rule::kLinkOrder, &bodies[i].index,
                    "links are numbered from 0, the fingers first");
      }
      if (wanted == BodyKind::kPart && bodies[i].index != parts[i - first_part]) {
        return fail(Rule::kBodyOrder, &bodies[i].index,
                    fmt::format("body {} of task `{}` is part {}, wanted is {}", i, t.text(k.name),
                                bodies[i].index, parts[i - first_part]));
      }
    }
    const TaskRoles roles = roles_of(t, k);
    if (roles.has_source() && bodies[roles.source].index != k.source)
      return fail(Rule::kSourceFirst, &bodies[roles.source].index, "the first body is the source");
    if (roles.has_target() && bodies[roles.target].index != k.target)
      return fail(Rule::kTargetSecond, &bodies[roles.target].index,
                  "the second body is the target");
    for (std::size_t f = 0; f < fingers.size(); ++f) {
      const BodyRecord& finger = bodies[first_link + f];
      if (t.text(finger.name) != t.text(fingers[f].link)) {
        return fail(Rule::kFingerName, &finger.name,
                    fmt::format("link {} is finger `{}`, not `{}`", f, t.text(fingers[f].link),
                                t.text(finger.name)));
      }
    }
    return {};
  }

  // Parts and regions that fill roles are of fixtures in the scene; source and target are filled
  // once.
  Status task_things(const TaskRecord& k) const {
    const auto bodies = slice_of(t.bodies, k.bodies);
    const auto is_part = [&](const BodyRecord& body) {
      return body.kind == static_cast<std::uint32_t>(BodyKind::kPart);
    };
    std::unordered_set<std::uint32_t> listed;  // parts of sets and distractors
    for (const RoleRecord& role : roles_of(t, k).things) {
      bool is_there = false;
      if (role.kind != static_cast<std::uint32_t>(RoleKind::kRegion)) {
        is_there = role.first < bodies.size() && is_part(bodies[role.first]);
        if (role.kind != static_cast<std::uint32_t>(RoleKind::kPart) &&
            !listed.insert(role.first).second)
          return fail(Rule::kRoleThing, &k.roles,
                      fmt::format("body {} of task `{}` is listed twice", role.first,
                                  t.text(k.name)));
      } else if (role.first < t.regions.size()) {
        const RegionRecord& region = t.regions[role.first];
        is_there = region.kind == static_cast<std::uint32_t>(BodyKind::kPart) &&
                   std::ranges::any_of(bodies, [&](const BodyRecord& body) {
                     return is_part(body) && body.index == region.index;
                   });
      }
      const std::string_view name = t.text(role.name);
      const bool is_twice =
          (name == "source" && k.source != kNone) || (name == "target" && k.target != kNone);
      if (is_there && !is_twice) continue;
      return fail(Rule::kRoleThing, &k.roles,
                  fmt::format("role `{}` of task `{}` {}", name, t.text(k.name),
                              is_twice ? "is filled with an object, too"
                                       : "has no part or region of its scene"));
    }
    return {};
  }

  Status task_episodes(std::uint32_t index) const {
    const TaskRecord& k = t.tasks[index];
    if (k.episodes.count == 0)
      return fail(Rule::kEpisodeCount, &k.episodes,
                  fmt::format("task `{}` has no episode", t.text(k.name)));
    const auto bodies = slice_of(t.bodies, k.bodies);
    const std::uint32_t objects = roles_of(t, k).objects;
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
      if (e.placements.count != objects) {
        return fail(Rule::kPlacementCount, &e.placements,
                    fmt::format("an episode places {} objects, its task has {}", e.placements.count,
                                objects));
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

  // The episodes that a suite runs, where it does not run all of its members'.
  Status drawn(const SuiteRecord& suite) {
    PROBE_TRY(count_list(suite.episodes));
    const auto episodes = slice_of(t.list, suite.episodes);
    if (episodes.empty()) return {};
    const auto members = slice_of(t.list, suite.members);
    std::unordered_set<std::uint32_t> lacking(members.begin(), members.end());
    const std::unordered_set<std::uint32_t> all = lacking;
    for (std::size_t i = 0; i < episodes.size(); ++i) {
      PROBE_TRY(check_index(episodes[i], t.episodes.size(), "EPIS"));
      if (i > 0 && episodes[i] <= episodes[i - 1])
        return fail(Rule::kSuiteEpisodes, &episodes[i], "episodes of a suite do not ascend");
      const std::uint32_t task = t.episodes[episodes[i]].task;
      if (!all.contains(task)) {
        return fail(Rule::kSuiteEpisodes, &episodes[i],
                    fmt::format("suite `{}` runs episode {}, which is of no member",
                                t.text(suite.name), episodes[i]));
      }
      lacking.erase(task);
    }
    if (lacking.empty()) return {};
    return fail(
        Rule::kSuiteEpisodes, &suite.episodes,
        fmt::format("suite `{}` has a member of which it runs no episode", t.text(suite.name)));
  }

  Status lists() {
    for (const RobotRecord& r : t.robots) PROBE_TRY(count_list(r.meshes));
    for (const FixtureRecord& f : t.fixtures) PROBE_TRY(count_list(f.meshes));
    for (const SceneRecord& s : t.scenes) PROBE_TRY(count_list(s.fixtures));
    for (const SetRecord& s : t.sets) PROBE_TRY(members(s.members));
    for (const SuiteRecord& s : t.suites) {
      PROBE_TRY(members(s.members));
      PROBE_TRY(count_list(s.seeds));
      PROBE_TRY(drawn(s));
    }
    PROBE_TRY(check_unique_names(t.sets, "sets"));
    return check_unique_names(t.suites, "suites");
  }

  Status spans() const {
    const auto key = [](const SpanRecord& s) { return std::pair(s.what, s.index); };
    for (std::size_t i = 1; i < t.spans.size(); ++i) {
      if (key(t.spans[i - 1]) > key(t.spans[i]))
        return fail(Rule::kSpanOrder, &t.spans[i], "spans ascend by what they describe");
    }
    return {};
  }

  std::uint64_t listed_ = 0;  // entries of LIST that records named so far
};

}  // namespace

Status verify_relations(std::span<const std::byte> bytes, const Tables& tables) {
  return RelationCheck(bytes, tables).run();
}

}  // namespace probe::plan
