#include "compiler/space/points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compiler/define/role.h"
#include "compiler/define/views.h"
#include "compiler/geometry/footprint.h"
#include "compiler/space/clutter.h"
#include "compiler/space/draws.h"
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

// As a table may have it: to the bit.
std::string cell(double value) { return fmt::format("{}", value + 0.0); }

std::string vector_text(const std::array<double, 3>& v, const char* unit) {
  return fmt::format("({}{}, {}{}, {}{})", number(v[0]), unit, number(v[1]), unit, number(v[2]),
                     unit);
}

std::array<double, 3> turned(const std::array<double, 3>& v, const std::array<double, 3>& axis,
                             double angle) {
  const SinCos at = portable_sincos(angle);
  const double along = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
  const std::array<double, 3> cross = {axis[1] * v[2] - axis[2] * v[1],
                                       axis[2] * v[0] - axis[0] * v[2],
                                       axis[0] * v[1] - axis[1] * v[0]};
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = v[i] * at.cos + cross[i] * at.sin + axis[i] * along * (1 - at.cos);
  return out;
}

std::array<double, 3> unit(std::array<double, 3> v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (double& x : v) x /= length;
  return v;
}

// Uniform over directions: a height and an angle (Archimedes).
std::array<double, 3> drawn_direction(std::uint64_t of, const std::string& what) {
  const double z = 2 * draw(of, what, 0) - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
  const SinCos at = portable_sincos(2 * std::numbers::pi * draw(of, what, 1));
  return {r * at.cos, r * at.sin, z};
}

using Rotation = std::array<double, 4>;  // w, x, y, z
Rotation product(const Rotation& a, const Rotation& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

// Forward, left and up are x, y and z of its frame, as of a camera that looks along a direction.
Rotation rotation_of(const sema::Camera& camera) {
  if (camera.aim != plan::CameraAim::kLook) return camera.aim_values;
  const std::array<double, 3> f =
      unit({camera.aim_values[0], camera.aim_values[1], camera.aim_values[2]});
  const std::array<double, 3> l = unit({-f[1], f[0], 0});
  const std::array<double, 3> u = {f[1] * l[2] - f[2] * l[1], f[2] * l[0] - f[0] * l[2],
                                   f[0] * l[1] - f[1] * l[0]};
  // Columns f, l, u; the greatest of the four squares first (Shepperd 1978).
  const double m[3][3] = {{f[0], l[0], u[0]}, {f[1], l[1], u[1]}, {f[2], l[2], u[2]}};
  const double trace = m[0][0] + m[1][1] + m[2][2];
  Rotation q{};
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    q = {s / 4, (m[2][1] - m[1][2]) / s, (m[0][2] - m[2][0]) / s, (m[1][0] - m[0][1]) / s};
  } else {
    std::size_t i = m[1][1] > m[0][0] ? 1 : 0;
    if (m[2][2] > m[i][i]) i = 2;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double s = 2 * std::sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    q[0] = (m[k][j] - m[j][k]) / s;
    q[1 + i] = s / 4;
    q[1 + j] = (m[j][i] + m[i][j]) / s;
    q[1 + k] = (m[k][i] + m[i][k]) / s;
  }
  return q;
}

class Writer {
 public:
  Writer(const sema::Model& model, const sema::Space& space, const Point& point)
      : model_(model), space_(space), point_(point), task_(model.tasks[space.of]) {}

  WrittenPoint write(const std::string& table_folder, bool allowed) {
    WrittenPoint out;
    light();
    cameras();
    if (!layout(out, table_folder)) return out;
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
    std::optional<std::array<double, 3>> about;
    const auto along = [&](const std::array<double, 3>& direction) {
      if (tilt == nullptr) return vector_text(direction, "");
      if (!about) {
        const std::array<double, 3> d = unit(direction);
        const std::array<double, 3> aside =
            std::abs(d[2]) < 0.9 ? std::array<double, 3>{0, 0, 1} : std::array<double, 3>{1, 0, 0};
        const std::array<double, 3> square =
            unit({d[1] * aside[2] - d[2] * aside[1], d[2] * aside[0] - d[0] * aside[2],
                  d[0] * aside[1] - d[1] * aside[0]});
        about = turned(square, d, 2 * std::numbers::pi * draw(point_.draw, "light.direction"));
      }
      return vector_text(turned(direction, *about, *tilt), "");
    };
    for (const plan::SunRecord& sun : own.suns)
      text += "; sun " + along(sun.direction) + " power " + number(sun.power * factor) +
              (sun.shadow != 0 ? " shadow" : "");
    for (const plan::LampRecord& lamp : own.lamps) text += "; " + lamp_text(lamp, factor, along);
    if (own.lights_vertices) text += "; shading vertex";
    if (own.color != std::array<double, 3>{}) text += "; color " + vector_text(own.color, "");
    declarations_ += text + " }\n";
    statements_ += " light " + point_.name + "_light;";
  }

  static std::string lamp_text(const plan::LampRecord& lamp, double factor, const auto& along) {
    const auto kind = static_cast<plan::LampKind>(lamp.kind);
    std::string text;
    if (kind == plan::LampKind::kSun) text = "sun " + along(lamp.direction);
    if (kind == plan::LampKind::kHeadlight) text = "headlight";
    if (kind == plan::LampKind::kSpot)
      text = "spot at " + vector_text(lamp.position, "m") + " along " + along(lamp.direction);
    text += " power " + number(lamp.power * factor);
    if (lamp.specular > 0) text += " specular " + number(lamp.specular * factor);
    if (kind == plan::LampKind::kSun) return text;
    if (lamp.ambient > 0) text += " ambient " + number(lamp.ambient * factor);
    if (kind == plan::LampKind::kHeadlight) return text;
    if (lamp.cutoff > 0) text += " cutoff " + number(lamp.cutoff) + "rad";
    if (lamp.exponent > 0) text += " exponent " + number(lamp.exponent);
    if (lamp.fade != std::array<double, 3>{}) text += " fade " + vector_text(lamp.fade, "");
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
    std::array<double, 3> at = own.position;
    for (std::size_t i = 0; i < 3; ++i) at[i] += moved[i] == nullptr ? 0 : *moved[i];
    Rotation rotation = rotation_of(own);
    if (turn != nullptr) {
      const auto axis = drawn_direction(point_.draw, "camera.turn " + std::to_string(view));
      const SinCos half = portable_sincos(*turn / 2);
      rotation =
          product(rotation, {half.cos, half.sin * axis[0], half.sin * axis[1], half.sin * axis[2]});
    }
    std::string text = "mount " + model_.robots[own.mount_robot].name + "." + own.mount_link.text +
                       " at " + vector_text(at, "m");
    if (turn == nullptr && own.aim == plan::CameraAim::kLook)
      return text + " look " +
             vector_text({own.aim_values[0], own.aim_values[1], own.aim_values[2]}, "");
    return text + fmt::format(" quat ({}, {}, {}, {})", number(rotation[0]), number(rotation[1]),
                              number(rotation[2]), number(rotation[3]));
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
  bool layout(WrittenPoint& out, const std::string& table_folder) {
    std::vector<std::uint32_t> wanted = point_.starts;
    for (std::uint32_t i = 0; point_.starts.empty() && i < task_.starts.size(); ++i)
      wanted.push_back(i);
    const double* const clutter = changed(SpaceAxisKind::kClutter);
    bool moves = clutter != nullptr;
    for (std::size_t i = 0; i < space_.axes.size(); ++i)
      moves = moves || (space_.axes[i].kind == SpaceAxisKind::kPlace &&
                        is_changed(space_.axes[i], point_.values[i]));
    if (!moves) {
      // Places as the task has them: a table only where some starts are left out.
      if (wanted.size() == task_.starts.size()) {
        out.starts = wanted;
        return true;
      }
    }
    std::vector<sema::ObjectId> around;
    for (std::size_t i = 0;
         clutter != nullptr && i < static_cast<std::size_t>(std::round(*clutter)); ++i)
      around.push_back(space_.clutter[i % space_.clutter.size()]);
    std::vector<std::string> names;  // of the clutter
    for (std::size_t i = 0; i < around.size(); ++i) {
      const std::string& name = model_.objects[around[i]].name;
      const std::size_t copy = i / space_.clutter.size();
      if (copy == 0) {
        names.push_back(name);
        continue;
      }
      names.push_back(point_.name + "_" + name + std::to_string(copy + 1));
      declarations_ += "object " + names.back() + " like " + name + " {}\n";
    }
    struct Row {
      sema::Start start;
      std::vector<sema::Start::Placed> clutter;
    };
    std::vector<Row> rows;
    for (const std::uint32_t number : wanted) {
      Row row{task_.starts[number], {}};
      for (std::size_t i = 0; i < space_.axes.size(); ++i) {
        const SpaceAxis& axis = space_.axes[i];
        if (axis.kind != SpaceAxisKind::kPlace || !is_changed(axis, point_.values[i])) continue;
        // In each start another way: a step to one side would be a change of its own.
        const SinCos way =
            portable_sincos(2 * std::numbers::pi * draw(point_.draw, axis.name, number));
        for (sema::Start::Placed& placed : row.start.placed) {
          if (placed.object != axis.object) continue;
          placed.x += point_.values[i] * way.cos;
          placed.y += point_.values[i] * way.sin;
        }
      }
      if (!around.empty()) {
        auto laid = lay_clutter(model_, task_, row.start, number, around, point_.draw);
        if (!laid) continue;
        row.clutter = *std::move(laid);
      }
      rows.push_back(std::move(row));
      out.starts.push_back(number);
    }
    // Jitter goes by a start's number, which a table without the starts before it does not keep.
    const bool is_jittered =
        model_.layouts[task_.layout].joints_jitter > 0 ||
        std::ranges::any_of(sema::views_of(model_, task_), [&](const sema::View& view) {
          return model_.cameras[view.camera].jitters();
        });
    if (is_jittered && rows.size() != task_.starts.size()) {
      out.left_out =
          fmt::format("{} of {} starts would be left, and those that jitter keep all or none",
                      rows.size(), task_.starts.size());
      out.starts.clear();
      return false;
    }
    if (rows.empty()) {
      out.left_out = fmt::format("{} more things find no room in any start", around.size());
      return false;
    }
    const auto has_height = [](const Row& row) {
      return std::ranges::all_of(row.start.placed, [](const auto& p) { return p.z.has_value(); });
    };
    const bool heights = std::ranges::all_of(rows, has_height);
    const sema::Layout& own = model_.layouts[task_.layout];
    const double surface = model_.scenes[task_.scene].surface_z;
    // As high above the surface as things of the layout fall from.
    const auto height_of = [&](const sema::Start::Placed& p) {
      const auto& q = p.turn.rotation;
      const Mat3 turn = Quat(q[0], q[1], q[2], q[3]).toRotationMatrix();
      return p.z.value_or(surface - sema::lowest(model_.objects[p.object], turn) + own.drop);
    };
    const bool joints = !own.given_joints.empty();
    WrittenTable table;
    table.file = table_folder + point_.name + ".csv";
    table.text = std::string("start,object,x_m,y_m") + (heights ? ",z_m" : "") + ",qw,qx,qy,qz" +
                 (joints ? ",value" : "") + "\n";
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto line = [&](const std::string& object, const sema::Start::Placed& p) {
        table.text += fmt::format("{},{},{},{}", r, object, cell(p.x), cell(p.y));
        if (heights) table.text += "," + cell(height_of(p));
        for (const double q : p.turn.rotation) table.text += "," + cell(q);
        table.text += joints ? ",\n" : "\n";
      };
      for (const sema::Start::Placed& placed : rows[r].start.placed)
        line(row_name(own, placed.object), placed);
      for (std::size_t i = 0; i < rows[r].clutter.size(); ++i) line(names[i], rows[r].clutter[i]);
      if (!joints) continue;
      for (const sema::GivenJoint& joint : own.given_joints[rows[r].start.given])
        table.text += fmt::format("{},{},,{},,,,,{}\n", r, joint.what.text, heights ? "," : "",
                                  cell(joint.value));
    }
    declarations_ +=
        "layout " + point_.name + "_layout like " + own.name + " { starts \"" + table.file + "\"";
    if (own.jitter > 0) declarations_ += "; jitter 0mm";
    if (own.expect) declarations_ += fmt::format("; expect {} episodes", rows.size());
    declarations_ += " }\n";
    statements_ += " layout " + point_.name + "_layout;";
    if (!names.empty()) {
      statements_ += " distractors ";
      std::string all;
      for (const sema::ObjectId id : task_.distractors) all += model_.objects[id].name + ", ";
      for (const sema::ObjectId id : task_.part_distractors) all += model_.objects[id].name + ", ";
      for (std::size_t i = 0; i < names.size(); ++i) all += (i == 0 ? "" : ", ") + names[i];
      statements_ += all + ";";
    }
    out.table = std::move(table);
    return true;
  }

  // As the layout's own table calls it, where it has one: by its role, maybe.
  std::string row_name(const sema::Layout& layout, sema::ObjectId object) const {
    const std::string& name = model_.objects[object].name;
    if (layout.given.empty()) return name;
    for (const sema::GivenPlace& given : layout.given.front()) {
      if (given.what.text == name) return name;
      const auto role = sema::find_role(model_, given.what.text);
      if (!role) continue;
      const std::vector<sema::ObjectId> filled = task_.objects_in(*role);
      if (filled.size() == 1 && filled.front() == object) return given.what.text;
    }
    return name;
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
  const double shown = effective(axis, value) * info.per_si;
  std::string text = fmt::format("{:.3g}", shown + 0.0);
  if (info.spacing == Spacing::kWhole) text = fmt::format("{}", std::llround(shown));
  const bool is_factor = axis.kind == SpaceAxisKind::kPower;
  const bool is_word = info.unit.size() > 3;  // "steps"
  return (is_factor ? "x " : "") + text + (is_word ? " " : "") + std::string(info.unit);
}

std::string point_text(const sema::Space& space, const std::vector<double>& values) {
  std::string text;
  for (const std::size_t i : changed_axes(space, values))
    text += (text.empty() ? "" : ", ") + space.axes[i].name + " " +
            value_text(space.axes[i], values[i]);
  return text.empty() ? "nothing" : text;
}

WrittenPoint write_point(const sema::Model& model, const sema::Space& space, const Point& point,
                         const std::string& table_folder, bool allowed) {
  return Writer(model, space, point).write(table_folder, allowed);
}

}  // namespace probe::space
