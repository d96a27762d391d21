// `fixture` as a text says it, and where joints begin. What its URDF says is fixture_model.cpp.
#include "compiler/define/fixture.h"

#include <algorithm>
#include <span>

#include "compiler/define/define.h"
#include "compiler/define/fixture_model.h"
#include "compiler/define/record.h"
#include "compiler/geometry/pose.h"
#include "compiler/names/quantities.h"
#include "compiler/names/texts.h"
#include "runtime/base/utf8.h"
#include "runtime/plan/regions.h"

namespace probe::sema {
namespace {

using Said = Fixture::Said;

// Whether it turns or slides is known only with the URDF; the unit says which is meant.
std::optional<Quantity> read_either(Context& context,
                                    const std::optional<syntax::Quantity>& written,
                                    const Dimension& turning, const Dimension& sliding,
                                    const Takes& takes) {
  if (!written) return std::nullopt;
  const auto unit = make_quantity("0", to_text(written->unit));
  const bool turns = unit && unit->dimension == turning;
  return read_quantity(context, *written, turns ? turning : sliding, takes);
}

struct FixtureReader {
  Context& context;
  const syntax::File& file;
  Fixture& fixture;

  void operator()(const syntax::UrdfStmt& stmt) { fixture.urdf = spelled(stmt.path); }
  void operator()(const syntax::FixtureAtStmt& stmt) {
    fixture.has_place = true;
    assign(fixture.position, read_point(context, stmt.at, 3, 3, dim::kLength,
                                        {"`at` takes lengths", plan::Magnitude::kPlace}));
    fixture.turn = {};
    if (!stmt.turn) return;
    if (const auto turn = read_turn(context, *stmt.turn)) fixture.turn = *turn;
  }
  void operator()(const syntax::FrictionStmt& stmt) {
    fixture.friction = read_positive(context, stmt.value, dim::kNumber,
                                     {"`friction` takes a number", plan::Magnitude::kFriction})
                           .value_or(1);
  }
  void not_negative(const std::optional<Quantity>& value, const syntax::Quantity& written) {
    if (value && value->si() < 0)
      context.report(Situation::kNegative, written.span, "expected 0 or more");
  }
  void operator()(const syntax::FixtureJointStmt& stmt) {
    Said said;
    said.joint = spelled(stmt.joint);
    said.span = stmt.span;
    said.stay = stmt.stay;
    said.friction = read_either(context, stmt.friction, dim::kTorque, dim::kForce,
                                {"`friction` of a joint is in N, or in Nm where it turns",
                                 plan::Magnitude::kJointFriction});
    said.damping =
        read_either(context, stmt.damping, dim::kAngularDamping, dim::kLinearDamping,
                    {"`damping` is in Ns/m, or in Nms/rad where it turns", plan::Magnitude::kGain});
    said.stiffness =
        read_either(context, stmt.stiffness, dim::kAngularStiffness, dim::kLinearStiffness,
                    {"`stiffness` is in N/m, or in Nm/rad where it turns", plan::Magnitude::kGain});
    said.rest = read_either(context, stmt.rest, dim::kAngle, dim::kLength,
                            {"a spring rests at a length, or at an angle where it turns",
                             plan::Magnitude::kJointPosition});
    said.armature =
        read_either(context, stmt.armature, dim::kInertia, dim::kMass,
                    {"`armature` is in kg, or in kgm2 where it turns", plan::Magnitude::kArmature});
    said.start = read_either(context, stmt.start, dim::kAngle, dim::kLength,
                             {"a joint starts at a length, or at an angle where it turns",
                              plan::Magnitude::kJointPosition});
    if (stmt.friction) not_negative(said.friction, *stmt.friction);
    if (stmt.damping) not_negative(said.damping, *stmt.damping);
    if (stmt.stiffness) not_negative(said.stiffness, *stmt.stiffness);
    if (stmt.armature) not_negative(said.armature, *stmt.armature);
    if (stmt.start) said.start_span = stmt.start->span;
    std::erase_if(fixture.said, [&](const Said& old) { return old.joint.text == said.joint.text; });
    fixture.said.push_back(std::move(said));
  }
  void operator()(const syntax::PartStmt& stmt) {
    Fixture::Part part;
    part.name = std::string(stmt.name.text);
    part.span = stmt.name.span;
    part.link = spelled(stmt.link);
    part.declared = true;
    part.said = &stmt;
    part.file = &file;
    if (stmt.text) {
      part.text = spelled(*stmt.text);
      if (is_blank(part.text.text))
        context.report(Situation::kNoWords, part.text.span, "a part's name has no words");
      check_text(context.diagnostics, part.text, "a part's name");
    }
    std::erase_if(fixture.named, [&](const Fixture::Part& old) { return old.name == part.name; });
    fixture.named.push_back(std::move(part));
  }
  void operator()(const syntax::ShownStmt& stmt) {
    Fixture::Shown shown;
    shown.link = spelled(stmt.link);
    shown.joint = spelled(stmt.joint);
    shown.from_below = stmt.from_below;
    shown.value = read_either(context, stmt.value, dim::kAngle, dim::kLength,
                              {"a joint stands at a length, or at an angle where it turns",
                               plan::Magnitude::kJointPosition});
    shown.value_span = stmt.value.span;
    std::erase_if(fixture.shown,
                  [&](const Fixture::Shown& old) { return old.link.text == shown.link.text; });
    fixture.shown.push_back(std::move(shown));
  }
  void operator()(const syntax::RegionStmt& stmt) {
    const auto region = read_region(context, stmt);
    if (!region) return;
    std::erase_if(fixture.regions,
                  [&](const Fixture::OwnRegion& old) { return old.region.name == region->name; });
    Spelled of = spelled(*stmt.of);
    if (of.text == fixture.name) of.text.clear();  // a copy has another name
    Fixture::OwnRegion own{*region, std::move(of), 0, {}, ObjectId::kNone};
    if (stmt.text) {
      own.text = spelled(*stmt.text);
      if (is_blank(own.text.text))
        context.report(Situation::kNoWords, own.text.span, "a region's name has no words");
      check_text(context.diagnostics, own.text, "a region's name");
    }
    fixture.regions.push_back(std::move(own));
  }
};

}  // namespace

std::optional<Region> read_region(Context& context, const syntax::RegionStmt& stmt) {
  Region region;
  region.name = std::string(stmt.name.text);
  region.span = stmt.name.span;
  check_name(context.diagnostics, stmt.name);
  const Takes takes{"a region's box takes lengths", plan::Magnitude::kPlace};
  const auto low = read_point(context, stmt.low, 3, 3, dim::kLength, takes);
  const auto high = read_point(context, stmt.high, 3, 3, dim::kLength, takes);
  if (!low || !high) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    region.low[i] = (*low)[i].si();
    region.high[i] = (*high)[i].si();
    if (region.low[i] < region.high[i]) continue;
    context.report(Situation::kCornersSwapped, join(stmt.low.span, stmt.high.span),
                   "the second corner of a region lies above the first on every axis");
    return std::nullopt;
  }
  if (!stmt.at) return region;
  const auto at = read_point(context, *stmt.at, 3, 3, dim::kLength,
                             {"a region stands at lengths", plan::Magnitude::kPlace});
  Turn turn;
  if (stmt.turn) {
    const auto read = read_turn(context, *stmt.turn);
    if (!read) return std::nullopt;
    turn = *read;
  }
  if (!at) return std::nullopt;
  Vec3 middle = Vec3::Zero(), half = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    middle[axis] = (region.low[i] + region.high[i]) / 2;
    half[axis] = (region.high[i] - region.low[i]) / 2;
    region.low[i] += (*at)[i].si();
    region.high[i] += (*at)[i].si();
  }
  if (turn == Turn{}) return region;
  middle = pose_of({(*at)[0].si(), (*at)[1].si(), (*at)[2].si()}, turn.rotation).apply(middle);
  region.turned = plan::TurnedBox{
      {middle.x(), middle.y(), middle.z()}, {half.x(), half.y(), half.z()}, turn.rotation};
  plan::box_around(*region.turned, region.low, region.high);
  return region;
}

void put_region(std::vector<Region>& regions, Region region) {
  std::erase_if(regions, [&](const Region& old) { return old.name == region.name; });
  regions.push_back(std::move(region));
}

bool read_start(Context& context, const syntax::StartStmt& stmt, const Span& decl,
                std::vector<JointStart>& starts) {
  if (stmt.fixture.text.empty()) {
    std::erase_if(starts, [&](const JointStart& old) { return !is_within(old.span, decl); });
    return true;
  }
  const auto index = context.symbols.fixtures.find(stmt.fixture, context.diagnostics);
  if (!index) return false;
  const auto id = static_cast<FixtureId>(*index);
  const Fixture& fixture = context.model.fixtures[id];
  if (fixture.broken) return false;
  std::vector<std::string_view> names;
  for (std::uint32_t i = 0; i < fixture.joints.size(); ++i) {
    const Fixture::Joint& joint = fixture.joints[i];
    names.push_back(joint.name);
    if (joint.name != stmt.joint.text) continue;
    const auto is_it = [&](const JointStart& old) { return old.fixture == id && old.joint == i; };
    if (stmt.none) {
      std::erase_if(starts, is_it);
      return true;
    }
    const auto value = read_si(
        context, stmt.value, joint.slides ? dim::kLength : dim::kAngle,
        {joint.slides ? "this joint slides" : "this joint turns", plan::Magnitude::kJointPosition});
    if (!value) return false;
    if (!is_within(joint, *value)) {
      outside(context, stmt.value.span, joint, *value);
      return false;
    }
    std::erase_if(starts, is_it);
    starts.push_back({id, i, *value, stmt.span});
    return true;
  }
  report_unknown(context.diagnostics, "joint of `" + fixture.name + "`", stmt.joint, names)
      .label(fixture.span, "the fixture");
  return false;
}

namespace {

std::vector<double> joint_starts(const Model& model, const Task& task,
                                 std::span<const GivenJoint> given) {
  std::vector<double> all;
  for (const FixtureId id : model.scenes[task.scene].fixtures) {
    const Fixture& fixture = model.fixtures[id];
    for (std::uint32_t i = 0; i < fixture.joints.size(); ++i) {
      double at = fixture.joints[i].start;
      const auto take = [&](const auto& starts) {
        for (const auto& start : starts) {
          if (start.fixture == id && start.joint == i) at = start.value;
        }
      };
      take(model.layouts[task.layout].joint_starts);
      take(given);
      take(task.joint_starts);
      all.push_back(at);
    }
  }
  return all;
}

}  // namespace

std::vector<double> joint_starts_of(const Model& model, const Task& task) {
  return joint_starts(model, task, {});
}

std::vector<double> joint_starts_of(const Model& model, const Task& task, const Start& start) {
  const Layout& layout = model.layouts[task.layout];
  if (layout.given_joints.empty()) return joint_starts_of(model, task);
  return joint_starts(model, task, layout.given_joints[start.given]);
}

std::vector<double> joint_starts_in_all(const Model& model, const Task& task) {
  const Layout& layout = model.layouts[task.layout];
  const auto is_fixture = [](const GivenJoint& joint) { return joint.robot == RobotId::kNone; };
  if (layout.given_joints.empty() ||
      std::ranges::none_of(layout.given_joints.front(), is_fixture)) {
    return joint_starts_of(model, task);
  }
  std::vector<double> all;
  for (const std::vector<GivenJoint>& given : layout.given_joints) {
    const std::vector<double> here = joint_starts(model, task, given);
    all.insert(all.end(), here.begin(), here.end());
  }
  return all;
}

bool stands_alike(const std::array<double, 3>& a, double surface_a, const std::array<double, 3>& b,
                  double surface_b) {
  constexpr double kRounding = 1e-9;  // m
  return a[0] == b[0] && a[1] == b[1] &&
         (a[2] == b[2] || std::abs((a[2] - surface_a) - (b[2] - surface_b)) <= kRounding);
}

namespace {

// Whether both act, are felt and are seen alike.
bool acts_alike(const Fixture& a, const Fixture& b) {
  const auto same_joint = [](const Fixture::Joint& x, const Fixture::Joint& y) {
    return x.name == y.name && x.friction == y.friction && x.damping == y.damping &&
           x.stiffness == y.stiffness && x.rest == y.rest && x.armature == y.armature;
  };
  const auto same_shown = [](const Fixture::Shown& x, const Fixture::Shown& y) {
    return x.link.text == y.link.text && x.index == y.index && x.from_below == y.from_below &&
           x.at == y.at;
  };
  return a.urdf.text == b.urdf.text && a.turn == b.turn && a.friction == b.friction &&
         std::ranges::equal(a.joints, b.joints, same_joint) &&
         std::ranges::equal(a.shown, b.shown, same_shown);
}

}  // namespace

bool same_fixtures(const Model& model, const Scene& a, const Scene& b) {
  const auto place_in = [&](const Scene& scene, FixtureId id) {
    std::array<double, 3> place = model.fixtures[id].position;
    place[2] += scene.fixtures_lift;
    return place;
  };
  return std::ranges::equal(a.fixtures, b.fixtures, [&](FixtureId x, FixtureId y) {
    return (x == y || acts_alike(model.fixtures[x], model.fixtures[y])) &&
           stands_alike(place_in(a, x), a.surface_z, place_in(b, y), b.surface_z);
  });
}

void define_fixtures(Context& context) {
  const auto read = [&](const Declared<syntax::FixtureDecl>& declared, Fixture& fixture) {
    FixtureReader reader{context, *declared.file, fixture};
    for (const syntax::FixtureBodyStmt& stmt : declared.node->body) std::visit(reader, stmt);
  };
  const auto complete = [&](Fixture& fixture, bool is_read) {
    require(context, !fixture.urdf.span.is_none(), "fixture", fixture.name, fixture.span, "urdf");
    require(context, fixture.has_place, "fixture", fixture.name, fixture.span, "at");
    fixture.model.reset();
    fixture.joints.clear();
    fixture.parts.clear();
    if (!is_read || fixture.urdf.span.is_none()) return;
    read_description(context, fixture);
  };
  define_records(context, context.symbols.fixtures, context.symbols.fixture_decls,
                 context.model.fixtures, read, complete);
}

}  // namespace probe::sema
