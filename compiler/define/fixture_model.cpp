// What a fixture's description says of it: joints that move with what acts in them, links that can
// be touched, regions of those.
#include "compiler/define/fixture_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/define/described.h"
#include "compiler/define/weight.h"
#include "compiler/model/moving_joint.h"
#include "runtime/plan/magnitudes.h"

namespace probe::sema {
namespace {

using Said = Fixture::Said;

Diagnostic& unknown(Context& context, std::string_view kind, const Spelled& name,
                    const Fixture& fixture, const std::vector<std::string_view>& candidates) {
  return report_unknown(context.diagnostics, kind, {name.span, name.text}, candidates)
      .label(fixture.urdf.span, "not in this file");
}

// Joints, parts and regions share their names: `cabinet.top` is one thing. The joints are those
// that move in the URDF, said or not; a link that can be touched and is not declared has its link's
// name.
void check_names(Context& context, const Fixture& fixture) {
  std::vector<std::pair<std::string_view, Span>> known;
  const auto declare = [&](std::string_view name, const Span& span, const char* kind) {
    for (const auto& [other, first] : known) {
      if (other != name) continue;
      context
          .report(Code::P0203, span,
                  std::string(kind) + " `" + std::string(name) +
                      "` has the name of another thing of `" + fixture.name + "`")
          .label(first, "called so here");
      return;
    }
    known.emplace_back(name, span);
  };
  for (const Said& said : fixture.said) declare(said.joint.text, said.joint.span, "joint");
  if (fixture.model) {
    for (const robot::Joint& joint : fixture.model->joints) {
      const bool is_said = std::ranges::any_of(
          fixture.said, [&](const Said& s) { return s.joint.text == joint.name; });
      if (joint.kind != robot::JointKind::kFixed && !is_said)
        known.emplace_back(joint.name, fixture.urdf.span);
    }
  }
  for (const Fixture::Part& part : fixture.named) declare(part.name, part.span, "part");
  for (const Fixture::OwnRegion& own : fixture.regions)
    declare(own.region.name, own.region.span, "region");
}

// Every link that can be touched is a part, by its own name where none is declared for it.
void check_link_names(Context& context, const Fixture& fixture) {
  const robot::RobotModel& model = *fixture.model;
  for (const Fixture::Part& part : fixture.named) {
    const int other = model.find_link(part.name);
    if (other < 0 || other == model.root || part.link.text == part.name) continue;
    if (!model.links[static_cast<std::size_t>(other)].can_collide()) continue;
    const auto names_it = [&](const Fixture::Part& named) { return named.link.text == part.name; };
    if (std::ranges::any_of(fixture.named, names_it)) continue;
    context
        .report(Code::P0203, part.span,
                "part `" + part.name + "` has the name of another link of `" + fixture.name + "`")
        .label(fixture.urdf.span, "a link here is called so")
        .help("choose another name, or declare that link as a part, too");
  }
}

const Said* said_of(const Fixture& fixture, std::string_view joint) {
  for (const Said& said : fixture.said) {
    if (said.joint.text == joint) return &said;
  }
  return nullptr;
}

void wrong_unit(Context& context, const Said& said, const Quantity& found, const Dimension& wanted,
                bool slides) {
  context
      .report(Code::P0302, said.span,
              "expected " + name_of(wanted) + ", found " + name_of(found.dimension))
      .point("joint `" + said.joint.text + "` " + (slides ? "slides" : "turns"));
}

// What acts in a joint, in its units.
void take(Context& context, const Said& said, Fixture::Joint& joint) {
  const auto value = [&](const std::optional<Quantity>& given, const Dimension& turning,
                         const Dimension& sliding, double& to) {
    if (!given) return;
    const Dimension& wanted = joint.slides ? sliding : turning;
    if (given->dimension == wanted) {
      to = given->si();
    } else {
      wrong_unit(context, said, *given, wanted, joint.slides);
    }
  };
  value(said.friction, dim::kTorque, dim::kForce, joint.friction);
  value(said.damping, dim::kAngularDamping, dim::kLinearDamping, joint.damping);
  value(said.stiffness, dim::kAngularStiffness, dim::kLinearStiffness, joint.stiffness);
  value(said.rest, dim::kAngle, dim::kLength, joint.rest);
  value(said.armature, dim::kInertia, dim::kMass, joint.armature);
  value(said.start, dim::kAngle, dim::kLength, joint.start);
}

// P1303: what would move a joint that is to stay, at most: its spring at the farther limit, and the
// weight of all that it carries and that the joints that follow it carry.
void check_stay(Context& context, const Fixture& fixture, const Said& said,
                const Fixture::Joint& joint) {
  double force = 0;
  if (joint.stiffness > 0) {
    const double far = joint.is_endless ? std::numbers::pi
                                        : std::max(std::abs(joint.lower - joint.rest),
                                                   std::abs(joint.upper - joint.rest));
    force += joint.stiffness * far;
  }
  force += weight_on(fixture, fixture.model->find_joint(joint.name));
  constexpr double kRounding = 1e-6;
  if (force <= joint.friction * (1 + kRounding)) return;
  const char* unit = joint.slides ? "N" : "Nm";
  Diagnostic& found =
      context
          .report(Code::P1303, said.span,
                  fmt::format("joint `{}` is to stay, its friction is {:.3g}{}", joint.name,
                              joint.friction, unit))
          .point(fmt::format("spring and weight pull with up to {:.3g}{}", force, unit));
  if (!std::isfinite(force)) {
    found.help("leave out `stay`: what it carries slides without end");
    return;
  }
  found.help(fmt::format("write `friction {:.3g}{}`, a weaker spring, or leave out `stay`",
                         std::ceil(force * 110) / 100, unit));
}

void build_joints(Context& context, Fixture& fixture) {
  const robot::RobotModel& model = *fixture.model;
  std::vector<std::string_view> moving;
  for (const robot::Joint& known : model.joints) {
    if (known.kind != robot::JointKind::kFixed && known.mimic < 0) moving.push_back(known.name);
  }
  for (const Said& said : fixture.said) {
    const int index = model.find_joint(said.joint.text);
    if (index < 0) {
      unknown(context, "joint", said.joint, fixture, moving);
      continue;
    }
    const robot::Joint& known = model.joints[static_cast<std::size_t>(index)];
    if (known.kind == robot::JointKind::kFixed || known.mimic >= 0) {
      context
          .report(Situation::kFixedJoint, said.joint.span,
                  "joint `" + said.joint.text + "` " +
                      (known.mimic >= 0 ? "follows another, what acts is said of that one"
                                        : "is fixed, nothing moves it"))
          .label(fixture.urdf.span, "described here");
    }
  }
  for (const robot::Joint& known : model.joints) {
    if (known.kind == robot::JointKind::kFixed || known.mimic >= 0) continue;
    Fixture::Joint joint;
    joint.name = known.name;
    joint.slides = known.kind == robot::JointKind::kPrismatic;
    joint.is_endless = known.kind == robot::JointKind::kContinuous;
    joint.lower = joint.is_endless ? 0 : known.lower;
    joint.upper = joint.is_endless ? 0 : known.upper;
    joint.start =
        joint.is_endless ? 0 : std::clamp(0.0, joint.lower, std::max(joint.lower, joint.upper));
    if (!joint.is_endless && joint.lower >= joint.upper) {
      context.report(Situation::kFixedJoint, fixture.urdf.span,
                     "joint `" + joint.name + "` has no room between its limits");
    }
    const plan::MagnitudeInfo& held = plan::info(plan::Magnitude::kJointPosition);
    if (!held.fits(joint.lower) || !held.fits(joint.upper)) {
      context.report(
          Situation::kMagnitude, fixture.urdf.span,
          fmt::format("joint `{}` has limits of {:g} and {:g}, {} is at most {:g} {}", joint.name,
                      joint.lower, joint.upper, held.what, held.most, joint.slides ? "m" : "rad"));
    }
    const auto errors = context.mistakes();
    if (const Said* said = said_of(fixture, joint.name)) {
      take(context, *said, joint);
      if (said->start && !is_within(joint, joint.start))
        outside(context, said->start_span, joint, joint.start);
      if (said->stay && context.mistakes() == errors) check_stay(context, fixture, *said, joint);
    }
    fixture.joints.push_back(std::move(joint));
  }
}

// The joint that moves a link, over fixed ones; one that follows another has no position of its
// own.
std::optional<std::uint32_t> mover(const Fixture& fixture, int link) {
  const robot::Joint* joint = moving_joint(*fixture.model, link);
  if (joint == nullptr) return std::nullopt;
  for (std::uint32_t i = 0; i < fixture.joints.size(); ++i) {
    if (fixture.joints[i].name == joint->name) return i;
  }
  return std::nullopt;
}

void build_parts(Context& context, Fixture& fixture) {
  const robot::RobotModel& model = *fixture.model;
  std::vector<std::string_view> links;
  for (const robot::Link& known : model.links) {
    if (known.can_collide()) links.push_back(known.name);
  }
  for (Fixture::Part& part : fixture.named) {
    part.index = model.find_link(part.link.text);
    if (part.index < 0) {
      unknown(context, "link", part.link, fixture, links);
    } else if (!model.links[static_cast<std::size_t>(part.index)].can_collide()) {
      context
          .report(Situation::kUntouchable, part.link.span,
                  "link `" + part.link.text + "` has no collision, nothing can touch it")
          .label(fixture.urdf.span, "described here");
    }
  }
  for (std::size_t i = 0; i < fixture.named.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (fixture.named[i].index < 0 || fixture.named[i].index != fixture.named[j].index) continue;
      context
          .report(Code::P0203, fixture.named[i].link.span,
                  "link `" + fixture.named[i].link.text + "` is a part already")
          .label(fixture.named[j].span, "called so here");
    }
  }
  for (int link = 0; link < static_cast<int>(model.links.size()); ++link) {
    const robot::Link& known = model.links[static_cast<std::size_t>(link)];
    if (!known.can_collide()) continue;
    Fixture::Part part;
    part.name = link == model.root ? "" : known.name;
    part.link.text = known.name;
    part.index = link;
    for (const Fixture::Part& named : fixture.named) {
      if (named.index == link) part = named;
    }
    part.joint = mover(fixture, link);
    fixture.parts.push_back(std::move(part));
  }
  if (fixture.parts.empty()) {
    context.report(Situation::kUntouchable, fixture.urdf.span,
                   "no link of `" + fixture.name + "` has collision, nothing can touch it");
  }
}

void build_regions(Context& context, Fixture& fixture) {
  for (Fixture::OwnRegion& own : fixture.regions) {
    const robot::RobotModel& model = *fixture.model;
    const bool is_body = model.links[static_cast<std::size_t>(model.root)].can_collide();
    if (own.of.text.empty() && !is_body) {
      context
          .report(Situation::kUntouchable, own.of.span,
                  "the root link of `" + fixture.name + "` has no collision, it is no body")
          .label(fixture.urdf.span, "described here")
          .help("say the region of a part");
      continue;
    }
    bool found = false;
    std::vector<std::string_view> candidates;
    if (is_body) candidates.push_back(fixture.name);
    for (std::uint32_t i = 0; i < fixture.parts.size(); ++i) {
      const Fixture::Part& part = fixture.parts[i];
      if (part.declared) candidates.push_back(part.name);
      const bool is_it = own.of.text.empty() ? part.index == model.root
                                             : part.declared && part.name == own.of.text;
      if (!is_it) continue;
      own.part = i;
      found = true;
    }
    if (!found)
      report_unknown(context.diagnostics, "part of `" + fixture.name + "`",
                     {own.of.span, own.of.text}, candidates);
  }
}

// A link that vanishes is one that only is seen: what is felt stays where it is.
void build_shown(Context& context, Fixture& fixture) {
  const robot::RobotModel& model = *fixture.model;
  std::vector<std::string_view> links, joints;
  const auto is_seen = [](const robot::Link& link) {
    return !link.visuals.empty() || !link.drawn.empty();
  };
  for (const robot::Link& link : model.links) {
    if (!link.can_collide() && is_seen(link)) links.push_back(link.name);
  }
  for (const Fixture::Joint& joint : fixture.joints) joints.push_back(joint.name);
  for (Fixture::Shown& shown : fixture.shown) {
    const int link = model.find_link(shown.link.text);
    if (link < 0) {
      unknown(context, "link", shown.link, fixture, links);
    } else if (model.links[static_cast<std::size_t>(link)].can_collide()) {
      context
          .report(Situation::kFeltUnseen, shown.link.span,
                  "link `" + shown.link.text + "` can be touched, and is always seen")
          .label(fixture.urdf.span, "described here")
          .help("give what comes and goes a link of its own without collision");
    } else if (!is_seen(model.links[static_cast<std::size_t>(link)])) {
      context
          .report(Situation::kFeltUnseen, shown.link.span,
                  "link `" + shown.link.text + "` has no visual, nothing shows it")
          .label(fixture.urdf.span, "described here");
    }
    const auto joint = std::ranges::find(fixture.joints, shown.joint.text, &Fixture::Joint::name);
    if (joint == fixture.joints.end()) {
      unknown(context, "joint that moves", shown.joint, fixture, joints);
      continue;
    }
    shown.index = static_cast<std::uint32_t>(joint - fixture.joints.begin());
    if (!shown.value) continue;
    const Dimension& wanted = joint->slides ? dim::kLength : dim::kAngle;
    if (shown.value->dimension == wanted) {
      shown.at = shown.value->si();
      const bool is_always = shown.from_below ? joint->upper <= shown.at : shown.at <= joint->lower;
      const bool is_never = shown.from_below ? shown.at < joint->lower : joint->upper < shown.at;
      if (!joint->is_endless && (is_always || is_never)) {
        context
            .report(Situation::kJointLimit, shown.value_span,
                    fmt::format("joint `{}` goes from {:.6g} to {:.6g}: link `{}` is {} seen",
                                joint->name, joint->lower, joint->upper, shown.link.text,
                                is_always ? "always" : "never"))
            .point(joint->slides ? "in m" : "in rad")
            .help("write a value between the joint's limits");
      }
    } else {
      context
          .report(Code::P0302, shown.value_span,
                  "expected " + name_of(wanted) + ", found " + name_of(shown.value->dimension))
          .point("joint `" + joint->name + "` " + (joint->slides ? "slides" : "turns"));
    }
  }
}

}  // namespace

bool is_within(const Fixture::Joint& joint, double position) {
  return joint.is_endless || (joint.lower <= position && position <= joint.upper);
}

void outside(Context& context, const Span& span, const Fixture::Joint& joint, double position) {
  context
      .report(Situation::kJointLimit, span,
              fmt::format("joint `{}` starts at {:.6g}, beyond its limits of {:.6g} and {:.6g}",
                          joint.name, position, joint.lower, joint.upper))
      .point(joint.slides ? "in m" : "in rad")
      .help(joint.slides ? fmt::format("it may start at {:.6g}cm to {:.6g}cm", joint.lower * 100,
                                       joint.upper * 100)
                         : fmt::format("it may start at {:.6g}rad to {:.6g}rad", joint.lower,
                                       joint.upper));
}

void read_description(Context& context, Fixture& fixture) {
  auto model = described_by(context, fixture.urdf, "the fixture's description");
  if (!model) return check_names(context, fixture);
  fixture.model = std::move(*model);
  check_names(context, fixture);
  check_link_names(context, fixture);
  build_joints(context, fixture);
  build_parts(context, fixture);
  build_regions(context, fixture);
  build_shown(context, fixture);
}

}  // namespace probe::sema
