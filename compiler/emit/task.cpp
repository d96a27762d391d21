// Tasks as records, with their bodies, placements and episodes.
#include <algorithm>

#include "compiler/define/arm_start.h"
#include "compiler/define/camera_shake.h"
#include "compiler/define/fixture.h"
#include "compiler/define/motion.h"
#include "compiler/define/views.h"
#include "compiler/emit/emitter.h"
#include "runtime/plan/limits.h"
#include "runtime/plan/roles.h"

namespace probe::emit {

plan::Slice Emitter::add_bodies(const sema::Scene& scene, const std::vector<lower::Body>& bodies) {
  std::vector<plan::BodyRecord> rows;
  for (const lower::Body& body : bodies) {
    const bool is_object = body.kind == plan::BodyKind::kObject;
    std::uint32_t index = is_object ? objects_[static_cast<ObjectId>(body.index)] : body.index;
    if (body.kind == plan::BodyKind::kPart) {
      const std::uint32_t fixture = fixture_index(scene, static_cast<sema::FixtureId>(body.index));
      index = records().fixtures[fixture].parts.first + body.part;
    }
    rows.push_back({static_cast<std::uint32_t>(body.kind), index, writer_.text(body.name)});
  }
  return plan::append(records().bodies, std::span<const plan::BodyRecord>(rows));
}

plan::Slice Emitter::add_placements(const sema::Start& start, double z) {
  std::vector<plan::PlacementRecord> rows;
  rows.reserve(start.placed.size());
  std::vector<double> key;
  key.reserve(8 * start.placed.size());  // object, position, rotation
  for (const sema::Start::Placed& placed : start.placed) {
    plan::PlacementRecord row;
    row.object = objects_[placed.object];
    row.position = {placed.x, placed.y, placed.z.value_or(z)};
    row.rotation = placed.turn.rotation;
    key.push_back(static_cast<double>(row.object));
    key.insert(key.end(), row.position.begin(), row.position.end());
    key.insert(key.end(), row.rotation.begin(), row.rotation.end());
    rows.push_back(row);
  }
  const auto [at, is_new] = placements_.try_emplace(std::move(key), plan::Slice{});
  if (is_new)
    at->second = plan::append(records().placements, std::span<const plan::PlacementRecord>(rows));
  return at->second;
}

const std::vector<plan::Slice>& Emitter::placements_of(std::span<const sema::Start> starts,
                                                       double z) {
  const auto [at, is_new] = placement_lists_.try_emplace({starts.data(), z});
  if (is_new) {
    at->second.reserve(starts.size());
    for (const sema::Start& start : starts) at->second.push_back(add_placements(start, z));
  }
  return at->second;
}

namespace {

std::uint32_t body_of(const std::vector<lower::Body>& bodies, const sema::OfFixture& part) {
  const auto at = std::ranges::find_if(bodies, [&](const lower::Body& body) {
    return body.kind == plan::BodyKind::kPart && body.part == part.part &&
           body.index == static_cast<std::uint32_t>(part.fixture);
  });
  return static_cast<std::uint32_t>(at - bodies.begin());
}

}  // namespace

// Those of a fixture stand together, in their order.
plan::Slice Emitter::add_roles(const sema::Task& task, const std::vector<lower::Body>& bodies) {
  std::vector<plan::RoleRecord> rows;
  std::vector<std::uint32_t> key;
  const auto is_body = [&](ObjectId id) { return id != ObjectId::kNone && task.is_object(id); };
  std::uint32_t next = is_body(task.source) ? 1 : 0;
  if (is_body(task.target)) ++next;
  const auto add = [&](plan::StringRef name, plan::RoleKind kind, std::size_t count) {
    rows.push_back(
        {name, static_cast<std::uint32_t>(kind), next, static_cast<std::uint32_t>(count), 0, 0});
    key.insert(key.end(), {name.offset, name.length, rows.back().kind, next, rows.back().count});
    next += rows.back().count;
  };
  for (const sema::Task::Filled& filled : task.others) {
    if (!is_body(filled.objects.front())) continue;
    const sema::Role& role = model_.roles[filled.role];
    add(writer_.text(role.name), role.is_set ? plan::RoleKind::kSet : plan::RoleKind::kOne,
        filled.objects.size());
  }
  next += size32(task.distractors);
  if (!task.placed.empty()) add({}, plan::RoleKind::kPlaced, task.placed.size());
  // Roles that parts and regions of fixtures fill stand last and take no bodies of their own.
  for (std::size_t i = 0; i < model_.roles.size(); ++i) {
    const sema::RoleId id = model_.roles.id(i);
    for (const auto& [role, thing] : task.things()) {
      if (role != id) continue;
      const sema::OfFixture& of = *model_.objects[thing].of;
      const bool is_part = of.is_part();
      const auto owner = [&] {
        const std::uint32_t fixture = fixture_index(model_.scenes[task.scene], of.fixture);
        return records().fixtures[fixture].parts.first + of.part;
      };
      next = is_part ? body_of(bodies, of)
                     : region_named(model_.objects[thing].name, plan::BodyKind::kPart, owner());
      add(writer_.text(model_.roles[id].name),
          model_.roles[id].is_set ? plan::RoleKind::kPartOfSet
          : is_part               ? plan::RoleKind::kPart
                                  : plan::RoleKind::kRegion,
          1);
    }
  }
  for (const ObjectId part : task.part_distractors) {
    next = body_of(bodies, *model_.objects[part].of);
    add({}, plan::RoleKind::kPartDistractor, 1);
  }
  if (rows.empty()) return {};
  const auto [at, is_new] = roles_.try_emplace(std::move(key), plan::Slice{});
  if (is_new) at->second = plan::append(records().roles, std::span<const plan::RoleRecord>(rows));
  return at->second;
}

// Nothing where all begin as their fixtures say.
plan::Slice Emitter::add_joint_starts(const sema::Task& task, const sema::Start& start) {
  const std::vector<double> starts = joint_starts_of(model_, task, start);
  std::size_t i = 0;
  bool moved = false;
  for (const sema::FixtureId id : model_.scenes[task.scene].fixtures) {
    for (const sema::Fixture::Joint& joint : model_.fixtures[id].joints)
      moved = moved || joint.start != starts[i++];
  }
  if (!moved) return {};
  const auto [at, is_new] = joint_starts_.try_emplace(starts, plan::Slice{});
  if (is_new) at->second = writer_.reals(starts);
  return at->second;
}

// Nothing where the arm begins as its scene says.
plan::Slice Emitter::add_arm_start(const sema::Task& task, std::size_t index) {
  std::vector<double> start = arm_start_of(model_, task, index);
  if (start.empty()) return {};
  const auto [at, is_new] = arm_starts_.try_emplace(start, plan::Slice{});
  if (is_new) at->second = writer_.reals(start);
  return at->second;
}

// Nothing where the cameras stand as they say.
plan::Slice Emitter::add_shakes(const std::vector<sema::View>& views, std::size_t index) {
  std::vector<double> shakes = shakes_of(model_, views, index);
  if (shakes.empty()) return {};
  const auto [at, is_new] = shakes_.try_emplace(shakes, plan::Slice{});
  if (is_new) at->second = writer_.reals(shakes);
  return at->second;
}

plan::Slice Emitter::add_moves(const sema::Task& task) {
  std::vector<plan::MoveRecord> rows;
  for (const sema::Mover& mover : movers_of(model_, task)) {
    const auto legs = legs_of(*mover.motion, mover.place);
    rows.insert(rows.end(), legs.begin(), legs.end());
  }
  if (rows.empty()) return {};
  return plan::append(records().moves, std::span<const plan::MoveRecord>(rows));
}

void Emitter::add_later(const sema::Task& task, const std::vector<lower::Body>& bodies,
                        std::uint32_t index) {
  for (const sema::LaterSentence& later : task.later) {
    // Behind the last step nothing is said any more.
    const auto program =
        add_program(task, {&later.when, 1}, bodies, task.horizon > 1 ? task.horizon - 1 : 1);
    if (!program) return;  // reported
    // What brings another than the second sentence is waited for when joints have moved.
    const bool is_first = &later == &task.later.front();
    if (is_first && holds_where_it_begins(task, programs_[*program])) {
      diagnostics_
          .report(Code::P0602, task.place(later.when.span),
                  "what brings the next sentence holds where `" + task.name + "` begins")
          .point("the sentence before it is said in one step alone");
    }
    records().later.push_back({index, *program, writer_.text(later.text), {}});
  }
}

// As far as joints of fixtures say, in all of its starts.
bool Emitter::holds_where_it_begins(const sema::Task& task, const lower::Program& condition) const {
  lower::Room room = lower::room_of(model_, task);
  const double hz = model_.robots[model_.scenes[task.scene].robot].control_hz;
  const auto is_true = [&](std::uint64_t horizon) {
    const lower::Findings found = lower::find_constants(condition, horizon, hz, room);
    return std::ranges::any_of(found.constants,
                               [](const lower::ConstantMetric& one) { return one.value; });
  };
  if (room.joints.empty() || is_true(task.horizon)) return false;  // said of the condition itself
  return !task.starts.empty() && std::ranges::all_of(task.starts, [&](const sema::Start& start) {
    const std::vector<double> joints = joint_starts_of(model_, task, start);
    for (std::size_t i = 0; i < joints.size() && i < room.joints.size(); ++i)
      room.joints[i] = {joints[i], joints[i]};
    return is_true(1);
  });
}

void Emitter::add_task(const sema::Task& task) {
  const sema::Scene& scene = model_.scenes[task.scene];
  if (!model_.robots[scene.robot].model) return;
  for (const ObjectId id : task.objects()) add_object(id);
  add_scene(task.scene);
  const std::vector<sema::View> views = views_of(model_, task);
  for (const sema::View& view : views) add_camera(view.camera);
  add_light(light_of(model_, task));
  check_shading(task, views);
  const std::vector<lower::Body> bodies = lower::bodies_of(model_, task);
  if (bodies.size() > plan::kMaxBodies) {
    diagnostics_.report(Situation::kTooManyBodies,
                        task.distractors_span.is_none() ? task.span : task.distractors_span,
                        "`" + task.name + "` has " + std::to_string(bodies.size()) +
                            " bodies with the links of its robot, at most " +
                            std::to_string(plan::kMaxBodies) + " can be judged");
    return;
  }

  const sema::Layout& layout = model_.layouts[task.layout];
  plan::TaskRecord record;
  record.name = writer_.text(task.name);
  record.prompt = writer_.text(task.prompt);
  record.scene = scenes_[task.scene];
  record.camera = cameras_[views.front().camera];
  check_photo(views.front(), task.scene, records().scenes[scenes_[task.scene]].photo);
  if (has_names(views)) record.views = add_views(views, task.scene);
  record.light = lights_[light_of(model_, task)];
  const auto program = add_program(task, task.judged, bodies, task.horizon);
  if (!program) return;
  record.program = *program;
  record.source = objects_[task.source];
  record.target = objects_[task.target];
  record.bodies = add_bodies(model_.scenes[task.scene], bodies);
  record.roles = add_roles(task, bodies);
  record.distractors = size32(task.distractors);
  record.horizon = static_cast<std::uint32_t>(task.horizon);
  record.idle = task.idle;
  record.delay = task.delay;
  record.moves = add_moves(task);
  record.baseline = tasks_[task.baseline];
  record.axes = record.baseline == plan::kNone ? 0 : task.axes;
  record.ood = task.ood;
  if (task.allow_confounded) record.allow = writer_.text(*task.allow_confounded);
  record.drop = layout.drop;
  record.settle = layout.settle;
  const std::uint32_t index = size32(records().tasks);
  record.episodes = {size32(records().episodes), size32(task.starts)};
  const std::vector<plan::Slice>& placements =
      placements_of(task.starts, scene.surface_z + layout.drop);
  plan::Slice joints;
  for (std::size_t e = 0; e < task.starts.size(); ++e) {
    plan::EpisodeRecord episode;
    // Without a file of starts they begin alike in all.
    if (e == 0 || !layout.given_joints.empty()) joints = add_joint_starts(task, task.starts[e]);
    episode.joints = joints;
    episode.arm = add_arm_start(task, e);
    episode.shaken = add_shakes(views, e);
    episode.task = index;
    episode.index = static_cast<std::uint32_t>(e);
    episode.placements = placements[e];
    records().episodes.push_back(episode);
  }
  add_span(plan::SpanKind::kTasks, index, task.span);
  records().tasks.push_back(record);
  add_later(task, bodies, index);
  add_claims(task, bodies, index);
  add_skills(task, bodies, index);
}

}  // namespace probe::emit
