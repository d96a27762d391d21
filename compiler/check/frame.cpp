// P0505 as a warning: an object outside the image of every camera that does not move.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "compiler/check/starts.h"
#include "compiler/define/camera_shake.h"
#include "compiler/define/views.h"

namespace probe::sema {

// Of cameras that jitter as they stand in one start. A frustum speaks of its camera.
void Lookout::look(const Model& model, const Scene& scene, const std::vector<View>& views,
                 std::size_t start) {
  const std::vector<double> shakes = shakes_of(model, views, start);
  seen_.clear();
  fixed_.clear();
  known_.clear();
  seen_.reserve(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    seen_.push_back(shaken(model.cameras[views[i].camera], shakes, i));
    const auto frustum = Frustum::of(model, scene, seen_.back());
    if (!frustum) continue;
    fixed_.push_back({*frustum, &model.cameras[views[i].camera]});
    jitters_ = jitters_ || seen_.back().jitters();
  }
}

std::string Lookout::where(double out) {
  if (out >= kBehind) return "lies behind";
  return "lies " + std::to_string(static_cast<long>(std::ceil(out))) +
         " pixels outside the image of";
}

std::size_t Lookout::Hash::operator()(const Key& key) const {
  std::uint64_t hash = 0;
  for (const double number : key) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x9e37'79b9'7f4a'7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

template <typename... Thing>
Lookout::Out Lookout::least(const Thing&... thing) const {
  Out least{kBehind, fixed_.front().camera};
  for (const Fixed& fixed : fixed_) {
    const double out = fixed.frustum.outside(thing...).value_or(kBehind);
    if (out < least.pixels) least = {out, fixed.camera};
  }
  return least;
}

Lookout::Out Lookout::outside(const Object& object, const Start::Placed& placed) {
  const auto& [w, x, y, z] = placed.turn.rotation;
  const Key key{static_cast<double>(placed.object), placed.x, placed.y, w, x, y, z};
  const auto [at, is_new] = known_.try_emplace(key);
  if (is_new) at->second = least(object, placed);
  return at->second;
}

Lookout::Out Lookout::outside(std::span<const scene::Solid> boxes) const { return least(boxes); }

// One warning for the task, of the object that is the farthest out of every camera that does not
// move.
void check_frame(const TaskStarts& starts, Lookouts& lookouts) {
  const Scene& scene = starts.model.scenes[starts.task.scene];
  const std::vector<View> views = views_of(starts.model, starts.task);
  std::vector<CameraId> cameras;
  for (const View& view : views) cameras.push_back(view.camera);
  Lookout& lookout = lookouts[{starts.task.scene, std::move(cameras)}];
  // What jitters has another place in each start, and views their own by their names.
  if (lookout.fixed() == 0 || lookout.jitters()) lookout.look(starts.model, scene, views, 0);
  if (lookout.fixed() == 0) return;
  Lookout::Out most{0, nullptr};
  std::size_t bad = 0, all = 0, episode = 0;
  const Start::Placed* worst = nullptr;
  for (std::size_t e = 0; e < starts.task.starts.size(); ++e) {
    if (lookout.jitters() && e > 0) lookout.look(starts.model, scene, views, e);
    for (const Start::Placed& placed : starts.task.starts[e].placed) {
      ++all;
      const Lookout::Out out = lookout.outside(starts.object(placed), placed);
      if (out.pixels < 1) continue;  // part of a pixel is no loss
      ++bad;
      if (out.pixels <= most.pixels) continue;
      most = out;
      episode = e;
      worst = &placed;
    }
  }
  if (worst == nullptr) return;
  Diagnostic& said = starts.reporter.report(
      Situation::kOutOfFrame, starts.place({worst->object}),
      "`" + starts.object(*worst).name + "` " + Lookout::where(most.pixels) + " `" + most.of->name +
          "` in `" + starts.task.name + "`; " + std::to_string(bad) + " of " + std::to_string(all) +
          " objects are mostly out of view in this task");
  said.severity = Severity::kWarning;
  said.cause = cause_of(starts.layout.span, {most.of->name, starts.object(*worst).name});
  said.point("episode " + std::to_string(episode) + ": " + at(starts.object(*worst), *worst))
      .label(most.of->span, "the camera")
      .label(starts.layout.span, "the layout");
}

}  // namespace probe::sema
