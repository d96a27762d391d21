#include "compiler/space/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compiler/define/views.h"
#include "compiler/geometry/camera_pose.h"
#include "compiler/geometry/travel.h"
#include "compiler/space/draws.h"
#include "compiler/space/start_rows.h"
#include "runtime/base/geometry.h"
#include "runtime/base/trig.h"

namespace probe::space {
namespace {

using sema::SpaceAxis;
using sema::SpaceAxisKind;
using sema::Spacing;

// What less than these does, nobody sees; the compiler refuses it (define/camera.cpp).
constexpr double kLevel = 1.0 / 255, kLeastBlur = 0.01;

// What the value comes to: a noise that is too faint is none.
double effective(const SpaceAxis& axis, double value) {
  if (axis.kind == SpaceAxisKind::kNoise) return value < kLevel ? 0 : value;
  if (axis.kind == SpaceAxisKind::kBlur) return value < kLeastBlur ? 0 : value;
  const Spacing spacing = sema::info_of(axis.kind).spacing;
  return spacing == Spacing::kWhole || spacing == Spacing::kChoice ? std::round(value) : value;
}

bool is_changed(const SpaceAxis& axis, double value) {
  return effective(axis, value) != effective(axis, axis.own);
}

// As a text may have it: no exponent, 18 decimals at most, never -0; to the bit where that allows.
std::string number(double value) {
  constexpr std::size_t kMostDecimals = 18;
  std::string text = fmt::format("{}", value + 0.0);
  const std::size_t point = text.find('.');
  const bool fits = text.find('e') == text.npos &&
                    (point == text.npos || text.size() - point - 1 <= kMostDecimals);
  if (fits) return text;
  text = fmt::format("{:.18f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string vector_text(const Vec3& v, const char* unit) {
  return fmt::format("({}{}, {}{}, {}{})", number(v[0]), unit, number(v[1]), unit, number(v[2]),
                     unit);
}

// Uniform over directions: a height and an angle (Archimedes).
Vec3 drawn_direction(std::uint64_t of, const std::string& what) {
  const double z = 2 * draw(of, what, 0) - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
  const SinCos at = portable_sincos(2 * std::numbers::pi * draw(of, what, 1));
  return {r * at.cos, r * at.sin, z};
}

// About a unit axis, by sines that are the same on every machine.
Quat turn_about(const Vec3& axis, double angle) {
  const SinCos half = portable_sincos(angle / 2);
  return {half.cos, half.sin * axis.x(), half.sin * axis.y(), half.sin * axis.z()};
}

class Writer {
 public:
  Writer(const sema::Model& model, const sema::Space& space, const Point& point,
         const sema::PartBoxes& ways)
      : model_(model), space_(space), point_(point), ways_(ways), task_(model.tasks[space.of]) {}

  WrittenPoint write(bool allowed) {
    WrittenPoint out;
    light();
    cameras();
    if (!layout(out)) return out;
    words();
    out.text = declarations_;
    out.text += "## " + point_text(space_, point_.values) + "\n";
    if (allowed)
      out.text +=
          "@allow(confounded, \"a point of `" + space_.name + "` moves several things at once\")\n";
    out.text += "variant " + point_.name + " of " + task_.name + " {" + statements_ + " }\n";
    return out;
  }

 private:
  // Null where the space has no such axis, or the point leaves it as it is.
  const double* changed(SpaceAxisKind kind, std::uint32_t view = 0) const {
    for (std::size_t i = 0; i < space_.axes.size(); ++i) {
      const SpaceAxis& axis = space_.axes[i];
      if (axis.kind == kind && axis.view == view && is_changed(axis, point_.values[i]))
        return &point_.values[i];
    }
    return nullptr;
  }
  double value(SpaceAxisKind kind, double otherwise, std::uint32_t view = 0) const {
    const double* const to = changed(kind, view);
    return to == nullptr ? otherwise : *to;
  }

  void light() {
    const double* const ambient = changed(SpaceAxisKind::kAmbient);
    const double* const power = changed(SpaceAxisKind::kPower);
    const double* const tilt = changed(SpaceAxisKind::kDirection);
    if (ambient == nullptr && power == nullptr && tilt == nullptr) return;
    const sema::Light& own = model_.lights[sema::light_of(model_, task_)];
    const double factor = power == nullptr ? 1 : *power;
    std::string text = "light " + point_.name + "_light { ambient " +
                       number(ambient == nullptr ? own.ambient : *ambient);
    if (own.occlusion > 0) text += fmt::format(" occlusion {}", own.occlusion);
    // All lamps are tilted together, about one axis that is square to the first.
    std::optional<Quat> tilted;
    const auto along = [&](const std::array<double, 3>& direction) {
      if (tilt == nullptr) return vector_text(to_vec(direction), "");
      if (!tilted) {
        const Vec3 d = to_vec(direction).normalized();
        const Vec3 square =
            d.cross(std::abs(d.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX()).normalized();
        const double way = 2 * std::numbers::pi * draw(point_.draw, "light.direction");
        tilted = turn_about(turn_about(d, way) * square, *tilt);
      }
      return vector_text(*tilted * to_vec(direction), "");
    };
    for (const plan::SunRecord& sun : own.suns)
      text += "; sun " + along(sun.direction) + " power " + number(sun.power * factor) +
              (sun.shadow != 0 ? " shadow" : "");
    for (const plan::LampRecord& lamp : own.lamps) text += "; " + lamp_text(lamp, factor, along);
    if (own.lights_vertices) text += "; shading vertex";
    if (own.color != std::array<double, 3>{})
      text += "; color " + vector_text(to_vec(own.color), "");
    declarations_ += text + " }\n";
    statements_ += " light " + point_.name + "_light;";
  }

  static std::string lamp_text(const plan::LampRecord& lamp, double factor, const auto& along) {
    const auto kind = static_cast<plan::LampKind>(lamp.kind);
    std::string text;
    if (kind == plan::LampKind::kSun) text = "sun " + along(lamp.direction);
    if (kind == plan::LampKind::kHeadlight) text = "headlight";
    if (kind == plan::LampKind::kSpot)
      text =
          "spot at " + vector_text(to_vec(lamp.position), "m") + " along " + along(lamp.direction);
    text += " power " + number(lamp.power * factor);
    if (lamp.specular > 0) text += " specular " + number(lamp.specular * factor);
    if (kind == plan::LampKind::kSun) return text;
    if (lamp.ambient > 0) text += " ambient " + number(lamp.ambient * factor);
    if (kind == plan::LampKind::kHeadlight) return text;
    if (lamp.cutoff > 0) text += " cutoff " + number(lamp.cutoff) + "rad";
    if (lamp.exponent > 0) text += " exponent " + number(lamp.exponent);
    if (lamp.fade != std::array<double, 3>{}) text += " fade " + vector_text(to_vec(lamp.fade), "");
    return text;
  }

  void cameras() {
    const std::vector<sema::View> views = sema::views_of(model_, task_);
    const bool has_sensor = changed(SpaceAxisKind::kNoise) != nullptr ||
                            changed(SpaceAxisKind::kBlur) != nullptr ||
                            changed(SpaceAxisKind::kExposure) != nullptr;
    for (std::uint32_t v = 0; v < views.size(); ++v) {
      const sema::Camera& own = model_.cameras[views[v].camera];
      const double* const x = changed(SpaceAxisKind::kCameraX, v);
      const double* const y = changed(SpaceAxisKind::kCameraY, v);
      const double* const z = changed(SpaceAxisKind::kCameraZ, v);
      const double* const turn = changed(SpaceAxisKind::kCameraTurn, v);
      const bool moves = x != nullptr || y != nullptr || z != nullptr || turn != nullptr;
      if (!moves && !has_sensor) continue;
      const std::string name = point_.name + "_camera" + (v == 0 ? "" : std::to_string(v));
      std::string text;
      if (moves) text += mount_text(own, {x, y, z}, turn, v);
      if (has_sensor) text += (moves ? "; " : "") + sensor_text(own.sensor);
      declarations_ += "camera " + name + " like " + own.name + " { " + text + " }\n";
      statements_ += " camera " + name +
                     (views.size() > 1 || views[v].is_named ? " as " + views[v].name : "") + ";";
    }
  }

  std::string mount_text(const sema::Camera& own, const std::array<const double*, 3>& moved,
                         const double* turn, std::uint32_t view) const {
    Vec3 at = to_vec(own.position);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double* const by = moved[static_cast<std::size_t>(i)];
      at[i] += by == nullptr ? 0 : *by;
    }
    const std::string text = "mount " + model_.robots[own.mount_robot].name + "." +
                             own.mount_link.text + " at " + vector_text(at, "m");
    const auto& aim = own.aim_values;
    if (turn == nullptr && own.aim == plan::CameraAim::kLook)
      return text + " look " + vector_text(Vec3(aim[0], aim[1], aim[2]), "");
    Quat q = sema::aim_of(own);
    if (turn != nullptr)
      q = q *
          turn_about(drawn_direction(point_.draw, "camera.turn " + std::to_string(view)), *turn);
    return text + fmt::format(" quat ({}, {}, {}, {})", number(q.w()), number(q.x()), number(q.y()),
                              number(q.z()));
  }

  std::string sensor_text(const plan::SensorRecord& own) const {
    const double noise = value(SpaceAxisKind::kNoise, own.noise);
    const double blur = value(SpaceAxisKind::kBlur, own.blur);
    const double exposure = value(SpaceAxisKind::kExposure, own.exposure == 0 ? 1 : own.exposure);
    std::string text;
    if (noise >= kLevel) text += " noise " + number(noise);
    if (blur >= kLeastBlur) text += " blur " + number(blur) + "px";
    if (exposure != 1) text += " exposure " + number(exposure);
    if (own.patch != std::array<double, 4>{})
      text += fmt::format(" patch ({}, {}) .. ({}, {})", number(own.patch[0]), number(own.patch[1]),
                          number(own.patch[2]), number(own.patch[3]));
    if (own.dropped > 0) text += " dropped " + number(own.dropped);
    if (own.mirrored != 0) text += " mirrored";
    return "sensor" + (text.empty() ? " none" : text);
  }

  // False where no start is left.
  bool layout(WrittenPoint& out) {
    if (!has_own_starts(model_, space_, point_)) {
      for (std::uint32_t i = 0; i < task_.starts.size(); ++i) out.starts.push_back(i);
      return true;
    }
    const Clutter clutter = clutter_of(model_, space_, point_);
    StartRows rows = start_rows(model_, space_, point_, clutter, ways_);
    out.starts = std::move(rows.starts);
    out.left_out = std::move(rows.left_out);
    if (!out.left_out.empty()) return false;
    out.table = WrittenTable{point_.name + ".csv", std::move(rows.table)};
    const sema::Layout& own = model_.layouts[task_.layout];
    declarations_ += clutter.declarations;
    declarations_ += "layout " + point_.name + "_layout like " + own.name + " { starts \"" +
                     out.table->file + "\"";
    if (own.jitter > 0) declarations_ += "; jitter 0mm";
    if (own.expect) declarations_ += fmt::format("; expect {} episodes", out.starts.size());
    declarations_ += " }\n";
    statements_ += " layout " + point_.name + "_layout;";
    if (clutter.names.empty()) return true;
    std::vector<std::string> all;
    for (const sema::ObjectId id : task_.distractors) all.push_back(model_.objects[id].name);
    for (const sema::ObjectId id : task_.part_distractors) all.push_back(model_.objects[id].name);
    all.insert(all.end(), clutter.names.begin(), clutter.names.end());
    statements_ += fmt::format(" distractors {};", fmt::join(all, ", "));
    return true;
  }

  void words() {
    for (std::size_t i = 0; i < space_.axes.size(); ++i) {
      const SpaceAxis& axis = space_.axes[i];
      if (!is_changed(axis, point_.values[i])) continue;
      const auto choice = static_cast<std::size_t>(std::llround(point_.values[i]));
      if (axis.kind == SpaceAxisKind::kTemplate)
        statements_ += " say " + axis.choices[choice] + ";";
      if (axis.kind == SpaceAxisKind::kPhrase)
        statements_ +=
            " refer " + model_.roles[axis.role].name + " as " + axis.choices[choice] + ";";
      if (axis.kind == SpaceAxisKind::kDelay)
        statements_ += fmt::format(" delay {} steps;", std::llround(point_.values[i]));
    }
  }

  const sema::Model& model_;
  const sema::Space& space_;
  const Point& point_;
  const sema::PartBoxes& ways_;
  const sema::Task& task_;
  std::string declarations_, statements_;
};

}  // namespace

std::vector<double> own_values(const sema::Space& space) {
  std::vector<double> values;
  for (const SpaceAxis& axis : space.axes) values.push_back(axis.own);
  return values;
}

std::vector<std::size_t> changed_axes(const sema::Space& space, const std::vector<double>& values) {
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < space.axes.size(); ++i) {
    if (is_changed(space.axes[i], values[i])) changed.push_back(i);
  }
  return changed;
}

std::vector<double> seen_values(const sema::Space& space, std::vector<double> values) {
  for (std::size_t i = 0; i < space.axes.size(); ++i) {
    if (!is_changed(space.axes[i], values[i])) values[i] = space.axes[i].own;
  }
  return values;
}

std::vector<double> placed_values(const sema::Space& space, const std::vector<double>& values) {
  std::vector<double> placed = own_values(space);
  for (std::size_t i = 0; i < space.axes.size(); ++i) {
    if (sema::info_of(space.axes[i].kind).moves_things) placed[i] = values[i];
  }
  return placed;
}

std::string value_text(const SpaceAxis& axis, double value) {
  const sema::SpaceAxisInfo& info = sema::info_of(axis.kind);
  if (info.spacing == Spacing::kChoice) {
    const std::string& choice = axis.choices[static_cast<std::size_t>(std::llround(value))];
    return choice.empty() ? "as the task" : choice;
  }
  return amount_text(info, effective(axis, value) * info.per_si);
}

std::string amount_text(const sema::SpaceAxisInfo& info, double shown) {
  const bool is_factor = info.label == sema::info_of(SpaceAxisKind::kPower).label;
  const bool is_word = info.unit.size() > 3;  // "steps"
  std::string text = is_factor ? "x " : "";
  text += info.spacing == Spacing::kWhole ? fmt::format("{}", std::llround(shown))
                                          : fmt::format("{:.3g}", shown + 0.0);
  return text + (is_word ? " " : "") + std::string(info.unit);
}

std::string point_text(const sema::Space& space, const std::vector<double>& values) {
  std::string text;
  for (const std::size_t i : changed_axes(space, values))
    text += (text.empty() ? "" : ", ") + space.axes[i].name + " " +
            value_text(space.axes[i], values[i]);
  return text.empty() ? "nothing" : text;
}

WrittenPoint write_point(const sema::Model& model, const sema::Space& space, const Point& point,
                         bool allowed, const sema::PartBoxes& ways) {
  return Writer(model, space, point, ways).write(allowed);
}

sema::PartBoxes ways_of_fixtures(const sema::Model& model, const sema::Scene& scene,
                                 const AssetRoot& assets) {
  sema::PartBoxes ways;
  for (const sema::FixtureId id : scene.fixtures) {
    const auto travel = sema::Travel::of(scene, model.fixtures[id], assets);
    if (!travel) continue;
    for (const sema::PartBox& box : travel->everywhere().all()) ways.add(box);
  }
  return ways;
}

}  // namespace probe::space
