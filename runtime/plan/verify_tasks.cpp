// Stage 2, the records of what is done and judged: programs, metrics, bodies, placements, roles,
// tasks, claims, episodes, sets, suites, sources.
#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "runtime/plan/axes.h"
#include "runtime/plan/isa.h"
#include "runtime/plan/readouts.h"
#include "runtime/plan/roles.h"
#include "runtime/plan/verify.h"
#include "runtime/plan/verify_records.h"

namespace probe::plan {
namespace {

constexpr std::uint32_t kAllOod = (1u << kNovelty.size()) - 1;

}  // namespace

Status RecordCheck::check(const StateRecord& s) const {
  const OpInfo* op = s.kind < 256 ? find_op(static_cast<std::uint8_t>(s.kind)) : nullptr;
  if (op == nullptr || !op->is_monitor())
    return fail(Rule::kStateKind, &s.kind, fmt::format("{:#x} is not a monitor", s.kind));
  const bool counts = op->b == Kind::kTimedState;
  if (counts && s.n == 0)
    return fail(Rule::kHoldLength, &s.n, fmt::format("{} holds for at least one step", op->name));
  if (!counts && s.n != 0)
    return fail(Rule::kStateLength, &s.n, fmt::format("a state of {} has n = 0", op->name));
  return {};
}

Status RecordCheck::check(const ProgramRecord& p) const {
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
  return {};
}

Status RecordCheck::check(const MetricRecord& m) const {
  PROBE_TRY(check_word(m.name, "the name of a metric"));
  if (m.type != static_cast<std::uint32_t>(MetricType::kBool) &&
      m.type != static_cast<std::uint32_t>(MetricType::kReal)) {
    return fail(Rule::kMetricType, &m.type, fmt::format("metric type {} is not known", m.type));
  }
  if (find_readout(m.readout) == nullptr)
    return fail(Rule::kReadout, &m.readout, fmt::format("readout {} is not known", m.readout));
  return {};
}

Status RecordCheck::check(const BodyRecord& b) const {
  PROBE_TRY(check_name(b.name, "the name of a body"));
  switch (static_cast<BodyKind>(b.kind)) {
    case BodyKind::kObject:
      return check_index(b.index, t.objects.size(), "OBJT");
    case BodyKind::kSurface:
    case BodyKind::kFixture:
      if (b.index != 0) return fail(Rule::kBodyIndex, &b.index, "surface and fixture have index 0");
      return {};
    case BodyKind::kLink:
      return {};
    case BodyKind::kPart:
      return check_index(b.index, t.parts.size(), "PART");
  }
  return fail(Rule::kBodyKind, &b.kind, fmt::format("body kind {} is not known", b.kind));
}

Status RecordCheck::check(const PlacementRecord& p) const {
  PROBE_TRY(check_index(p.object, t.objects.size(), "OBJT"));
  PROBE_TRY(check_zero(p.zero));
  PROBE_TRY(check_magnitude(p.position, Magnitude::kPlace));
  return check_unit(p.rotation, "the rotation of a placement");
}

Status RecordCheck::check(const RoleRecord& r) const {
  if (r.kind < static_cast<std::uint32_t>(RoleKind::kOne) ||
      r.kind > static_cast<std::uint32_t>(RoleKind::kPartDistractor))
    return fail(Rule::kRoleKind, &r.kind, fmt::format("role kind {} is not known", r.kind));
  const bool is_none =
      r.kind == static_cast<std::uint32_t>(RoleKind::kPlaced) || is_part_distractor(r);
  PROBE_TRY(check_text(r.name));
  if (!is_none) PROBE_TRY(check_word(r.name, "the name of a role"));
  const std::string_view name = is_none ? "" : t.text(r.name);
  const bool is_end = name == "source" || name == "target";
  const bool is_one_thing = r.kind == static_cast<std::uint32_t>(RoleKind::kPart) ||
                            r.kind == static_cast<std::uint32_t>(RoleKind::kRegion);
  if ((is_none && r.name.length != 0) || (is_end && !is_one_thing) || name == "distractors" ||
      name == "distractor")
    return fail(Rule::kRoleName, &r.name,
                "a role has a name of its own, and what a layout places has none");
  const bool is_one = r.kind == static_cast<std::uint32_t>(RoleKind::kOne) || is_of_thing(r);
  if (r.count == 0 || r.count > kMaxBodies || (is_one && r.count != 1))
    return fail(Rule::kRoleCount, &r.count, fmt::format("{} bodies fill a role", r.count));
  PROBE_TRY(check_zero(r.zero));
  return check_zero({&r.zero2, 1});
}

Status RecordCheck::check(const TaskRecord& k) const {
  PROBE_TRY(check_word(k.name, "the name of a task"));
  PROBE_TRY(check_text(k.prompt));  // a control may say nothing
  PROBE_TRY(check_index(k.scene, t.scenes.size(), "SCNE"));
  PROBE_TRY(check_index(k.camera, t.cameras.size(), "CAMR"));
  PROBE_TRY(check_index(k.light, t.lights.size(), "LITE"));
  PROBE_TRY(check_index(k.program, t.programs.size(), "PROG"));
  if (k.source != kNone) PROBE_TRY(check_index(k.source, t.objects.size(), "OBJT"));
  if (k.target != kNone) PROBE_TRY(check_index(k.target, t.objects.size(), "OBJT"));
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
  PROBE_TRY(check_text(k.allow));
  PROBE_TRY(check_length(k.drop, "a drop"));
  PROBE_TRY(check_not_negative(k.settle, "a settling time"));
  if (k.settle > kMaxSettle)
    return fail(Rule::kSettle, &k.settle,
                fmt::format("a settling time is at most {} s, not {}", kMaxSettle, k.settle));
  PROBE_TRY(check_slice(k.bodies, t.bodies.size(), "BODY"));
  PROBE_TRY(check_slice(k.episodes, t.episodes.size(), "EPIS"));
  PROBE_TRY(check_slice(k.views, t.views.size(), "VIEW"));
  PROBE_TRY(check_slice(k.roles, t.roles.size(), "ROLE"));
  if (k.idle > kMaxIdle)
    return fail(Rule::kIdle, &k.idle,
                fmt::format("a task idles for at most {} steps, not {}", kMaxIdle, k.idle));
  if (k.delay > kMaxDelay)
    return fail(Rule::kDelay, &k.delay,
                fmt::format("an action acts after at most {} steps, not {}", kMaxDelay, k.delay));
  PROBE_TRY(check_slice(k.moves, t.moves.size(), "MOVE"));
  PROBE_TRY(check_zero(k.zero));
  return check_zero(k.zero2);
}

Status RecordCheck::check(const ClaimRecord& c) const {
  PROBE_TRY(check_index(c.task, t.tasks.size(), "TASK"));
  PROBE_TRY(check_index(c.program, t.programs.size(), "PROG"));
  PROBE_TRY(check_zero(c.zero));
  PROBE_TRY(check_name(c.text, "the words of a claim"));
  return check_zero({&c.zero2, 1});
}

Status RecordCheck::check(const LaterRecord& l) const {
  PROBE_TRY(check_index(l.task, t.tasks.size(), "TASK"));
  PROBE_TRY(check_index(l.program, t.programs.size(), "PROG"));
  PROBE_TRY(check_text(l.text));  // a control may say nothing more
  return check_zero(l.zero);
}

Status RecordCheck::check(const EpisodeRecord& e) const {
  PROBE_TRY(check_zero(e.zero));
  PROBE_TRY(check_slice(e.joints, t.reals.size(), "REAL"));
  PROBE_TRY(check_slice(e.arm, t.reals.size(), "REAL"));
  PROBE_TRY(check_slice(e.shaken, t.reals.size(), "REAL"));
  return check_slice(e.placements, t.placements.size(), "PLAC");
}

Status RecordCheck::check(const SetRecord& s) const {
  PROBE_TRY(check_word(s.name, "the name of a set"));
  return check_slice(s.members, t.list.size(), "LIST");
}

Status RecordCheck::check(const SuiteRecord& s) const {
  PROBE_TRY(check_word(s.name, "the name of a suite"));
  PROBE_TRY(check_text(s.prefix));
  PROBE_TRY(check_text(s.trained_on));
  PROBE_TRY(check_slice(s.members, t.list.size(), "LIST"));
  PROBE_TRY(check_slice(s.seeds, t.list.size(), "LIST"));
  PROBE_TRY(check_slice(s.episodes, t.list.size(), "LIST"));
  return check_zero(s.zero);
}

Status RecordCheck::check(const SpanRecord& s) const {
  const auto size = [&]() -> std::optional<std::size_t> {
    switch (static_cast<SpanKind>(s.what)) {
      case SpanKind::kCode:
        return t.code.size();
      case SpanKind::kTasks:
        return t.tasks.size();
      case SpanKind::kObjects:
        return t.objects.size();
      case SpanKind::kMetrics:
        return t.metrics.size();
      case SpanKind::kFamilies:
        return t.families.size();
    }
    return std::nullopt;
  }();
  if (!size)
    return fail(Rule::kSpanKind, &s.what, fmt::format("span kind {} is not known", s.what));
  PROBE_TRY(check_index(s.index, *size, "what the span describes"));
  PROBE_TRY(check_index(s.text, t.texts.size(), "TEXT"));
  if (s.begin > s.end || s.end > t.texts[s.text].bytes.count) {
    return fail(Rule::kSpanRange, &s.begin,
                fmt::format("bytes {} to {} are no part of a text of {}", s.begin, s.end,
                            t.texts[s.text].bytes.count));
  }
  return {};
}

Status RecordCheck::check(const TextRecord& text) const {
  if (std::uint64_t{text.path.offset} + text.path.length > t.text_bytes.size())
    return fail(Rule::kTextPath, &text.path, "the path of a text lies inside TXTB");
  return check_slice(text.bytes, t.text_bytes.size(), "TXTB");
}

}  // namespace probe::plan
