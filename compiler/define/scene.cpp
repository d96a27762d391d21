// `scene`: a robot at its place, a surface, what stands and looks around it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/define/control.h"
#include "compiler/define/define.h"
#include "compiler/define/fixture.h"
#include "compiler/define/paint.h"
#include "compiler/define/record.h"
#include "compiler/define/scene.h"
#include "compiler/names/quantities.h"
#include "compiler/names/texts.h"
#include "compiler/syntax/lexer.h"
#include "runtime/plan/limits.h"

namespace probe::sema {
namespace {

struct SceneReader {
  Context& context;
  Scene& scene;
  const NameBound& bound;
  bool has_surface = false, has_physics = false, has_backdrop = false, has_cameras = false;
  bool has_joints = false, has_fixture = false, has_fixtures = false;
  Span fixture_region = {};

  void operator()(const syntax::SceneRobotStmt& stmt) {
    if (stmt.robot) {
      const auto robot = context.symbols.robots.find(bound(*stmt.robot), context.diagnostics);
      if (robot) scene.robot = static_cast<RobotId>(*robot);
    }
    if (!stmt.at) return;
    scene.is_placed = true;
    const auto at = read_point(context, *stmt.at, 2, 3, dim::kLength,
                               {"`robot ... at` takes lengths", plan::Magnitude::kPlace});
    assign(scene.base_position, at);
    scene.base_on_surface = at && at->size() == 2;
    if (const auto yaw = read_quantity(context, stmt.yaw, dim::kAngle, "`yaw` takes an angle")) {
      scene.base_turn = make_turn(nullptr, nullptr, &*yaw);
    }
  }
  void operator()(const syntax::JointsStmt& stmt) {
    has_joints = true;
    scene.joints.clear();
    scene.joints_span = stmt.span;
    // Lengths and angles mix here; each is checked against its joint when the robot is known.
    for (const syntax::Quantity& value : stmt.positions.coordinates) {
      const auto as_is = make_quantity("0", to_text(value.unit));
      const bool is_length = as_is && as_is->dimension == dim::kLength;
      const auto read =
          read_quantity(context, value, is_length ? dim::kLength : dim::kAngle,
                        {"a joint is at an angle or a length", plan::Magnitude::kJointPosition});
      if (read) scene.joints.push_back(*read);
    }
    if (scene.joints.size() != stmt.positions.coordinates.size())
      scene.joints.clear(), scene.joints_span = {};
  }
  void operator()(const syntax::SurfaceStmt& stmt) {
    has_surface = true;
    scene.surface_span = stmt.height.span;
    scene.surface_z = read_si(context, stmt.height, dim::kLength,
                              {"`surface` takes a height", plan::Magnitude::kPlace})
                          .value_or(0);
    const auto low = read_point(context, stmt.low, 2, 2, dim::kLength,
                                {"`area` takes lengths", plan::Magnitude::kPlace});
    const auto high = read_point(context, stmt.high, 2, 2, dim::kLength,
                                 {"`area` takes lengths", plan::Magnitude::kPlace});
    if (!low || !high) return;
    scene.area = {(*low)[0].si(), (*low)[1].si(), (*high)[0].si(), (*high)[1].si()};
    const Span corners = join(stmt.low.span, stmt.high.span);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const double extent = scene.area[i + 2] - scene.area[i];
      if (extent > 0) {
        if (!check_magnitude(context, corners, extent, plan::Magnitude::kExtent)) return;
        continue;
      }
      context.report(Situation::kCornersSwapped, corners,
                     "the second corner of an area lies above the first on both axes");
      return;
    }
  }
  void operator()(const syntax::FixtureStmt& stmt) {
    has_fixture = true;
    scene.fixture = spelled(stmt.mesh);
    assign(scene.fixture_position,
           read_point(context, stmt.at, 3, 3, dim::kLength,
                      {"`fixture ... at` takes lengths", plan::Magnitude::kPlace}));
  }
  void operator()(const syntax::SceneFixturesStmt& stmt) {
    has_fixtures = true;
    scene.fixtures.clear();
    scene.fixtures_lift = 0;
    for (const syntax::Name& name : stmt.fixtures) {
      const auto found = context.symbols.fixtures.find(bound(name), context.diagnostics);
      if (!found) continue;
      const auto id = static_cast<FixtureId>(*found);
      if (std::ranges::find(scene.fixtures, id) != scene.fixtures.end()) {
        context
            .report(Code::P0203, name.span,
                    "`" + std::string(name.text) + "` stands twice in scene `" + scene.name + "`")
            .help("a second one is a declaration of its own: `fixture NAME like " +
                  std::string(name.text) + " { at (..) }`");
        continue;
      }
      scene.fixtures.push_back(id);
    }
  }
  void operator()(const syntax::RegionStmt& stmt) {
    auto region = read_region(context, stmt);
    if (!region) return;
    if (stmt.of->text == "surface") {
      put_region(scene.surface_regions, std::move(*region));
    } else if (stmt.of->text == "fixture") {
      fixture_region = stmt.of->span;
      put_region(scene.fixture_regions, std::move(*region));
    } else {
      report_unknown(context.diagnostics, "owner of a scene's region", *stmt.of,
                     {"surface", "fixture"})
          .help("a region of an object or of a fixture with joints is said in its declaration");
    }
  }
  void operator()(const syntax::BackdropStmt& stmt) {
    has_backdrop = true;
    scene.backdrop = spelled(stmt.mesh);
    scene.backdrop_stands = stmt.stands;
  }
  void operator()(const syntax::TextureStmt& stmt) {
    constexpr double kSide = 0.5;  // m
    using Part = std::pair<std::string_view, plan::CoverOf>;
    static constexpr Part kOf[] = {{"surface", plan::CoverOf::kSurface},
                                   {"walls", plan::CoverOf::kWalls},
                                   {"floor", plan::CoverOf::kFloor}};
    const auto* const of = std::ranges::find(kOf, stmt.of->text, &Part::first);
    if (of == std::end(kOf)) {
      report_unknown(context.diagnostics, "part of a backdrop", *stmt.of,
                     {"surface", "walls", "floor"});
      return;
    }
    if (auto cover = read_cover(context, stmt, kSide)) scene.covers[of->second] = std::move(*cover);
  }
  void operator()(const syntax::SceneCameraStmt& stmt) {
    has_cameras = true;
    scene.views.clear();
    for (const syntax::SceneCamera& written : stmt.cameras) {
      const auto camera = context.symbols.cameras.find(bound(written.camera), context.diagnostics);
      if (!camera) continue;
      View view;
      const syntax::Name& name = written.as ? *written.as : written.camera;
      view.name = std::string(name.text);
      check_name(context.diagnostics, name);
      view.span = name.span;
      view.camera = static_cast<CameraId>(*camera);
      view.is_named = written.as.has_value();
      if (written.overlay) view.overlay = spelled(*written.overlay);
      add_view(std::move(view));
    }
    if (scene.views.size() > plan::kMaxViews) {
      context.report(Situation::kTooManyViews, stmt.span,
                     "expected at most " + std::to_string(plan::kMaxViews) +
                         " cameras in a scene, found " + std::to_string(scene.views.size()));
    }
  }
  void add_view(View view) {
    for (const View& known : scene.views) {
      if (known.name != view.name) continue;
      context
          .report(Code::P0203, view.span,
                  "two cameras of scene `" + scene.name + "` are called `" + view.name + "`")
          .label(known.span, "first called so here")
          .help("`as NAME` gives a camera another name in its scene");
      return;
    }
    scene.views.push_back(std::move(view));
  }
  void operator()(const syntax::UseLightStmt& stmt) {
    const auto light = context.symbols.lights.find(bound(stmt.light), context.diagnostics);
    if (light) scene.light = static_cast<LightId>(*light);
  }
  void operator()(const syntax::PhysicsStmt& stmt) {
    has_physics = true;
    scene.physics_span = stmt.rate.span;
    scene.physics_hz = read_positive(context, stmt.rate, dim::kRate,
                                     {"`physics` takes a frequency", plan::Magnitude::kPhysicsRate})
                           .value_or(1);
    scene.friction = read_positive(context, stmt.friction, dim::kNumber,
                                   {"`friction` takes a number", plan::Magnitude::kFriction})
                         .value_or(1);
    const auto of_air = [&](const std::optional<syntax::Quantity>& written, const Dimension& of,
                            const char* takes) {
      if (!written) return 0.0;
      return read_positive(context, *written, of, {takes, plan::Magnitude::kAir}).value_or(0);
    };
    scene.air_span = stmt.air ? stmt.air->span : stmt.viscosity ? stmt.viscosity->span : Span{};
    scene.air_density = of_air(stmt.air, dim::kDensity, "`air` takes a density");
    scene.air_viscosity =
        of_air(stmt.viscosity, dim::kViscosity, "`viscosity` takes pascal seconds, in `Pas`");
    if (stmt.window_step)
      context.report(Code::P0101, stmt.span, "`window step` is not available yet");
  }
};

// Which statements stand in the scene itself, and not in one that it copies.
struct Own {
  bool joints = false, physics = false;
};

// What is underlined was written for another scene: this one does not fit it.
void name_copy(Diagnostic& said, const Scene& scene, bool is_own) {
  if (!is_own) said.label(scene.span, "copied by `" + scene.name + "`");
}

// A world refuses joints that begin farther beyond a limit than rounding explains.
void check_joint_limits(Context& context, const Scene& scene, const Robot& robot, Own own) {
  if (!robot.model) return;
  constexpr double kRounding = 1e-3;  // m or rad, as in runtime/world
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const int index = robot.model->find_joint(robot.drives[i].joint.text);
    if (index < 0) continue;
    const robot::Joint& joint = robot.model->joints[static_cast<std::size_t>(index)];
    if (joint.kind == robot::JointKind::kContinuous || joint.kind == robot::JointKind::kFixed)
      continue;
    const double q = scene.joints[i].si();
    if (q >= joint.lower - kRounding && q <= joint.upper + kRounding) continue;
    Diagnostic& said = context.report(
        Situation::kJointLimit, scene.joints_span,
        fmt::format("joint `{}` starts at {:.6g}, beyond its limits of {:.6g} and {:.6g}",
                    joint.name, q, joint.lower, joint.upper));
    name_copy(said.point("number " + std::to_string(i + 1)), scene, own.joints);
  }
}

void check_joints(Context& context, const Scene& scene, Own own) {
  if (scene.robot == RobotId::kNone || scene.joints_span.is_none()) return;
  const Robot& robot = context.model.robots[scene.robot];
  if (scene.joints.size() != robot.drives.size()) {
    Diagnostic& said = context.report(Situation::kJointCount, scene.joints_span,
                                      "expected " + std::to_string(robot.drives.size()) +
                                          " joints, one per drive of `" + robot.name + "`, found " +
                                          std::to_string(scene.joints.size()));
    name_copy(said, scene, own.joints);
    return;
  }
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const bool slides = robot.drives[i].slides;
    const Dimension wanted = slides ? dim::kLength : dim::kAngle;
    if (scene.joints[i].dimension == wanted) continue;
    Diagnostic& said =
        context.report(Code::P0302, scene.joints_span,
                       "expected " + name_of(wanted) + " for joint `" + robot.drives[i].joint.text +
                           "`, found " + name_of(scene.joints[i].dimension));
    name_copy(said.point("number " + std::to_string(i + 1)), scene, own.joints);
  }
  check_joint_limits(context, scene, robot, own);
}

// A control step is a whole number of physics steps.
void check_rates(Context& context, const Scene& scene, Own own) {
  if (scene.robot == RobotId::kNone || scene.physics_hz == 0) return;
  const double control_hz = context.model.robots[scene.robot].control_hz;
  if (control_hz == 0) return;
  const double substeps = scene.physics_hz / control_hz;
  if (substeps >= 1 && substeps <= plan::kMaxSubsteps && substeps == std::floor(substeps)) return;
  Diagnostic& said =
      context.report(Situation::kSubsteps, scene.physics_span,
                     "expected a whole number of physics steps in a control step, found " +
                         fmt::format("{:.6g}", substeps));
  name_copy(said, scene, own.physics);
  const double near = control_hz * std::clamp(std::nearbyint(substeps), 1.0,
                                              static_cast<double>(plan::kMaxSubsteps));
  said.help(fmt::format("the robot is controlled at {:.6g}Hz: `{:.6g}Hz` is a multiple of that",
                        control_hz, near));
}

// Arms whose drives have targets do not feel air: it would change the plan and nothing else.
void check_air(Context& context, const Scene& scene, Own own) {
  if (scene.air_density == 0 && scene.air_viscosity == 0) return;
  const Robot& robot = context.model.robots[scene.robot];
  if (by_efforts(robot)) return;
  Diagnostic& said = context.report(
      Situation::kLawUnread, scene.air_span,
      fmt::format("`{}`, under `{}`, feels no air", robot.name, robot::row_of(robot.law).word));
  name_copy(said, scene, own.physics);
  const std::string feel = "laws that give efforts (`osc_pose`) feel it";
  if (own.physics) {
    said.help("leave `air` and `viscosity` out: " + feel);
  } else {
    said.help(
        fmt::format("write `physics {:.6g}Hz friction {:.6g}` in `{}`, without `air` and "
                    "`viscosity`: {}",
                    scene.physics_hz, scene.friction, scene.name, feel));
  }
}

// A mesh behind the objects moves with the surface, a photo cannot.
void check_photos(Context& context, const Scene& scene) {
  if (scene.cameras_z == scene.surface_z) return;
  for (const View& view : scene.views) {
    if (!view.overlay) continue;
    context
        .report(Situation::kPhotoMoved, scene.surface_span,
                fmt::format("the surface is at {:.6g}cm here and at {:.6g}cm in the photo `{}`",
                            100 * scene.surface_z, 100 * scene.cameras_z, view.overlay->text))
        .label(view.overlay->span, "the photo is of the other height")
        .help("write `camera` again, with a photo of this surface or without one");
    return;
  }
}

// The statements over what the scene has. `is_copy`: that stood somewhere, on a surface.
Own read_body(Context& context, const std::vector<syntax::SceneStmt>& body, bool is_copy,
              Scene& scene, const NameBound& bound) {
  SceneReader reader{context, scene, bound};
  const double copied_z = scene.surface_z;
  const auto errors = context.mistakes();
  for (const syntax::SceneStmt& stmt : body) std::visit(reader, stmt);
  if (scene.base_on_surface) scene.base_position[2] = scene.surface_z;
  // What was copied stands on the surface as it stood there.
  if (is_copy && reader.has_surface) {
    const double rise = scene.surface_z - copied_z;
    if (scene.fixture && !reader.has_fixture) scene.fixture_position[2] += rise;
    if (!reader.has_fixtures) scene.fixtures_lift += rise;
  }
  if (reader.has_backdrop) scene.backdrop_z = scene.surface_z;
  if (reader.has_cameras) scene.cameras_z = scene.surface_z;
  if (!reader.fixture_region.is_none() && !scene.fixture) {
    context.report(Code::P0201, reader.fixture_region,
                   "scene `" + scene.name + "` has no `fixture \"...\"` whose region this is");
  }
  if (context.mistakes() == errors) check_photos(context, scene);
  return {reader.has_joints, reader.has_physics};
}

void check_whole(Context& context, Scene& scene, Own own) {
  const auto need = [&](bool is_there, std::string_view statement) {
    require(context, is_there, "scene", scene.name, scene.span, statement);
  };
  need(scene.robot != RobotId::kNone, "robot");
  need(scene.robot == RobotId::kNone || scene.is_placed, "robot ... at");
  need(!scene.joints_span.is_none(), "joints");
  need(scene.area[0] != scene.area[2], "surface");
  need(!scene.views.empty(), "camera");
  need(scene.light != LightId::kNone, "light");
  need(scene.physics_hz != 0, "physics");
  if (scene.robot == RobotId::kNone) return;
  scene.broken = context.model.robots[scene.robot].broken;
  for (const FixtureId id : scene.fixtures)
    scene.broken = scene.broken || context.model.fixtures[id].broken;
  if (!scene.broken) check_joints(context, scene, own);
  if (!scene.broken) check_air(context, scene, own);
  check_rates(context, scene, own);
}

}  // namespace

void define_scenes(Context& context) {
  Own own;
  const NameBound as_written = [](const syntax::Name& name) { return name; };
  const auto read = [&](const Declared<syntax::SceneDecl>& declared, Scene& scene) {
    const syntax::SceneDecl& node = *declared.node;
    own = read_body(context, node.body, node.like.has_value(), scene, as_written);
  };
  const auto complete = [&](Scene& scene, bool is_read) {
    if (is_read) check_whole(context, scene, own);
  };
  define_records(context, context.symbols.scenes, context.symbols.scene_decls, context.model.scenes,
                 read, complete);
}

bool says_word(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !syntax::is_word(text[at - 1]);
    if (begins && (end == text.size() || !syntax::is_word(text[end]))) return true;
  }
  return false;
}

SceneId change_scene(Context& context, SceneId from, const syntax::TaskSceneStmt& stmt,
                     const NameBound& bound, const std::string& bindings) {
  Table<SceneId, Scene>& scenes = context.model.scenes;
  const std::string changed = fmt::format("{}:{}:{}:{}", static_cast<std::uint32_t>(from),
                                          stmt.span.file.value,
                                          stmt.span.begin, bindings);
  for (std::size_t i = context.symbols.scene_decls.size(); i < scenes.size(); ++i) {
    if (scenes[scenes.id(i)].changed == changed) return scenes.id(i);
  }
  Scene scene = scenes[from];
  scene.changed = changed;
  const std::size_t mistakes = context.mistakes();
  const Own own = read_body(context, stmt.body, true, scene, bound);
  if (!scene.broken && context.mistakes() == mistakes) check_whole(context, scene, own);
  scene.broken = scene.broken || context.mistakes() != mistakes;
  scenes.add(std::move(scene));
  return scenes.id(scenes.size() - 1);
}

}  // namespace probe::sema
