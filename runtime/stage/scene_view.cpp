// Plan records to a render::SceneSpec, and poses to frames.
#include "runtime/stage/scene_view.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include <string>

#include "runtime/base/check.h"
#include "runtime/base/trig.h"
#include "runtime/scene/photo_shape.h"
#include "runtime/stage/backdrop.h"
#include "runtime/stage/robot_of.h"
#include "runtime/stage/task_bodies.h"

namespace probe::stage {
namespace {

// In the frame of its mount.
Result<render::Camera> make_camera(const plan::Plan& plan, const plan::CameraRecord& record) {
  render::Camera camera;
  Mat3 axes;
  const auto& aim = record.aim_values;
  if (record.aim == static_cast<std::uint32_t>(plan::CameraAim::kLook)) {
    auto look = render::look_along({aim[0], aim[1], aim[2]});
    if (!look) {
      return Failure{Fault::kRender, look.failure().message,
                     "camera `" + std::string(plan.text(record.name)) + "`"};
    }
    axes = *look;
  } else {
    axes = to_quat(aim).normalized().toRotationMatrix();
  }
  camera.position = to_vec(record.position);
  camera.forward_left_up = axes;
  camera.width = static_cast<int>(record.width);
  camera.height = static_cast<int>(record.height);
  camera.fx = record.fx;
  camera.fy = record.fy;
  camera.cx = record.cx;
  camera.cy = record.cy;
  return camera;
}

render::Camera carried(const render::Camera& on_mount, const Pose& mount) {
  render::Camera camera = on_mount;
  camera.position = mount.apply(on_mount.position);
  camera.forward_left_up = mount.rotation.toRotationMatrix() * on_mount.forward_left_up;
  return camera;
}

void resize(render::Camera& camera, ImageSize size) {
  if (size.width == 0 || size.height == 0) return;
  const double x = static_cast<double>(size.width) / camera.width;
  const double y = static_cast<double>(size.height) / camera.height;
  camera.fx *= x;
  camera.cx *= x;
  camera.fy *= y;
  camera.cy *= y;
  camera.width = size.width;
  camera.height = size.height;
}

render::Lights make_lights(const plan::Plan& plan, const plan::LightRecord& record) {
  render::Lights lights;
  lights.ambient = record.ambient;
  if (record.color != std::array<double, 3>{}) lights.color = record.color;
  for (const plan::SunRecord& sun : plan.suns(record)) {
    lights.suns.push_back({to_vec(sun.direction), sun.power, sun.shadow != 0});
  }
  if (record.shading == 0) return lights;
  lights.shading = render::Shading::kVertex;
  for (const plan::LampRecord& from : plan.lamps(record)) {
    render::Lamp lamp;
    const auto kind = static_cast<plan::LampKind>(from.kind);
    lamp.kind = kind == plan::LampKind::kSpot  ? render::Lamp::Kind::kSpot
                : kind == plan::LampKind::kSun ? render::Lamp::Kind::kSun
                                               : render::Lamp::Kind::kHeadlight;
    lamp.position = to_vec(from.position);
    lamp.direction = to_vec(from.direction);
    lamp.diffuse = from.power;
    lamp.specular = from.specular;
    lamp.ambient = from.ambient;
    if (from.cutoff > 0) lamp.cutoff_cosine = portable_cos(from.cutoff);
    lamp.exponent = from.exponent;
    if (from.fade != std::array<double, 3>{}) lamp.fade = from.fade;
    lights.lamps.push_back(lamp);
  }
  return lights;
}

// What has to be added to the backdrop's height. A photo shows the table where it stood: a scene
// whose surface is elsewhere cannot have it.
Result<double> lift_backdrop(const plan::Plan& plan, const plan::TaskRecord& task,
                             const SharedAssets& assets) {
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  if (scene.backdrop == plan::kNone) return 0.0;
  const auto backdrop = assets.mesh(scene.backdrop);
  const auto fixture =
      scene.fixture_visual == plan::kNone ? nullptr : assets.mesh(scene.fixture_visual);
  const auto height =
      table_height({backdrop.get()}, {fixture.get(), to_vec(scene.fixture_position)}, scene.area,
                   scene.surface_z);
  const double lift = backdrop_lift(scene, height);
  if (lift == 0) return lift;
  for (const plan::ViewRecord& view : plan.views(task)) {
    if (view.photo == plan::kNone) continue;
    return Failure{
        Fault::kRender,
        fmt::format("the surface is at {:.3f} m, but the backdrop's table, which the "
                    "photo `{}` shows, at {:.3f} m: a photo cannot move with the surface",
                    scene.surface_z, plan.text(plan.assets()[view.photo].path),
                    scene.surface_z - lift),
        "scene `" + std::string(plan.text(scene.name)) + "`"};
  }
  return lift;
}

}  // namespace

Result<std::unique_ptr<SceneView>> SceneView::create(const plan::Plan& plan,
                                                     std::uint32_t task_index,
                                                     std::shared_ptr<const SharedAssets> assets,
                                                     ImageSize size) {
  const plan::TaskRecord& task = plan.tasks()[task_index];
  const plan::SceneRecord& scene = plan.scenes()[task.scene];
  PROBE_ASSIGN(std::vector<PlacedTree> trees, placed_trees(plan, task, *assets));
  PROBE_ASSIGN(const TaskBodies local, task_bodies(plan, task, *assets));
  auto view = std::unique_ptr<SceneView>(new SceneView(assets, std::move(trees)));

  render::SceneSpec& spec = view->seen_;
  if (scene.backdrop != plan::kNone) {
    PROBE_ASSIGN(const double lift, lift_backdrop(plan, task, *assets));
    spec.statics.push_back({assets->backdrop(task.scene),
                            {Vec3(0, 0, lift), Quat::Identity()},
                            render::kBackdrop,
                            "backdrop",
                            false});
  }
  const auto bodies = plan.bodies(task);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto kind = static_cast<plan::BodyKind>(bodies[i].kind);
    const std::string name(plan.text(bodies[i].name));
    const auto body = static_cast<std::uint16_t>(i);
    if (kind == plan::BodyKind::kObject) {
      const std::uint32_t visual = plan.objects()[bodies[i].index].visual;
      if (visual == plan::kNone) {
        return Failure{Fault::kAsset, "object `" + name + "` has no mesh to draw", ""};
      }
      spec.dynamics.push_back({assets->object_mesh(bodies[i].index), {}, body, name, false});
      ++view->objects_;
    }
    if (kind == plan::BodyKind::kFixture && scene.fixture_visual != plan::kNone) {
      spec.statics.push_back({assets->mesh(scene.fixture_visual),
                              {to_vec(scene.fixture_position), Quat::Identity()},
                              body,
                              name,
                              false});
    }
  }
  for (std::size_t tree = 0; tree < view->trees_.size(); ++tree) {
    const UrdfParts& parts = *view->trees_[tree].parts;
    for (const UrdfParts::LinkVisual& visual : parts.visuals) {
      const std::string& name = parts.model.links[static_cast<std::size_t>(visual.link)].name;
      const bool is_robot = tree == 0;
      spec.dynamics.push_back({visual.mesh, visual.origin,
                               local.of_link(tree, visual.link).value_or(render::kBackdrop), name,
                               is_robot});
    }
  }

  const plan::LightRecord& light = plan.lights()[task.light];
  spec.lights = make_lights(plan, light);
  spec.occlusion_rays = static_cast<int>(light.occlusion);
  for (const plan::ViewRecord& record : plan.views(task)) {
    PROBE_ASSIGN(Eye eye, view->open_eye(plan, scene, record, size));
    if (const plan::SensorRecord* sensor = plan.sensor(plan.cameras()[record.camera]))
      eye.sensor.emplace(*sensor, view->eyes_.size());
    view->eyes_.push_back(std::move(eye));
  }
  const auto episodes = plan.episodes(task);
  const auto is_shaken = [](const plan::EpisodeRecord& e) { return e.shaken.count > 0; };
  if (std::ranges::none_of(episodes, is_shaken)) return view;
  for (const plan::EpisodeRecord& episode : episodes) {
    const auto shaken = plan::shakes_of(plan.tables(), episode);
    std::vector<plan::Shake>& shakes = view->shakes_[Sha256{episode.start_id}];
    shakes.clear();
    for (std::size_t i = 0; i < view->eyes_.size(); ++i)
      shakes.push_back(plan::shake_of(shaken, i));
  }
  return view;
}

Result<std::unique_ptr<render::Renderer>> SceneView::open_renderer(const Eye& eye) const {
  render::SceneSpec spec = seen_;
  spec.camera = carried(eye.on_mount, eye.mount);
  spec.samples = eye.samples;
  spec.photo = eye.photo;
  return render::Renderer::create(std::move(spec), assets_->pictures());
}

Status SceneView::begin(const Sha256& start_id) {
  if (shakes_.empty() || begun_ == start_id) return {};
  const auto shakes = shakes_.find(start_id);
  if (shakes == shakes_.end())
    return Failure{Fault::kRender, "no start of this task", to_hex(start_id)};
  for (std::size_t i = 0; i < eyes_.size(); ++i) {
    Eye& eye = eyes_[i];
    const plan::Shake& shake = shakes->second[i];
    if (shake == eye.shake) continue;
    eye.shake = shake;
    eye.on_mount = eye.written;
    eye.on_mount.position += to_vec(shake.moved);
    eye.on_mount.forward_left_up =
        eye.written.forward_left_up * to_quat(shake.turned).normalized().toRotationMatrix();
    if (eye.moving_mount >= 0) continue;
    PROBE_ASSIGN(eye.renderer, open_renderer(eye));
  }
  begun_ = start_id;
  return {};
}

Result<SceneView::Eye> SceneView::open_eye(const plan::Plan& plan, const plan::SceneRecord& scene,
                                           const plan::ViewRecord& record, ImageSize size) {
  const robot::RobotModel& model = robot().parts->model;
  const plan::CameraRecord& camera = plan.cameras()[record.camera];
  Eye eye;
  eye.name = std::string(plan.text(record.name));
  const std::string mount_name(plan.text(camera.mount_link));
  const int mount = model.find_link(mount_name);
  const std::string where = "camera `" + std::string(plan.text(camera.name)) + "`";
  if (mount < 0)
    return Failure{Fault::kRender, "the robot has no link `" + mount_name + "`", where};
  if (!model.is_fixed(mount)) eye.moving_mount = mount;
  trees_.front().place(plan.joints(scene));
  eye.mount = robot().link(mount);
  PROBE_ASSIGN(eye.written, make_camera(plan, camera));
  resize(eye.written, size);
  eye.on_mount = eye.written;
  eye.samples = camera.samples == 0 || size.is_single ? 1 : camera.samples == 4 ? 2 : 4;
  // A photo was taken from one place: a camera that moves sees the scene's meshes instead.
  if (record.photo != plan::kNone && eye.moving_mount < 0) {
    eye.photo = assets_->photo(record.photo);
    if (const auto defect = scene::photo_defect({eye.photo->width, eye.photo->height}, camera.width,
                                                camera.height)) {
      const std::string_view path = plan.text(plan.assets()[record.photo].path);
      return Failure{Fault::kRender, *defect, where + ", photo `" + std::string(path) + "`"};
    }
  }
  PROBE_ASSIGN(eye.renderer, open_renderer(eye));
  return eye;
}

// Fills poses_.
void SceneView::place(std::span<const double> q, std::span<const Pose> objects) {
  const PlacedTree& last = trees_.back();
  // A trace may hold the joints of fixtures that a view does not have; they come last.
  PROBE_CHECK(objects.size() == objects_ && q.size() >= last.first_joint + last.tree.joint_count(),
              "one pose an object and one position a joint");
  poses_.assign(objects.begin(), objects.end());
  hidden_.clear();
  for (PlacedTree& placed : trees_) {
    placed.place(q);
    for (const UrdfParts::LinkVisual& visual : placed.parts->visuals) {
      if (!placed.shows(visual.link, q)) hidden_.push_back(poses_.size());
      poses_.push_back(placed.link(visual.link));
    }
  }
}

// What is not to be seen stands 900 km behind the eye: no ray reaches it, it throws no shadow, and
// in a mirror it is smaller than the least that triangles are drawn by.
void SceneView::hide_from(const render::Camera& camera) {
  constexpr double kAway = 9e5;  // m
  for (const std::size_t i : hidden_) {
    poses_[i] = {camera.position - kAway * camera.forward_left_up.col(0), Quat::Identity()};
  }
}

Result<render::FrameView> SceneView::look(Eye& eye, bool full) {
  if (eye.moving_mount >= 0) {
    const render::Camera camera = carried(eye.on_mount, robot().link(eye.moving_mount));
    hide_from(camera);
    return eye.renderer->render_from(camera, poses_);
  }
  if (!hidden_.empty()) hide_from(carried(eye.on_mount, eye.mount));
  return full ? eye.renderer->render_full(poses_) : eye.renderer->render(poses_);
}

Result<render::FrameView> SceneView::render(std::span<const double> q,
                                            std::span<const Pose> objects, std::size_t camera) {
  place(q, objects);
  return look(eyes_[camera], false);
}

Result<std::span<const CameraFrame>> SceneView::render_all(std::span<const double> q,
                                                           std::span<const Pose> objects) {
  place(q, objects);
  frames_.clear();
  for (Eye& eye : eyes_) {
    PROBE_ASSIGN(const render::FrameView frame, look(eye, false));
    frames_.push_back({eye.name, frame});
  }
  return std::span<const CameraFrame>(frames_);
}

Result<std::span<const CameraFrame>> SceneView::render_seen(
    const Moment& moment, const std::function<Placed(int step)>& at) {
  PROBE_TRY(begin(moment.start_id));
  frames_.clear();
  int placed = -1;
  for (Eye& eye : eyes_) {
    const int step = eye.sensor ? eye.sensor->shown_step(moment) : moment.step;
    if (step != placed) {
      const Placed there = at(step);
      place(there.q, there.objects);
      placed = step;
    }
    PROBE_ASSIGN(render::FrameView frame, look(eye, false));
    if (eye.sensor) frame = eye.sensor->apply(frame, {moment.start_id, step});
    frames_.push_back({eye.name, frame});
  }
  return std::span<const CameraFrame>(frames_);
}

bool SceneView::drops() const {
  return std::ranges::any_of(eyes_,
                             [](const Eye& eye) { return eye.sensor && eye.sensor->drops(); });
}

Result<render::FrameView> SceneView::render_full(std::span<const double> q,
                                                 std::span<const Pose> objects,
                                                 std::size_t camera) {
  place(q, objects);
  return look(eyes_[camera], true);
}

}  // namespace probe::stage
